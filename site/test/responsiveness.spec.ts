import { type CDPSession, chromium, expect, type Locator, type Page, test } from "@playwright/test";
import type { SapDemo } from "sweep-and-prune-classroom/demo";
import { open } from "./support/embedded.ts";

/** The falling spheres of the playground. */
async function spheres(page: Page, query: string): Promise<{ root: Locator; play: Locator; stepNumber(): Promise<number>; value(key: string): Promise<number> }> {
  await page.goto(`/playground.html?scene=falling+balls&dimensions=3${query}`);
  const root = page.locator("box-playground");
  await expect(root).toHaveAttribute("data-step", /^\d+$/);
  return {
    root,
    play: root.locator("[data-part=play]"),
    stepNumber: async () => Number(await root.getAttribute("data-step")),
    value: async (key) => Number.parseFloat(((await root.locator(`[data-counter="${key}"] dd`).first().textContent()) ?? "").replaceAll(",", "")),
  };
}

// Drawing ten thousand spheres in software takes the graphics process hundreds of milliseconds,
// so pictures a second say nothing here. What counts is the thread of the page, and the step.

for (const { name, query } of [
  { name: "brute force at 10,000 spheres", query: "scene=falling+balls&dimensions=3&boxes=10000&algorithm=global+pairwise" },
  { name: "a race of brute force at 10,000 boxes", query: "scene=uniform&boxes=10000&algorithm=find+pairs&2=global+pairwise" },
]) {
  test(`${name} blocks the page for less than 100 ms, throttled six times, and shows what it costs or that it was stopped`, async ({ baseURL, launchOptions }) => {
    // Without the emulated graphics card: the page waits for it.
    const browser = await chromium.launch({ executablePath: launchOptions.executablePath!, args: ["--no-sandbox", "--disable-3d-apis"] });
    const page = await browser.newPage({ baseURL: baseURL!, viewport: { width: 1280, height: 900 }, serviceWorkers: "block" });
    const session = await page.context().newCDPSession(page);
    await session.send("Emulation.setCPUThrottlingRate", { rate: 6 });
    await page.goto(`/playground.html?${query}`);
    const root = page.locator("box-playground");
    await expect.poll(async () => Number(await root.getAttribute("data-step"))).toBeGreaterThan(1);
    const brute = root.locator(".lane").last();
    // On a machine on which a step takes too long it says so, and is not repeated.
    await expect(brute).toContainText(/49,995,000|Stopped: a step .*took [\d,]+ ms; the limit is [\d,]+ ms\./);
    // The best of three: a busy machine gives greater figures.
    let longest = Infinity;
    for (let window = 0; window < 3; window++) longest = Math.min(longest, await longestTask(page, () => page.waitForTimeout(2_000)));
    console.log(`${name}: longest task of the page's thread ${longest.toFixed(0)} ms; ${(await brute.locator("[data-counter=ms] dd, .lane-out").allTextContents()).join(" ")}`);
    expect(longest).toBeLessThan(100);
    await root.locator("[data-part=play]").click();
    await expect(root.locator("[data-part=play]")).toHaveText("Play");
    await browser.close();
  });
}

