import { expect, type Locator, type Page, test } from "@playwright/test";
import { settled } from "./support/frames.ts";
import { complaints, requestsElsewhere } from "./support/pages.ts";

const still = { contextOptions: { reducedMotion: "reduce" } } as const;

/** The race of a page, as its visitor handles it. */
class Race {
  readonly root: Locator;
  readonly play: Locator;

  constructor(readonly page: Page) {
    this.root = page.locator("race-track");
    this.play = this.root.locator('[data-part="play"]');
  }

  async open(query = ""): Promise<this> {
    await this.page.goto(`/race.html${query}`);
    await expect(this.root).toHaveAttribute("data-step", /./);
    return this;
  }

  lane(number: number): Locator {
    return this.root.getByRole("group", { name: `Lane ${number}` });
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
  const race = await new Race(page).open();
  await expect.poll(async () => Number(await race.root.getAttribute("data-step"))).toBeGreaterThan(10);
  await expect(race.root.locator('[data-part="verdict"]')).toContainText(/All 4 found the same [\d,]+ pairs, in this step and in all \d+ so far/);
  await expect(race.root.locator('[data-part="alarm"]')).toBeEmpty();
  const plot = race.root.locator('[data-part="plot"]');
  const before = await plot.screenshot();
  await race.root.getByLabel("Plot").selectOption("tests");
  await expect.poll(async () => before.equals(await plot.screenshot())).toBe(false);
  await race.play.click();
  await expect(race.root.getByRole("status")).toContainText("Paused");
  await settled(page, () => race.root.getAttribute("data-step"), "no step after the one that was on its way");
  expect(heard).toEqual([]);
  expect(elsewhere).toEqual([]);
});

test("another race clears what the one before showed, and names the fastest after some steps", async ({ page }) => {
  const race = await new Race(page).open();
  await expect(race.root.locator('[data-part="verdict"]')).toContainText(/Fastest: [a-z -]+, ([\d.]+ times as fast as [a-z -]+|and [a-z -]+, about equal)/);
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
  await expect(race.root.getByRole("alert")).toHaveText(/In step 3, lane 3 found other pairs/);
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
    const algorithms = await race.lane(3).getByLabel("Algorithm").locator("option").allTextContents();
    expect(algorithms.length).toBe(9);
    for (const motion of await race.root.getByLabel("Motion").locator("option").allTextContents()) {
      await race.root.getByLabel("Motion").selectOption(motion);
      for (const [second, third] of [["endpoint sweep", "broad phase"], ["endpoint sweep on every axis", "swap-driven sweep on every axis"]]) {
        await race.lane(2).getByLabel("Algorithm").selectOption(second ?? "");
        await race.lane(3).getByLabel("Algorithm").selectOption(third ?? "");
        await expect(race.root).toHaveAttribute("data-step", "0");
        for (let step = 0; step < 3; step++) await race.step();
        await expect(race.root.locator('[data-part="verdict"]')).toContainText("All 4 found the same");
      }
    }
  });

  test("the address keeps the algorithm of each lane, and nothing else", async ({ page }) => {
    const race = await new Race(page).open();
    expect(new URL(page.url()).search).toBe("");
    await race.root.getByLabel("Scene").selectOption("tower");
    await race.root.getByLabel("Motion").selectOption("teleport");
    await race.lane(2).getByLabel("Algorithm").selectOption("endpoint sweep");
    await race.lane(2).getByLabel("Sort").selectOption("Timsort");
    await race.lane(2).getByLabel("Sweep axis").selectOption("y");
    await race.lane(4).getByLabel("Algorithm").selectOption("none");
    const kept = { scene: "tower", motion: "teleport", "2": "endpoint sweep", "2.sort": "Timsort", "2.axis": "y", "4": "none" };
    expect(Object.fromEntries(new URL(page.url()).searchParams)).toEqual(kept);
    await page.reload();
    await expect(race.root).toHaveAttribute("data-step", "0");
    await expect(race.root.locator('[data-part="verdict"]')).toContainText("All 3 found the same");
    await expect(race.lane(2).getByLabel("Sort")).toHaveValue("Timsort");
    await race.open("?boxes=-7&scene=nowhere&1=magic&dimensions=9&seed=x&plot=none");
    expect(await race.value(1, "tests")).toBe(499_500);
  });

  test("too many pairs, or too much to keep, is refused in words", async ({ page }) => {
    const race = await new Race(page).open("?scene=coincident&boxes=20000");
    await expect(race.root.locator('[data-part="message"]')).toContainText("199,990,000 pairs; the limit is 2,000,000");
    await race.open("?scene=tower&boxes=20000&2.axis=y&3.axis=x&1=find+pairs");
    await expect(race.lane(3).locator('[data-part="out"]')).toContainText("would have to keep 199,");
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
  const out = await race.lane(1).locator('[data-part="out"]').textContent();
  expect(brute === 199_990_000 || /^Stopped: .*the limit is/.test(out ?? "")).toBe(true);
});
