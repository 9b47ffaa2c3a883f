import { expect, type Locator, test } from "@playwright/test";
import { FallingBalls } from "./falling-balls.ts";
import { frames, settled } from "./support/frames.ts";

// Small pictures: without a graphics card each of them takes time, and what is tested here is what is computed.
test.use({ viewport: { width: 640, height: 700 }, deviceScaleFactor: 0.5 });

test("no number of one method stands under the name of another", async ({ page }) => {
  await page.goto("/?few.bodies=1000#falling");
  const balls = await new FallingBalls(page).open();
  await expect.poll(() => balls.stepNumber()).toBeGreaterThan(5);
  /** What the counters say at once when a choice is changed, before anything could be computed. */
  const textsAfter = (choice: Locator, value: string): Promise<Set<string | null>> =>
    choice
      .evaluate((control: HTMLSelectElement | HTMLInputElement, value) => {
        control.value = value;
        control.dispatchEvent(new Event("change", { bubbles: true }));
        const cells = [...control.closest("falling-balls")!.querySelectorAll(".counter:not([data-counter=brute-force]) dd")];
        return cells.map((cell) => cell.textContent);
      }, value)
      .then((texts) => new Set(texts));
  expect(await textsAfter(balls.algorithm, "global pairwise")).toEqual(new Set(["…"]));
  await expect.poll(() => balls.counter("tests")).toBe("499,500");

  // Nor of one world under those of another, which takes its time to begin.
  expect(await textsAfter(balls.root.getByLabel("Seed"), "9")).toEqual(new Set(["…"]));
  await expect.poll(() => balls.counter("tests")).toBe("499,500");
});