// The time of a step is read off a clock, which goes on while the step waits for a processor. Without
// WebGL nothing is drawn, and the spheres fall all the same: what is left is the time of the script.
// With it the emulated graphics card wants every processor that there is.
for (const { name, args } of [{ name: "nothing drawn", args: ["--disable-3d-apis"] }, { name: "drawn in software", args: [] }]) {
  test(`10,000 spheres, ${name}: the broad phase of a frame`, async ({ baseURL, launchOptions }) => {
    const browser = await chromium.launch({ ...launchOptions, args: [...(launchOptions.args ?? []), ...args] });
    const page = await browser.newPage({ baseURL: baseURL!, viewport: { width: 1280, height: 900 } });
    const library = "find pairs";
    const balls = await spheres(page, `&boxes=10000&algorithm=${library}`);
    // From a beginning that is seen: while a page prepares to draw it may miss seconds.
    await expect.poll(() => balls.stepNumber()).toBeGreaterThan(1);
    await balls.play.click();
    await balls.root.getByRole("button", { name: "Reset" }).click();
    await balls.play.click();
    // Each value is the mean of half a second, which the first steps are not yet.
    const times: number[] = [];
    for (let step = 0; step < 200; step = await balls.stepNumber()) {
      const time = await balls.value("ms");
      if (step >= 30 && time !== times.at(-1)) times.push(time);
      await page.waitForTimeout(100);
    }
    console.log(`${library}, ${name}: broad phase of a frame while they fall and pile up ${times.join(", ")} ms ms`);
    await browser.close();
    // The aim is 2 ms, and what is printed tells. What fails is a whole frame: a test's machine may be
    // busy with other things.
    expect(Math.min(...times)).toBeLessThan(16);
  });
}

test("100,000 spheres by the library: the page answers", async ({ page }) => {
  const balls = await spheres(page, "&boxes=100000&algorithm=find+pairs");
  await expect.poll(() => balls.stepNumber(), { timeout: 600_000 }).toBeGreaterThan(1);
  expect(await balls.value("pairs")).toBeGreaterThan(10_000);
  const answered = await balls.play.evaluate((button: HTMLElement) => {
    const clicked = performance.now();
    button.click();
    return performance.now() - clicked;
  });
  console.log(`100,000 spheres: broad phase ${await balls.value("ms")} ms ms`);
  expect(answered).toBeLessThan(50);
});

// Where nothing is drawn in 3D, Chromium draws on the processor: the emulated graphics card that the
// spheres need takes a second for what a real one does at once, and there would be no frames to count.
for (const path of ["/#d6a", "/#d13a", "/#swaps", "/playground.html?scene=falling+balls&boxes=5000&algorithm=find+pairs", "/playground.html", "/playground.html?boxes=5000&motion=fast"]) {
  test(`${path}: script a frame`, async ({ baseURL, launchOptions }) => {
    const browser = await chromium.launch({ executablePath: launchOptions.executablePath!, args: ["--no-sandbox"] });
    const page = await browser.newPage({ baseURL: baseURL!, viewport: { width: 1280, height: 900 } });
    await page.goto(path);
    const isRunning = (): boolean => {
      const demos = [...document.querySelectorAll<HTMLElement & { state: { tick: number } }>("sap-demo")];
      return document.querySelector("[data-step]:not([data-step='0'])") !== null || demos.some((demo) => demo.state?.tick > 10);
    };
    await page.waitForFunction(isRunning);
    const session = await page.context().newCDPSession(page);
    await session.send("Performance.enable");
    const script = async (): Promise<number> => {
      const { metrics } = await session.send("Performance.getMetrics");
      return 1000 * (metrics.find(({ name }) => name === "ScriptDuration")?.value ?? Number.NaN);
    };
    const windows: { ms: number; frames: number }[] = [];
    for (let second = 0; second < 4; second++) {
      const before = await script();
      const frames = await page.evaluate(async () => {
        const end = performance.now() + 1000;
        let frames = 0;
        while (performance.now() < end) {
          await new Promise(requestAnimationFrame);
          frames++;
        }
        return frames;
      });
      windows.push({ ms: ((await script()) - before) / frames, frames });
    }
    await browser.close();
    // The aim is 8 ms, and 60 frames. The clock goes on while other programs have the processor: the
    // best of four seconds, and what fails is a whole frame.
    const each = Math.min(...windows.map(({ ms }) => ms));
    console.log(`${path}: ${windows.map(({ ms }) => ms.toFixed(2)).join(", ")} ms of script a frame, ${windows.map(({ frames }) => frames).join(", ")} frames a second`);
    expect(each).toBeLessThan(16);
  });
}

