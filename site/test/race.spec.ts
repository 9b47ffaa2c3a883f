import { expect, type Locator, type Page, test } from "@playwright/test";
import { fastest } from "../src/playground/verdict.ts";
import { settled } from "./support/frames.ts";
import { complaints, RACE, requestsElsewhere } from "./support/pages.ts";

const still = { contextOptions: { reducedMotion: "reduce" } } as const;

/** The race of a page, as its visitor handles it. */
class Race {
  readonly root: Locator;
  readonly play: Locator;

  constructor(readonly page: Page) {
    this.root = page.locator("box-playground");
    this.play = this.root.locator('[data-part="play"]');
  }

  async open(query = ""): Promise<this> {
    await this.page.goto(`/race.html${query}`);
    await this.page.waitForURL(/playground\.html/);
    await expect(this.root).toHaveAttribute("data-step", /./);
    return this;
  }

  lane(number: number): Locator {
    return this.root.getByRole("group", { name: `Algorithm ${number}` });
  }

  async value(lane: number, key: string): Promise<number> {
    const text = await this.lane(lane).locator(`[data-counter="${key}"] dd`).textContent();
    return Number.parseFloat((text ?? "").replaceAll(",", ""));
  }

  async step(): Promise<void> {
    const before = Number(await this.root.getAttribute("data-step"));
    await this.root.getByRole("button", { name: "Step" }).click();
    await expect(this.root).toHaveAttribute("data-step", String(before + 1));
  }
}

test("runs, compares every step, plots, and complains of nothing", async ({ page, baseURL }) => {
  const heard = complaints(page);
  const elsewhere = requestsElsewhere(page, baseURL ?? "");
  const race = new Race(page);
  await page.goto(RACE);
  await expect.poll(async () => Number(await race.root.getAttribute("data-step"))).toBeGreaterThan(10);
  await expect(race.root.locator('[data-part="verdict"]')).toContainText(/All 4 found the same [\d,]+ pairs, in this step and in all \d+ so far/);
  await expect(race.root.locator('[data-part="alarm"]')).toBeEmpty();
  const plot = race.root.locator('[data-part="lines"]');
  const before = await plot.screenshot();
  await race.root.getByLabel("Plot", { exact: true }).selectOption("tests");
  await expect.poll(async () => before.equals(await plot.screenshot())).toBe(false);
  await race.play.click();
  await expect(race.root.locator('[data-part="status"]')).toContainText("Paused");
  await settled(page, () => race.root.getAttribute("data-step"), "no step after the one that was on its way");
  expect(heard).toEqual([]);
  expect(elsewhere).toEqual([]);
});

test("the fastest is named by 60 measured steps, in each half of them, and by no less than a tick of the clock", () => {
  const steps = (ms: (step: number) => number): number[] => Array.from({ length: 60 }, (_, step) => ms(step));
  const said = (a: number[], b: number[]): string => fastest([{ name: "A", times: a }, { name: "B", times: b }]);
  const tick = (step: number): number => (step % 10 === 0 ? 0.1 : 0);
  expect(said(steps(() => 6).slice(1), steps(() => 1))).toBe("Measuring the time: 59 of 60 steps.");
  expect(said(steps((step) => 6 + tick(step)), steps(() => 1))).toBe("Fastest: B, 6.0 times as fast as A.");
  expect(said(steps((step) => 1 + tick(step)), steps((step) => 1.02 + tick(step + 1)))).toBe("Fastest: A and B, about equal.");
  // A clock that ticks ten times a millisecond shows mostly 0: not "60,000 times as fast".
  expect(said(steps(() => 6.2), steps(tick))).toBe("Fastest: B, at least 62 times as fast as A.");
  expect(said(steps((step) => tick(step + 5)), steps(tick))).toContain("both faster than the clock");
  expect(said(steps((step) => (step < 30 ? 1 : 3) + tick(step)), steps((step) => (step < 30 ? 2 : 1)))).toBe("No algorithm is the fastest all the time.");
});

test("no verdict moves what follows: there is room for the longest one at any width", async ({ page }) => {
  const race = await new Race(page).open();
  await race.root.getByRole("button", { name: "Pause" }).click();
  await settled(page, () => race.root.getAttribute("data-step"), "no step after the one that was on its way");
  const names = await race.lane(1).getByLabel("Algorithm", { exact: true }).locator("option").allTextContents();
  const longest = names.sort((a, b) => b.length - a.length).slice(0, 2).map((name) => ({ name, times: Array.from({ length: 60 }, () => 0.1) }));
  const text = `All 4 found the same 1,234,567 pairs, in this step and in all 12,345 so far. ${fastest(longest)}`;
  for (const width of [1280, 1000, 820, 640, 390, 320]) {
    await page.setViewportSize({ width, height: 900 });
    const heights = await race.root.locator('[data-part="verdict"]').evaluate((verdict, text) => {
      return ["Measuring", text].map((shown) => ((verdict.textContent = shown), verdict.getBoundingClientRect().height));
    }, text);
    expect(heights[1], `at ${width} pixels`).toBe(heights[0]);
  }
});