test("a cold start uses the library's sort: insertion sort would take tens of millions of comparisons", async ({ page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  await page.goto("/?few.bodies=4000#falling");
  const balls = await new FallingBalls(page).open();
  await balls.step(1);
  expect(await balls.value("comparisons")).toBeLessThan(110_000);
  await balls.algorithm.selectOption("endpoint sweep");
  await balls.step(1);
  expect(await balls.value("comparisons")).toBeLessThan(220_000);
  await balls.step(1);
  const [comparisons, swaps] = [await balls.value("comparisons"), await balls.value("swaps")];
  expect(comparisons, "insertion sort from then on: the swaps, and at most one more for each endpoint").toBeLessThanOrEqual(swaps + 7_999);
});

test.describe("running", () => {
  {
    test(`counters move, pause holds them, the world goes on afterwards`, async ({ page }) => {
      await page.goto(`/?few.bodies=2000#falling`);
      const balls = await new FallingBalls(page).open();
      const seen = new Set<string>();
      await expect
        .poll(async () => seen.add(await balls.counter("tests")).size, { message: "tests change" })
        .toBeGreaterThan(3);
      for (const key of ["tests", "axis-overlaps", "pairs", "comparisons", "broad-phase", "narrow-phase", "solving", "drawing"]) {
        await expect.poll(() => balls.value(key), { message: key }).toBeGreaterThan(0);
      }

      await balls.pause();
      const [step, hash] = [await balls.stepNumber(), await balls.hash()];
      await frames(page, 30);
      expect([await balls.stepNumber(), await balls.hash()]).toEqual([step, hash]);

      await balls.play.click();
      await expect.poll(() => balls.stepNumber()).toBeGreaterThan(step);
    });
  }

  test("sleeps while it is off the screen", async ({ page }) => {
    await page.goto("/?few.bodies=200#falling");
    const balls = await new FallingBalls(page).open();
    await expect.poll(() => balls.stepNumber()).toBeGreaterThan(5);
    await page.locator("footer").scrollIntoViewIfNeeded();
    const before = await settled(page, () => balls.stepNumber(), "it sleeps");
    await frames(page, 60);
    await balls.root.scrollIntoViewIfNeeded();
    const after = await page.waitForFunction((before) => {
      const step = Number(document.getElementById("few")?.dataset["step"]);
      return step > before && step;
    }, before);
    // Awake it would have gone on by more than 60 steps; nor does it catch up.
    expect(await after.jsonValue()).toBeLessThan(before + 30);
  });
});

test.describe("paused", () => {
  test.use({ contextOptions: { reducedMotion: "reduce" } });

  {
    test(`begins paused where less motion is wanted, and the first step is the first`, async ({ page }) => {
      await page.goto("/#falling");
      const balls = await new FallingBalls(page).open();
      await expect(balls.play).toHaveText("Play");
      expect(await balls.stepNumber()).toBe(0);
      await balls.step(1);
      expect(await balls.stepNumber()).toBe(1);
    });

    test(`the same seed gives the same states, another seed others`, async ({ page }) => {
      await page.goto(`/?few.bodies=500#falling`);
      const balls = await new FallingBalls(page).open();
      const states = async (): Promise<string[]> => {
        const all = [await balls.hash()];
        for (let step = 0; step < 8; step++) {
          await balls.step(1);
          all.push(await balls.hash());
        }
        return all;
      };
      const first = await states();
      expect(new Set(first).size).toBe(first.length);
      await balls.reset();
      expect(await states()).toEqual(first);
      await balls.root.getByLabel("Seed").fill("2");
      await balls.root.getByLabel("Seed").press("Enter");
      await expect(balls.root).toHaveAttribute("data-step", "0");
      await expect.poll(() => balls.hash()).not.toBe(first[0]);
    });

    test(`all algorithms, with every sort, find the same pairs and leave the same state`, async ({ page }) => {
      test.slow(); // some hundred steps, each waited for until it is drawn
      await page.goto(`/?few.bodies=300#falling`);
      const balls = await new FallingBalls(page).open();
      const outcomes = new Map<string, unknown>();
      for (const algorithm of await balls.algorithms()) {
        await balls.reset();
        await balls.algorithm.selectOption(algorithm);
        await balls.step(1); // then it is known whether it sorts
        const sort = balls.root.getByLabel("Sort", { exact: true });
        const sorts = (await sort.isEnabled()) ? await sort.locator("option").allTextContents() : [""];
        for (const name of sorts) {
          await balls.reset();
          if (name) await sort.selectOption(name);
          await balls.step(3);
          outcomes.set(`${algorithm}, ${name}`, { pairs: await balls.value("pairs"), hash: await balls.hash() });
        }
      }
      expect(outcomes.size).toBeGreaterThanOrEqual(5);
      const [expected] = outcomes.values();
      for (const [name, outcome] of outcomes) expect(outcome, name).toEqual(expected);
    });
  }

  test("switching the algorithm in the middle does not disturb the motion", async ({ page }) => {
    await page.goto("/#falling");
    const balls = await new FallingBalls(page).open();
    await balls.step(6);
    const undisturbed = await balls.hash();
    await balls.reset();
    for (const algorithm of (await balls.algorithms()).slice(0, 6)) {
      await balls.algorithm.selectOption(algorithm);
      await balls.step(1);
    }
    expect(await balls.hash()).toBe(undisturbed);
  });

  test("brute force counts n(n - 1)/2 tests, sorted pairwise far fewer, for the same pairs", async ({ page }) => {
    await page.goto("/?few.bodies=1000#falling");
    const balls = await new FallingBalls(page).open();
    await balls.algorithm.selectOption("global pairwise");
    await balls.step(3);
    expect(await balls.counter("brute-force")).toBe("499,500");
    expect(await balls.counter("tests")).toBe("499,500");
    const pairs = await balls.value("pairs");
    await balls.reset();
    await balls.algorithm.selectOption("sorted pairwise");
    await balls.step(3);
    expect(await balls.value("tests")).toBeLessThan(100_000);
    expect(await balls.value("pairs")).toBe(pairs);
  });

  test("what is not counted is an en dash that says why", async ({ page }) => {
    await page.goto("/#falling");
    const balls = await new FallingBalls(page).open();
    await balls.step(1);
    const [library = ""] = await balls.algorithms();
    await balls.algorithm.selectOption(library);
    await balls.step(1);
    for (const key of ["tests", "axis-overlaps", "comparisons", "swaps"]) {
      const cell = balls.root.locator(`[data-counter="${key}"] dd`);
      await expect(cell).toHaveText("–");
      await expect(cell).toHaveAttribute("title", /not counted/);
    }
    expect(await balls.value("pairs")).toBeGreaterThan(0);
  });

  test("the address keeps what was chosen, and nothing else", async ({ page }) => {
    await page.goto("/#falling");
    const balls = await new FallingBalls(page).open();
    expect(new URL(page.url()).search).toBe("");
    await balls.algorithm.selectOption("global pairwise");
    await balls.root.getByRole("slider", { name: "Discs" }).fill("3");
    await balls.root.getByLabel("Seed").fill("7");
    await balls.root.getByLabel("Seed").press("Enter");
    await expect(balls.root.locator('[data-part="bodies-value"]')).toHaveText("5");
    const query = (): Record<string, string> => Object.fromEntries(new URL(page.url()).searchParams);
    await expect.poll(query).toEqual({ "few.algorithm": "global pairwise", "few.bodies": "5", "few.seed": "7" });
    await expect.poll(() => balls.counter("brute-force")).toBe("10");

    await page.reload();
    await balls.open();
    await expect(balls.algorithm).toHaveValue("global pairwise");
    await expect(balls.root.getByLabel("Seed")).toHaveValue("7");
    await balls.step(1);
    expect(await balls.counter("brute-force")).toBe("10");
  });

  test("gravity and substeps change the motion, and the address keeps them", async ({ page }) => {
    await page.goto("/?few.bodies=200#falling");
    const balls = await new FallingBalls(page).open();
    const after = async (steps: number): Promise<string> => {
      await balls.reset();
      await balls.step(steps);
      return balls.hash();
    };
    const usual = await after(3);
    await balls.root.getByRole("slider", { name: "Gravity" }).fill("0");
    await expect.poll(() => new URL(page.url()).searchParams.get("few.gravity")).toBe("-9.81");
    const upwards = await after(3);
    await balls.root.getByRole("slider", { name: "Substeps" }).fill("0");
    await expect.poll(() => new URL(page.url()).searchParams.get("few.substeps")).toBe("1");
    const coarse = await after(3);
    expect(new Set([usual, upwards, coarse]).size).toBe(3);
    await page.reload();
    await balls.open();
    expect(await after(3)).toBe(coarse);
    await page.goto("/?few.bodies=200#falling");
    await balls.open();
    expect(await after(3)).toBe(usual);
  });

  test("an address that makes no sense is ignored", async ({ page }) => {
    await page.goto("/?few.bodies=-3&few.seed=abc&few.size=NaN&few.spread=1e9&few.algorithm=magic&few.axis=&few.gravity=1e9&few.substeps=0#falling");
    const balls = await new FallingBalls(page).open();
    await balls.step(2);
    expect(await balls.counter("brute-force")).toBe("79,800");
    await expect(balls.root.getByLabel("Seed")).toHaveValue("1");
  });

  test("works by the keyboard alone", async ({ page }) => {
    await page.goto("/#falling");
    const balls = await new FallingBalls(page).open();
    await balls.play.focus();
    await page.keyboard.press("Tab");
    await page.keyboard.press("Enter");
    await expect(balls.root).toHaveAttribute("data-step", "1");
    await page.keyboard.press("Shift+Tab");
    await page.keyboard.press("Space");
    await expect(balls.play).toHaveText("Pause");
    await expect.poll(() => balls.stepNumber()).toBeGreaterThan(3);
  });

  test("one body and the most there are", async ({ page }) => {
    for (const bodies of [1, 4000]) {
      await page.goto(`/?few.bodies=${bodies}&few.spread=20&few.size=150#falling`);
      const balls = await new FallingBalls(page).open();
      await balls.step(2);
      expect(await balls.value("brute-force")).toBe((bodies * (bodies - 1)) / 2);
    }
  });
});