/**
 * How much longer the page's thread takes than it would on a machine that does nothing else: the clock's time of a fixed
 * script, over the time for which the thread had a processor.
 */
async function slowness(page: Page, session: CDPSession): Promise<number> {
  const threadMs = async (): Promise<number> => {
    const { metrics } = await session.send("Performance.getMetrics");
    return 1000 * (metrics.find(({ name }) => name === "TaskDuration")?.value ?? Number.NaN);
  };
  const before = await threadMs();
  const ms = await page.evaluate(() => {
    const began = performance.now();
    let sum = 0;
    for (let i = 0; i < 2e7; i++) sum = (sum + Math.imul(i, 0x9e3779b1)) | 0;
    return performance.now() - began + (sum === 1 ? 1 : 0);
  });
  return Math.max(1, ms / ((await threadMs()) - before));
}

for (const path of ["/", "/#d2", "/#d13a", "/embed.html#strategy=pairwise&balls=5&decorations=checks"]) {
  test(`${path}, throttled six times: the first demo works within 4 s`, async ({ baseURL, launchOptions }) => {
    const trials: { ms: number; slower: number }[] = [];
    for (let trial = 0; trial < 3; trial++) {
      const browser = await chromium.launch({ executablePath: launchOptions.executablePath!, args: ["--no-sandbox"] });
      const page = await browser.newPage({ baseURL: baseURL!, viewport: { width: 1280, height: 900 }, serviceWorkers: "block" });
      const session = await page.context().newCDPSession(page);
      await session.send("Performance.enable", { timeDomain: "threadTicks" });
      await session.send("Emulation.setCPUThrottlingRate", { rate: 6 });
      const began = Date.now();
      await page.goto(path, { waitUntil: "commit" });
      // It works: it has been drawn, moves, and can be paused. Where the address names a demo, it is that one.
      await page.waitForFunction(() => {
        type Demo = HTMLElement & { state?: { tick: number; events: number } };
        if (document.querySelector("hero-boxes[data-ready]") && location.hash === "") return true;
        const named = document.getElementById(location.hash.slice(1)) ?? document;
        const demo = named.querySelector<Demo>("sap-demo");
        return (demo?.state?.tick ?? 0) > 0 || (demo?.state?.events ?? 0) > 1;
      }, undefined, { polling: 50 });
      const ms = Date.now() - began;
      trials.push({ ms, slower: await slowness(page, session) });
      await browser.close();
    }
    // Only what other programs took is subtracted, and on a machine that does nothing else that is nothing.
    console.log(`${path}, throttled six times: the first demo works after ${trials.map(({ ms, slower }) => `${ms} ms (the thread waited: ${slower.toFixed(2)} times as long)`).join(", ")}`);
    expect(Math.min(...trials.map(({ ms, slower }) => ms / slower))).toBeLessThan(4000);
  });
}