test("other boxes clear what the one before showed, and names the fastest after some steps", async ({ page }) => {
  const race = await new Race(page).open();
  await expect(race.root.locator('[data-part="verdict"]')).toContainText(/Fastest: |No algorithm is the fastest|faster than the clock/);
  const shown = await race.root.evaluate((track) => {
    const seed = track.querySelector<HTMLInputElement>('[data-part="seed"]')!;
    seed.value = "7";
    seed.dispatchEvent(new Event("change", { bubbles: true }));
    const text = (part: string): string => track.querySelector(`[data-part="${part}"]`)!.textContent!.trim();
    // At once, before the thread of the race can answer.
    return [text("message"), text("moment"), text("verdict"), ...[...track.querySelectorAll(".lane dd")].map((cell) => cell.textContent!)];
  });
  expect(shown.slice(0, 3)).toEqual(["Working …", "Working …", ""]);
  expect(new Set(shown.slice(3))).toEqual(new Set(["–"]));
});

test("a runner that finds other pairs is told of loudly", async ({ page }) => {
  // The compiled runners agree; so one of their reports is changed on its way to the page.
  await page.addInitScript(() => {
    const listen = Worker.prototype.addEventListener;
    Worker.prototype.addEventListener = function (this: Worker, kind: string, heard: (event: MessageEvent) => void) {
      listen.call(this, kind, ((event: MessageEvent) => {
        const { data } = event;
        if (data?.type === "frame" && data.step === 3) data.lanes[2].report.fingerprint = "0".repeat(16);
        heard(event);
      }) as EventListener);
    } as typeof listen;
  });
  const race = await new Race(page).open("?boxes=100");
  await expect(race.root.getByRole("alert")).toHaveText(/In step 3, algorithm 3 found other pairs/);
  await expect(race.root.locator('[data-part="verdict"]')).toHaveText("The algorithms disagree.");
  // Hundreds of steps a second go by: it must stand still to be seen at its beginning.
  await race.root.getByRole("button", { name: "Pause" }).click();
  await race.root.getByRole("button", { name: "Reset" }).click();
  await expect.poll(async () => Number(await race.root.getAttribute("data-step"))).toBeLessThan(3);
});

