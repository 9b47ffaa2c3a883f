// `<sap-demo>`, one at a time on embed.html, as a visitor handles it.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { chromium, expect, type Locator, type Page, test } from "@playwright/test";
import type { AxeResults } from "axe-core";
import type { DemoEvent, DemoState, SapDemo } from "sweep-and-prune/demo";

const axeSource = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

type Attributes = Record<string, string>;

let complaints: string[];

test.beforeEach(({ page }) => {
  complaints = [];
  page.on("console", (message) => {
    if (message.type() === "error" || message.type() === "warning") complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("requestfailed", (request) => complaints.push(request.url()));
});

test.afterEach(() => expect(complaints).toEqual([]));

/** Opens a demo of these attributes, and waits until it is there. */
async function open(page: Page, attributes: Attributes): Promise<Locator> {
  await page.goto(`/embed.html#${new URLSearchParams(attributes)}`);
  const demo = page.locator("sap-demo");
  await demo.evaluate((element: SapDemo) => element.ready);
  return demo;
}

const stateOf = (demo: Locator): Promise<DemoState> => demo.evaluate((element: SapDemo) => element.state);
const step = (demo: Locator): Promise<void> => demo.evaluate((element: SapDemo) => element.step());
const counter = (demo: Locator, name: string): Promise<string | null> => demo.locator(`[data-counter="${name}"]`).textContent();

/** Steps through one detection to its end; the events that were told. */
function walk(demo: Locator): Promise<DemoEvent[]> {
  return demo.evaluate((element: SapDemo) => {
    const told: DemoEvent[] = [];
    const hear = (event: CustomEvent<DemoEvent>): unknown => told.push(event.detail);
    element.addEventListener("sap-event", hear);
    const { tick } = element.state;
    let last = -1;
    while (element.state.tick === tick && element.state.events !== last) {
      last = element.state.events;
      element.step();
    }
    if (element.state.tick !== tick) element.back();
    element.removeEventListener("sap-event", hear as EventListener);
    return told;
  });
}

const pairwise = { strategy: "pairwise", "skip-interval": "4", decorations: "checks:#4c8", paused: "" };

for (const [balls, tests] of [["5", 10], ["20", 190], ["10", 45], ["0", 0], ["1", 0], ["2", 1]] as const) {
  test(`pairwise: ${balls} balls are ${tests} tests, each lit once`, async ({ page }) => {
    const demo = await open(page, { ...pairwise, balls });
    expect((await stateOf(demo)).tests).toBe(0);
    const lit = (await walk(demo)).filter(({ kind }) => kind === "test");
    const first = lit.slice(0, tests);
    expect(first).toHaveLength(tests);
    expect(new Set(first.map(({ a, b }) => `${a} ${b}`)).size).toBe(tests);
    expect((await stateOf(demo)).tests).toBe(tests);
    await expect(demo.locator('[data-counter="tests"]')).toHaveText(String(tests));
  });
}

const everyStrategy: Attributes[] = [
  { strategy: "pairwise", decorations: "checks" },
  { strategy: "sorted-pairwise", decorations: "checks" },
  { strategy: "sorted-pairwise", sort: "insertion", decorations: "checks,edges:array" },
  { strategy: "endpoints", decorations: "edges:array" },
  { strategy: "sweep", sort: "quicksort", decorations: "sweep,checks,edges:array", balls: "8", "no-bounce": "" },
  { strategy: "sweep", axis: "widest", decorations: "sweep,checks" },
  { strategy: "sweep", axis: "all", decorations: "checks" },
  { strategy: "swap", decorations: "checks,edges:array", balls: "8" },
  { strategy: "swap-all-axes", decorations: "checks", balls: "12" },
  { strategy: "one-to-n", focus: "2", decorations: "checks,edges:focus" },
  { strategy: "sap-insertionsort", motion: "drift", "no-bounce": "" },
  { lab: "strict-ties" },
  { lab: "teleport" },
];

for (const attributes of everyStrategy) {
  test(`back and forward again, the same: ${JSON.stringify(attributes)}`, async ({ page }) => {
    const demo = await open(page, { "skip-interval": "3", ...attributes, paused: "" });
    const walked = await demo.evaluate((element: SapDemo) => {
      const forward: unknown[] = [];
      for (let count = 0; count < 60; count++) {
        element.step();
        forward.push([element.state, element.event, element.balls, element.pairs]);
      }
      const back = [forward.at(-1)];
      for (let count = 1; count < 60; count++) {
        element.back();
        back.unshift([element.state, element.event, element.balls, element.pairs]);
      }
      const again: unknown[] = [forward[0]];
      for (let count = 1; count < 60; count++) {
        element.step();
        again.push([element.state, element.event, element.balls, element.pairs]);
      }
      return { forward, back, again };
    });
    expect(walked.back).toEqual(walked.forward);
    expect(walked.again).toEqual(walked.forward);
    expect(new Set(walked.forward.map((moment) => JSON.stringify(moment))).size).toBeGreaterThan(40);
  });
}

test("what is done anew from the past comes out as it did, bit for bit", async ({ page }) => {
  // A ball held by hand is where it is anyway, so all that follows is simulated again.
  const demo = await open(page, { strategy: "swap", balls: "9", draggable: "", paused: "" });
  const walk = (count: number): Promise<DemoState[]> =>
    demo.evaluate((element: SapDemo, count) => Array.from({ length: count }, () => (element.step(), element.state)), count);
  const push = async (): Promise<void> => {
    await demo.locator(".picture").focus();
    await page.keyboard.press("ArrowLeft");
  };
  await walk(30);
  const { tick } = await stateOf(demo);
  await push();
  const first = await walk(40);
  await demo.evaluate((element: SapDemo, tick) => {
    while (element.state.tick > tick) element.back();
    element.back(); // to before the push, at the same tick
  }, tick);
  await push();
  const again = await walk(40);
  expect(again).toEqual(first);
  expect(new Set(first.map(({ hash }) => hash)).size).toBe(40);
});

test("the pairs are those of brute force, whatever finds them", async ({ page }) => {
  const pairsOf = async (attributes: Attributes): Promise<[string, string][]> => {
    const demo = await open(page, { balls: "14", seed: "7", "no-bounce": "", ...attributes, paused: "" });
    return demo.evaluate((element: SapDemo) =>
      Array.from({ length: 60 }, () => {
        element.step();
        return [element.state.hash, JSON.stringify(element.pairs.sort((a, b) => a[0] - b[0] || a[1] - b[1]))];
      }),
    );
  };
  const expected = await pairsOf({ strategy: "pairwise" });
  expect(new Set(expected.map(([, pairs]) => pairs)).size).toBeGreaterThan(3);
  for (const strategy of ["sorted-pairwise", "sweep", "sweep-all-axes", "swap", "swap-all-axes", "sap-quicksort"]) {
    expect(await pairsOf({ strategy }), strategy).toEqual(expected);
  }
});

test("the array is sorted after each step", async ({ page }) => {
  const demo = await open(page, { strategy: "sap-quicksort", decorations: "edges:array", "no-bounce": "", paused: "", balls: "8" });
  const arrays = await demo.evaluate((element: SapDemo) => {
    const told: { kind: string; i: number; j: number }[] = [];
    element.addEventListener("sap-sort", ({ detail }) => told.push(detail));
    const sorts: { swaps: number; told: number; comparisons: number; compared: number }[] = [];
    let tick = element.state.tick;
    for (let count = 0; count < 300; count++) {
      const before = element.state;
      element.step();
      if (element.state.tick === tick) continue;
      sorts.push({
        swaps: before.swaps,
        told: told.filter(({ kind }) => kind === "swap").length,
        comparisons: before.comparisons,
        compared: told.filter(({ kind }) => kind === "compare").length,
      });
      told.length = 0;
      tick = element.state.tick;
    }
    return sorts;
  });
  expect(arrays.length).toBeGreaterThan(2);
  // The first event of the next detection may have been told with it.
  for (const { swaps, told, comparisons, compared } of arrays) {
    expect(Math.abs(told - swaps)).toBeLessThanOrEqual(1);
    expect(Math.abs(compared - comparisons)).toBeLessThanOrEqual(1);
  }
});

test("keys alone: step, back, play, pause, and a ball moved", async ({ page }) => {
  const demo = await open(page, { balls: "[[150,250,50],[300,150,55],[450,275,60]]", static: "", draggable: "", labels: "A,B,C", decorations: "checks" });
  await page.keyboard.press("Tab");
  await expect(demo.locator(".picture")).toBeFocused();
  const before = await demo.evaluate((element: SapDemo) => element.balls[1]![0]);
  await page.keyboard.press("b");
  await page.keyboard.press("b");
  for (let count = 0; count < 4; count++) await page.keyboard.press("Shift+ArrowLeft");
  expect(await demo.evaluate((element: SapDemo) => element.balls[1]![0])).toBe(before - 100);
  expect(await counter(demo, "tests")).toBe("1");
  await page.keyboard.press(",");
  await expect.poll(() => demo.evaluate((element: SapDemo) => element.event?.kind)).toBeDefined();
  await expect(demo.locator('[role="status"]')).not.toBeEmpty();

  const moving = await open(page, pairwise);
  await page.keyboard.press("Tab");
  for (let count = 0; count < 3; count++) await page.keyboard.press("Space");
  expect((await stateOf(moving)).tests).toBe(3);
  await page.keyboard.press("[");
  expect((await stateOf(moving)).tests).toBe(2);
  await page.keyboard.press("]");
  expect((await stateOf(moving)).tests).toBe(3);
  await expect(moving.locator('[role="status"]')).toContainText("Test");
  for (const name of ["Play", "Step back", "Step", "Moment", "Speed", "Reset", "Share or embed"]) {
    await page.keyboard.press("Tab");
    await expect(moving.getByLabel(name, { exact: true })).toBeFocused();
  }
  await moving.getByRole("button", { name: "Play" }).press("Enter");
  await expect.poll(async () => (await stateOf(moving)).tick).toBeGreaterThan(5);
  await moving.getByRole("button", { name: "Pause" }).press("Enter");
  const { tick } = await stateOf(moving);
  await page.waitForTimeout(300);
  expect((await stateOf(moving)).tick).toBe(tick);
});

test("a ball is dragged by a mouse, and goes no further than the wall", async ({ page }) => {
  const demo = await open(page, { balls: "[[150,250,50],[300,150,55]]", static: "", draggable: "", decorations: "checks" });
  const told = await demo.evaluateHandle((element: SapDemo) => {
    const balls: number[] = [];
    element.addEventListener("sap-drag", ({ detail }) => balls.push(detail.ball));
    return balls;
  });
  const box = (await demo.locator(".picture").boundingBox())!;
  const scale = box.width / 600;
  await page.mouse.move(box.x + 150 * scale, box.y + 250 * scale);
  await page.mouse.down();
  await page.mouse.move(box.x + 250 * scale, box.y + 160 * scale, { steps: 5 });
  await page.mouse.move(-50, box.y + 160 * scale, { steps: 5 });
  await page.mouse.up();
  const [x, y] = await demo.evaluate((element: SapDemo) => element.balls[0]!);
  expect(x, "held outside the picture, stopped by the wall").toBe(50);
  expect(y).toBeCloseTo(160, 0);
  expect(await told.evaluate((balls) => [...new Set(balls)])).toEqual([0]);
  await demo.evaluate((element: SapDemo) => element.seek(0));
  expect((await demo.evaluate((element: SapDemo) => element.balls[0]!))[0], "a drag can be undone").toBe(150);
});

test("a finger drags a ball without scrolling, and scrolls where there is none", async ({ browser, baseURL }) => {
  const context = await browser.newContext({ baseURL: baseURL!, hasTouch: true, viewport: { width: 390, height: 700 } });
  const page = await context.newPage();
  const demo = await open(page, { balls: "[[300,200,60]]", static: "", draggable: "" });
  await page.evaluate(() => (document.body.style.minHeight = "3000px"));
  const box = (await demo.locator(".picture").boundingBox())!;
  const client = await context.newCDPSession(page);
  const swipe = async (x: number, y: number, dy: number): Promise<void> => {
    const at = (y: number): { touchPoints: { x: number; y: number }[] } => ({ touchPoints: [{ x, y }] });
    await client.send("Input.dispatchTouchEvent", { type: "touchStart", ...at(y) });
    for (let share = 1; share <= 10; share++) {
      await client.send("Input.dispatchTouchEvent", { type: "touchMove", ...at(y + (dy * share) / 10) });
      await page.waitForTimeout(20);
    }
    await client.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
  };
  await swipe(box.x + box.width / 2, box.y + box.height / 2, -60);
  expect((await demo.evaluate((element: SapDemo) => element.balls[0]!))[1]).toBeCloseTo(200 - (60 * 600) / box.width, 0);
  expect(await page.evaluate(() => scrollY)).toBe(0);
  await swipe(box.x + 20, box.y + box.height - 10, -150);
  await expect.poll(() => page.evaluate(() => scrollY)).toBeGreaterThan(50);
  await context.close();
});

test("bad attributes are said in its place, once, and can be mended", async ({ page }) => {
  for (const [attributes, message] of [
    [{ balls: "many" }, /balls="many"/],
    [{ balls: "[[1,2],[3]]" }, /number 0/],
    [{ balls: "[[50,50,20],[590,50,20]]" }, /number 1/],
    [{ balls: "[[" }, /no JSON/],
    [{ balls: "401" }, /from 0 to 400/],
    [{ strategy: "magic" }, /there is pairwise/],
    [{ sort: "bogo" }, /quicksort/],
    [{ axis: "z" }, /widest/],
    [{ decorations: "glitter" }, /glitter/],
    [{ decorations: "checks:nocolour" }, /nocolour/],
    [{ focus: "5", balls: "5" }, /there are 5 balls/],
    [{ seed: "-1" }, /seed/],
    [{ speed: "0" }, /speed/],
    [{ lab: "bench" }, /one-to-n/],
  ] as [Attributes, RegExp][]) {
    const demo = await open(page, attributes);
    await expect(demo.getByRole("alert")).toHaveText(message);
    await demo.evaluate((element: SapDemo) => {
      for (const { name } of [...element.attributes]) element.removeAttribute(name);
    });
    await expect(demo.getByRole("alert")).toHaveCount(0);
    await expect.poll(async () => (await stateOf(demo)).tick).toBeGreaterThan(1);
  }
});

test("attributes change while it runs, and the world goes on where it was", async ({ page }) => {
  const demo = await open(page, { strategy: "pairwise", balls: "12" });
  await expect.poll(async () => (await stateOf(demo)).tick).toBeGreaterThan(10);
  const { tick } = await stateOf(demo);
  await demo.evaluate((element: SapDemo) => element.setAttribute("strategy", "sweep"));
  await expect.poll(async () => (await stateOf(demo)).comparisons).toBeGreaterThan(0);
  expect((await stateOf(demo)).tick).toBeGreaterThanOrEqual(tick);
  await demo.evaluate((element: SapDemo) => Object.assign(element, { paused: true }));
  await expect(demo.getByRole("button", { name: "Play" })).toBeVisible();
  await demo.evaluate((element: SapDemo) => (element.balls = 3));
  await expect.poll(() => demo.evaluate((element: SapDemo) => element.balls.length)).toBe(3);
});

test("it can be moved, removed and added; many live on one page", async ({ page }) => {
  const demo = await open(page, { strategy: "sweep" });
  await expect.poll(async () => (await stateOf(demo)).tick).toBeGreaterThan(5);
  const ticks = await demo.evaluate(async (element: SapDemo) => {
    const before = element.state.tick;
    const place = document.createElement("section");
    document.querySelector("main")!.append(place);
    place.append(element);
    const moved = element.state.tick;
    element.remove();
    await new Promise((done) => setTimeout(done, 50));
    place.append(element);
    return [moved - before, element.state.tick];
  });
  expect(ticks).toEqual([0, 0]);
  await expect.poll(async () => (await stateOf(demo)).tick, "begun anew").toBeGreaterThan(2);
  const count = await page.evaluate(async () => {
    const all = Array.from({ length: 30 }, (_, index) => {
      const element = document.createElement("sap-demo");
      element.setAttribute("balls", String(index));
      document.querySelector("main")!.append(element);
      return element;
    });
    await Promise.all(all.map((element) => element.ready));
    await new Promise((done) => setTimeout(done, 1000));
    const ran = all.filter(({ state }) => state.tick > 0).length;
    for (const element of all) element.remove();
    return ran;
  });
  expect(count, "only those on the screen run").toBeLessThan(10);
  await demo.evaluate((element: SapDemo) => element.scrollIntoView());
});

test("it sleeps while it cannot be seen", async ({ page }) => {
  const demo = await open(page, {});
  await demo.evaluate((element: SapDemo) => ((element as HTMLElement).style.marginTop = "5000px"));
  await page.waitForTimeout(300);
  const { tick } = await stateOf(demo);
  await page.waitForTimeout(400);
  expect((await stateOf(demo)).tick).toBe(tick);
  await demo.evaluate((element: SapDemo) => element.scrollIntoView());
  await expect.poll(async () => (await stateOf(demo)).tick).toBeGreaterThan(tick);
});

test("with reduced motion it begins still, and can be stepped", async ({ page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  const demo = await open(page, pairwise);
  await page.waitForTimeout(300);
  expect((await stateOf(demo)).tick).toBe(0);
  await step(demo);
  expect((await stateOf(demo)).tests).toBe(1);
});

test("colours follow the page, also when it changes", async ({ page }) => {
  await page.emulateMedia({ colorScheme: "light" });
  const demo = await open(page, { paused: "", balls: "[[300,200,150]]" });
  const centre = (): Promise<number> =>
    demo.locator(".picture canvas").evaluate((canvas: HTMLCanvasElement) => {
      const copy = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true })!;
      copy.drawImage(canvas, canvas.width / 2, canvas.height / 2, 1, 1, 0, 0, 1, 1);
      const [red = 0, green = 0, blue = 0] = copy.getImageData(0, 0, 1, 1).data;
      return red + green + blue;
    });
  await expect.poll(centre).toBeGreaterThan(500);
  await page.emulateMedia({ colorScheme: "dark" });
  await expect.poll(centre).toBeLessThan(300);
  await demo.evaluate((element: SapDemo) => element.style.setProperty("--sap-ball", "white"));
  await expect.poll(centre).toBe(765);
});

test("the picture is as fine as the screen, at any width", async ({ browser }) => {
  const context = await browser.newContext({ deviceScaleFactor: 2, viewport: { width: 390, height: 800 } });
  const page = await context.newPage();
  const demo = await open(page, { paused: "", decorations: "checks,edges:array", balls: "12" });
  for (const width of [390, 320, 700]) {
    await page.setViewportSize({ width, height: 800 });
    const fits = (): Promise<boolean> =>
      demo.locator(".picture canvas").evaluate((canvas: HTMLCanvasElement) => canvas.width === canvas.clientWidth * 2 && canvas.height === canvas.clientHeight * 2);
    await expect.poll(fits).toBe(true);
    expect(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${width}`).toBe(true);
    const { x, width: shown } = (await demo.boundingBox())!;
    for (const button of await demo.getByRole("button").all()) {
      const box = (await button.boundingBox())!;
      expect(box.x + box.width).toBeLessThanOrEqual(x + shown + 0.5);
    }
  }
  await context.close();
});

test("why a pair was tested or skipped, with the numbers", async ({ page }) => {
  const demo = await open(page, { balls: "[[100,200,50],[300,200,50],[500,200,50],[320,120,60]]", static: "", explain: "", labels: "A,B,C,D" });
  const said = demo.locator('[part="said"]');
  const picture = (await demo.locator(".picture").boundingBox())!;
  const scale = picture.width / 600;
  const click = (x: number, y: number): Promise<void> => page.mouse.click(picture.x + x * scale, picture.y + y * scale);
  await click(100, 200);
  await click(300, 210);
  await expect(said).toHaveText("A and B were skipped: A’s right 150 < B’s left 250, and the scan from A stopped here.");
  await click(100, 200);
  await click(500, 200);
  await expect(said).toHaveText("A and C were skipped: the scan from A had stopped at B, A’s right 150 < B’s left 250, and C begins later still, at 450.");
  await click(300, 210);
  await click(320, 90);
  await expect(said).toContainText("were tested, and their boxes overlap: on x D’s left 260 ≤ B’s right 350, on y B’s top 150 ≤ D’s bottom 180.");
  await expect(demo.locator('[role="status"]')).toContainText("were tested");
  // By keys: Tab, then B until the ball is reached, and Enter.
  await page.keyboard.press("Escape");
  for (const key of ["b", "Enter", "b", "b", "Enter"]) await page.keyboard.press(key);
  await expect(said).toContainText("A and C were skipped");
});

test("a guess is asked for before each event, and counted", async ({ page }) => {
  const demo = await open(page, { ...pairwise, predict: "" });
  const group = demo.getByRole("group", { name: "What happens next?" });
  await expect(group).toContainText("are tested next");
  let right = 0;
  for (let made = 1; made <= 10; made++) {
    await group.getByRole("button", { name: "are apart" }).click();
    expect((await stateOf(demo)).tests).toBe(made);
    if (!(await group.textContent())!.includes("No:")) right++;
    await expect(group).toContainText(`${right} of ${made} right`);
  }
  expect(right).toBe(10 - (await demo.evaluate((element: SapDemo) => element.pairs.length)));
});

test("the laboratories go wrong as they should, and say so", async ({ page }) => {
  const ties = await open(page, { lab: "strict-ties", decorations: "", "skip-interval": "0", paused: "" });
  const counts = await ties.evaluate((element: SapDemo) => Array.from({ length: 6 }, () => (element.step(), element.pairs.length)));
  expect(new Set(counts.filter((_, index) => index % 2 === 0)).size).toBe(1);
  expect(counts[0]).not.toBe(counts[1]);
  const hashes = await ties.evaluate((element: SapDemo) => new Set([element.state.hash, (element.step(), element.state.hash)]).size);
  expect(hashes, "nothing moves").toBe(1);

  const centre = await open(page, { lab: "centre-sort" });
  expect(await centre.evaluate((element: SapDemo) => element.pairs)).toEqual([[1, 2]]);
  await expect(centre.locator('[part="said"]')).toContainText("Missed: A and C");

  const one = await open(page, { lab: "one-to-n" });
  await expect(one.locator('[part="said"]')).toContainText("Missed: A and B");

  const start = await open(page, { lab: "wrong-start", paused: "" });
  await step(start);
  expect(await start.evaluate((element: SapDemo) => element.pairs.length)).toBe(0);
  const later = await start.evaluate((element: SapDemo) => {
    for (let count = 0; count < 2000; count++) {
      element.step();
      if (element.pairs.length > 0) return count;
    }
    return -1;
  });
  expect(later, "seen once they have parted and met again").toBeGreaterThan(30);

  const thrown = await open(page, { lab: "teleport", decorations: "", "skip-interval": "0", paused: "" });
  const [swaps, pairs] = await thrown.evaluate((element: SapDemo) => {
    element.step();
    const before = JSON.stringify(element.pairs.sort());
    element.step();
    const { swaps } = element.state;
    return [swaps, before === JSON.stringify(element.pairs.sort())];
  });
  expect(swaps, "past eleven others").toBeGreaterThan(30);
  expect(pairs).toBe(true);
});

test("what is shared opens as it was", async ({ page }) => {
  const demo = await open(page, { strategy: "swap", balls: "7", seed: "42", decorations: "checks:#4c8", paused: "" });
  await demo.evaluate((element: SapDemo) => {
    while (element.state.tick < 20) element.step();
  });
  const { hash, tick } = await stateOf(demo);
  const [url, code] = await demo.evaluate((element: SapDemo) => [element.share(), element.embedCode()]);
  expect(code!.split("\n").length).toBeLessThanOrEqual(5);
  expect(code).toContain("<iframe");
  await page.goto("about:blank");
  await page.goto(url!);
  await demo.evaluate((element: SapDemo) => (element.pause(), element.ready));
  await expect.poll(async () => (await stateOf(demo)).tick).toBeGreaterThanOrEqual(tick);
  await demo.evaluate((element: SapDemo) => element.seek(0));
  await demo.evaluate((element: SapDemo) => {
    while (element.state.tick < 20) element.step();
  });
  expect(await stateOf(demo)).toMatchObject({ tick, hash });
  await demo.getByRole("button", { name: "Share or embed" }).click();
  await expect(demo.getByLabel("Link to this demo")).toHaveValue(/embed\.html#/);
});

test("axe finds nothing", async ({ page }) => {
  for (const attributes of [
    pairwise,
    { static: "", draggable: "", explain: "", decorations: "edges:array", heading: "Six balls", balls: "6" },
    { ...pairwise, predict: "" },
    { balls: "wrong" },
  ] as Attributes[]) {
    for (const colorScheme of ["light", "dark"] as const) {
      await page.emulateMedia({ colorScheme });
      await open(page, attributes);
      await page.evaluate(axeSource);
      const { violations } = await page.evaluate(() => (window as unknown as { axe: { run(): Promise<AxeResults> } }).axe.run());
      expect(violations.map(({ id, nodes }) => [id, nodes.map(({ html }) => html)])).toEqual([]);
    }
  }
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
    await new Promise((done) => setTimeout(done, 3000));
    window.requestAnimationFrame = request;
    times.sort((a, b) => a - b);
    return { median: times[times.length >> 1]!, frames: times.length, ticks: [first, ...more].map(({ state }) => state.tick) };
  });
  await browser.close();
  console.log(`script a frame: median ${mean.median.toFixed(2)} ms in ${mean.frames} frames`);
  expect(mean.frames).toBeGreaterThan(20);
  // The aim is 8 ms; what fails, on a machine busy with other things too, is a whole frame.
  expect(mean.median).toBeLessThan(16);
});