test("throttled six times, a frame of four demos takes at most 16 ms of script, style and layout", async ({ baseURL, launchOptions }) => {
  const browser = await chromium.launch({ executablePath: launchOptions.executablePath!, args: ["--no-sandbox"] });
  const page = await browser.newPage({ baseURL: baseURL!, viewport: { width: 1280, height: 1100 }, serviceWorkers: "block" });
  await page.goto("/#swaps");
  const demos = page.locator("#swaps sap-demo");
  await demos.nth(3).scrollIntoViewIfNeeded();
  const playing = (): Promise<number> =>
    page.locator("sap-demo").evaluateAll((all) => all.filter((demo) => {
      const { top, bottom } = demo.getBoundingClientRect();
      return (demo as HTMLElement & { isPlaying?: boolean }).isPlaying && bottom > 0 && top < innerHeight;
    }).length);
  await expect.poll(playing, { message: "four demos play in view" }).toBeGreaterThanOrEqual(4);
  const session = await page.context().newCDPSession(page);
  // The time that the thread had the processor, throttled: other programs do not count.
  await session.send("Performance.enable", { timeDomain: "threadTicks" });
  await session.send("Emulation.setCPUThrottlingRate", { rate: 6 });
  const PARTS = ["ScriptDuration", "LayoutDuration", "RecalcStyleDuration"];
  const spent = async (): Promise<number[]> => {
    const { metrics } = await session.send("Performance.getMetrics");
    return PARTS.map((part) => 1000 * (metrics.find(({ name }) => name === part)?.value ?? Number.NaN));
  };
  const windows: { parts: number[]; ms: number }[] = [];
  const FRAMES = 60;
  // What is done ten times a second counts in each frame where frames take that long: a busy machine gives greater figures.
  for (let window = 0; window < 4; window++) {
    const before = await spent();
    const ms = await page.evaluate(async (frames) => {
      const began = performance.now();
      for (let frame = 0; frame < frames; frame++) await new Promise(requestAnimationFrame);
      return performance.now() - began;
    }, FRAMES);
    const after = await spent();
    windows.push({ parts: after.map((value, part) => (value - before[part]!) / FRAMES), ms: ms / FRAMES });
  }
  await browser.close();
  const sum = ({ parts }: { parts: number[] }): number => parts.reduce((all, part) => all + part, 0);
  const [best, second] = windows.sort((a, b) => sum(a) - sum(b));
  console.log(`four demos, throttled six times: ${windows.map((one) => sum(one).toFixed(1)).join(", ")} ms a frame (best: script, layout, style ${best!.parts.map((part) => part.toFixed(1)).join(", ")}; one frame in ${best!.ms.toFixed(0)} ms)`);
  // Two of the four windows: one alone may be luck.
  expect(sum(second!)).toBeLessThan(16);
});

test("script a frame with six demos on the screen", async ({ baseURL, launchOptions }) => {
  // Without the emulated graphics card that the spheres need: it takes a second for six canvases.
  const browser = await chromium.launch({ executablePath: launchOptions.executablePath!, args: ["--no-sandbox"] });
  const page = await browser.newPage({ baseURL: baseURL!, viewport: { width: 1300, height: 1700 } });
  const demo = await open(page, { strategy: "pairwise", balls: "20", "skip-interval": "4", decorations: "checks:#4c8:30" });
  const mean = await demo.evaluate(async (first: SapDemo) => {
    const main = document.querySelector("main")!;
    main.style.cssText = "display:grid;grid-template-columns:1fr 1fr;gap:10px";
    const more = [
      { strategy: "sweep", balls: "20", decorations: "sweep,edges:array" },
      { strategy: "swap", balls: "25", rainbow: "", labels: "emoji" },
      { strategy: "sorted-pairwise", balls: "50" },
      { strategy: "swap-all-axes", balls: "25", decorations: "checks,edges:array" },
      { strategy: "sorted-pairwise", balls: "200" },
    ].map((attributes) => {
      const element = document.createElement("sap-demo");
      for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value!);
      main.append(element);
      return element;
    });
    await Promise.all(more.map(({ ready }) => ready));
    // What the demos' own callbacks take, all within one frame of the clock they share.
    const request = window.requestAnimationFrame.bind(window);
    const times: number[] = [];
    window.requestAnimationFrame = (callback) =>
      request((now) => {
        const began = performance.now();
        callback(now);
        times.push(performance.now() - began);
      });
    for (let frame = 0; frame < 150; frame++) await new Promise(request);
    window.requestAnimationFrame = request;
    times.sort((a, b) => a - b);
    return { median: times[times.length >> 1]!, frames: times.length, ticks: [first, ...more].map(({ state }) => state.tick) };
  });
  await browser.close();
  console.log(`script a frame: median ${mean.median.toFixed(2)} ms in ${mean.frames} frames`);
  expect(mean.frames).toBeGreaterThan(100);
  // The aim is 8 ms; what fails, on a machine busy with other things too, is a whole frame.
  expect(mean.median).toBeLessThan(16);
});