test.describe("paused", () => {
  test.use(still);

  test("counts what each does: brute force all pairs, swap-driven what has passed", async ({ page }) => {
    const race = await new Race(page).open("?boxes=200&motion=still");
    await expect(race.play).toHaveText("Play");
    expect(await race.value(1, "tests")).toBe(19_900);
    const swept = await race.value(2, "tests");
    expect(swept).toBeGreaterThan(0);
    expect(swept).toBeLessThan(19_900);
    // The first step is sorted by the library, not by an insertion sort from scratch.
    expect(await race.value(2, "comparisons")).toBeLessThan(3_000);
    await race.step();
    // Nothing has moved: the sort looks once at each neighbor and swaps nothing.
    expect(await race.value(2, "comparisons")).toBe(199);
    expect(await race.value(2, "swaps")).toBe(0);
    expect(await race.value(3, "comparisons")).toBe(399);
    expect(await race.value(3, "swaps")).toBe(0);
    const pairs = await race.value(1, "pairs");
    for (const lane of [2, 3, 4]) expect(await race.value(lane, "pairs")).toBe(pairs);
    await expect(race.lane(4).locator('[data-counter="tests"] dd')).toHaveText("–");
    await expect(race.lane(4).locator('[data-counter="tests"] dd')).toHaveAttribute("title", /not counted/);
  });

  test("every algorithm and the library agree in every motion", async ({ page }) => {
    const race = await new Race(page).open("?boxes=200");
    const algorithms = await race.lane(3).getByLabel("Algorithm", { exact: true }).locator("option").allTextContents();
    expect(algorithms.length).toBe(8);
    for (const motion of await race.root.getByLabel("Motion").locator("option").allTextContents()) {
      await race.root.getByLabel("Motion").selectOption(motion);
      for (const [second, third] of [["endpoint sweep", "broad phase"], ["endpoint sweep on every axis", "swap-driven sweep on every axis"]]) {
        await race.lane(2).getByLabel("Algorithm", { exact: true }).selectOption(second ?? "");
        await race.lane(3).getByLabel("Algorithm", { exact: true }).selectOption(third ?? "");
        await expect(race.root).toHaveAttribute("data-step", "0");
        for (let step = 0; step < 3; step++) await race.step();
        await expect(race.root.locator('[data-part="verdict"]')).toContainText("All 4 found the same");
      }
    }
  });

  test("the address keeps each algorithm, and nothing else; one that is removed leaves no gap", async ({ page }) => {
    const race = new Race(page);
    await page.goto("/playground.html");
    await expect(race.root).toHaveAttribute("data-step", "0");
    expect(new URL(page.url()).search).toBe("");
    await expect(race.root.locator('[data-part="lines"]')).toBeHidden();
    for (const added of ["find pairs", "swap-driven sweep", "global pairwise"]) {
      await race.root.getByRole("button", { name: "Add an algorithm" }).click();
      await expect(race.root.getByLabel("Algorithm", { exact: true }).last()).toHaveValue(added);
      await expect(race.root.getByLabel("Algorithm", { exact: true }).last()).toBeFocused();
    }
    await expect(race.root.getByRole("button", { name: "Add an algorithm" })).toBeHidden();
    await race.root.getByRole("button", { name: "Remove algorithm 2" }).click();
    await expect(race.lane(1).getByLabel("Algorithm", { exact: true })).toBeFocused();
    await race.lane(2).getByLabel("Sort").selectOption("Timsort");
    await race.lane(2).getByLabel("Sweep axis").selectOption("y");
    const kept = { "2": "swap-driven sweep", "2.sort": "Timsort", "2.axis": "y", "3": "global pairwise" };
    expect(Object.fromEntries(new URL(page.url()).searchParams)).toEqual(kept);
    await page.reload();
    await expect(race.root.locator('[data-part="verdict"]')).toContainText("All 3 found the same");
    await expect(race.lane(2).getByLabel("Sort")).toHaveValue("Timsort");
  });

  test("an old address of the race leads to the same race", async ({ page }) => {
    const race = await new Race(page).open("?boxes=200&scene=tower&1=endpoint+sweep&1.sort=Timsort&3=none");
    await expect(race.root.locator('[data-part="verdict"]')).toContainText("All 3 found the same");
    await expect(race.lane(1).getByLabel("Algorithm", { exact: true })).toHaveValue("endpoint sweep");
    await expect(race.lane(1).getByLabel("Sort")).toHaveValue("Timsort");
    await expect(race.lane(3).getByLabel("Algorithm", { exact: true })).toHaveValue("find pairs");
    await expect(race.root.getByLabel("Scene")).toHaveValue("tower");
  });

  test("too many pairs, or too much to keep, is refused in words", async ({ page }) => {
    const race = await new Race(page).open("?scene=coincident&boxes=20000");
    await expect(race.root.locator('[data-part="message"]')).toContainText("199,990,000 pairs; the limit is 2,000,000");
    // Boxes of one's own can take their place.
    await race.root.getByText("Paste boxes as text").click();
    await race.root.locator('[data-part="pasted"]').fill("0,0,2,2\n1,1,3,3");
    await race.root.getByRole("button", { name: "Use these boxes" }).click();
    await expect(race.root.locator('[data-part="imported"]')).toHaveText("2 boxes imported.");
    await expect.poll(() => race.value(1, "pairs")).toBe(1);
    await race.open("?scene=tower&boxes=20000&2.axis=y&3.axis=x&1=find+pairs");
    await expect(race.lane(3).locator('.lane-out')).toContainText("would have to keep 199,");
    await expect(race.root.locator('[data-part="verdict"]')).toContainText("found the same");
  });

  test("works by the keyboard alone", async ({ page }) => {
    const race = await new Race(page).open("?boxes=100");
    await race.play.focus();
    await page.keyboard.press("Tab");
    await page.keyboard.press("Enter");
    await expect(race.root).toHaveAttribute("data-step", "1");
    await page.keyboard.press("Shift+Tab");
    await page.keyboard.press("Space");
    await expect(race.play).toHaveText("Pause");
    await expect.poll(async () => Number(await race.root.getAttribute("data-step"))).toBeGreaterThan(3);
  });
});

test("20,000 boxes and brute force leave the page responsive; what is too slow is stopped", async ({ page }) => {
  test.skip(!process.env["TEST_LONG"], "times hold on a machine that does nothing else");
  const race = await new Race(page).open("?boxes=20000");
  await expect.poll(async () => Number(await race.root.getAttribute("data-step")), { timeout: 600_000 }).toBeGreaterThan(2);
  const longest = await page.evaluate(async () => {
    let [longest, last] = [0, performance.now()];
    for (const end = last + 2000; last < end; ) {
      await new Promise((resolve) => setTimeout(resolve, 5));
      const now = performance.now();
      longest = Math.max(longest, now - last);
      last = now;
    }
    return longest;
  });
  console.log(`race, 20,000 boxes: longest gap of the page's thread ${longest.toFixed(0)} ms`);
  expect(longest).toBeLessThan(400);
  const brute = await race.value(1, "tests");
  const out = await race.lane(1).locator('.lane-out').textContent();
  expect(brute === 199_990_000 || /^Stopped: .*the limit is/.test(out ?? "")).toBe(true);
});