/** The milliseconds for which the thread of the page had a processor in its longest task, while `work` is done: other programs do not count. */
async function longestTask(page: Page, work: () => Promise<unknown>): Promise<number> {
  const browser = page.context().browser()!;
  await browser.startTracing(page, { categories: ["devtools.timeline", "disabled-by-default-devtools.timeline"] });
  await work();
  type Event = { name: string; ph: string; pid: number; tid: number; tdur?: number; args: { name?: string; data?: { frames?: { url: string; processId: number }[] } } };
  const { traceEvents } = JSON.parse(String(await browser.stopTracing())) as { traceEvents: Event[] };
  const pids = traceEvents.flatMap(({ name, args }) => (name === "TracingStartedInBrowser" ? (args.data?.frames ?? []) : [])).filter(({ url }) => url === page.url() || url === "about:blank").map(({ processId }) => processId);
  const threads = new Set(traceEvents.filter(({ name, pid, args }) => name === "thread_name" && args.name === "CrRendererMain" && pids.includes(pid)).map(({ pid, tid }) => `${pid} ${tid}`));
  const tasks = traceEvents.filter(({ name, ph, pid, tid }) => name === "RunTask" && ph === "X" && threads.has(`${pid} ${tid}`)).map(({ tdur = 0 }) => tdur / 1000);
  expect(tasks.length, "tasks of the page").toBeGreaterThan(10);
  return Math.max(...tasks);
}

test("throttled six times: the first picture works within 1.5 s, no task of the load takes 200 ms, and every pair of 10,000 boxes blocks for less than 100 ms", async ({ baseURL, launchOptions }) => {
  const trials: { ready: number; ofLoad: number; ofPairs: number }[] = [];
  for (let trial = 0; trial < 3; trial++) {
    const browser = await chromium.launch({ executablePath: launchOptions.executablePath!, args: ["--no-sandbox"] });
    const page = await browser.newPage({ baseURL: baseURL!, viewport: { width: 1280, height: 900 }, serviceWorkers: "block" });
    const session = await page.context().newCDPSession(page);
    await session.send("Performance.enable", { timeDomain: "threadTicks" });
    await session.send("Emulation.setCPUThrottlingRate", { rate: 6 });
    const hero = page.locator("hero-boxes");
    await page.goto("/");
    await hero.and(page.locator("[data-ready]")).waitFor();
    const ready = await page.evaluate(() => performance.now());
    const slower = await slowness(page, session);
    // Once more for the tasks: tracing takes time itself.
    const ofLoad = await longestTask(page, async () => {
      await page.reload();
      await hero.and(page.locator("[data-ready]")).waitFor();
    });
    await hero.getByRole("button", { name: "Pause" }).click();
    await hero.getByLabel("Boxes", { exact: true }).fill("8");
    await page.waitForTimeout(2_000);
    // Clicked from within: what Playwright does before a click would count too.
    const ofPairs = await longestTask(page, async () => {
      await hero.evaluate((element) => void setTimeout(() => element.querySelector<HTMLInputElement>("[value='global pairwise']")!.click()));
      await page.waitForTimeout(2_000);
    });
    await expect(hero.locator("[data-part=ms]")).toContainText("stands still");
    trials.push({ ready: ready / slower, ofLoad, ofPairs });
    await browser.close();
  }
  const least = (key: "ready" | "ofLoad" | "ofPairs"): number => Math.min(...trials.map((trial) => trial[key]));
  console.log(`throttled six times: the first picture after ${least("ready").toFixed(0)} ms, longest task of the load ${least("ofLoad").toFixed(0)} ms, of every pair of 10,000 boxes ${least("ofPairs").toFixed(0)} ms (${trials.map((trial) => Object.values(trial).map((ms) => ms.toFixed(0)).join(" ")).join("; ")})`);
  expect(least("ready")).toBeLessThan(1_500);
  expect(least("ofLoad")).toBeLessThan(200);
  expect(least("ofPairs")).toBeLessThan(100);
});
