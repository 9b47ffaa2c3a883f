import { readdirSync, readFileSync } from "node:fs";
import { expect, test } from "@playwright/test";
import { Demo } from "./support/demo.ts";

test.describe("does what its caption says", () => {
  test.beforeEach(({ page }) => page.goto("/"));

  for (const [id, balls, tests] of [["d2", 5, 10], ["d3", 20, 190], ["d6a", 10, 45], ["d13a", 6, 15]] as const) {
    test(`${id}: ${tests} tests for ${balls} balls, wherever they are`, async ({ page }) => {
      const demo = await new Demo(page, id).open();
      expect(await demo.balls()).toHaveLength(balls);
      await demo.pause();
      await demo.finish();
      for (let detections = 0; detections < 3; detections++) {
        const state = await demo.finish();
        expect(state.tests).toBe(tests);
      }
    });
  }

  test("d4: two gaps save the third test, and the code says why", async ({ page }) => {
    const demo = await new Demo(page, "d4").open();
    const code = page.locator("transitivity-code");
    await expect(code.locator("[data-part=ac]")).toHaveText("// A and C: skipped");
    await demo.drag(1, -80);
    await expect(code.locator("[data-part=ab]")).toContainText("false");
    await expect(code.locator("[data-part=bc]")).toContainText("true");
    await expect(code.locator("[data-part=ac]")).toContainText("A.right < C.left");
    await expect(code.locator("[data-part=why]")).toContainText("must be tested");
    await demo.drag(1, 80);
    await expect(code.locator("[data-part=ac]")).toHaveText("// A and C: skipped");
  });

  test("d5, d11: fewer tests than pairs, as many as overlap on x", async ({ page }) => {
    for (const id of ["d5", "d11", "d13b"]) {
      const demo = await new Demo(page, id).open();
      await demo.pause();
      await demo.finish();
      const { tests, axisOverlaps, balls } = await demo.finish();
      let expected = 0;
      for (const [at, [x = 0, , r = 0]] of balls.entries()) {
        for (const [otherX = 0, , otherR = 0] of balls.slice(at + 1)) expected += Number(Math.abs(x - otherX) <= r + otherR);
      }
      expect(tests).toBe(expected);
      expect(axisOverlaps).toBe(expected);
      expect(tests).toBeLessThan((balls.length * (balls.length - 1)) / 2);
    }
  });

  test("d9, d10: the line enters and leaves every ball once", async ({ page }) => {
    for (const id of ["d9", "d10"]) {
      const demo = await new Demo(page, id).open();
      await demo.pause();
      await demo.finish();
      const kinds: string[] = [];
      const before = (await demo.state()).tick;
      while ((await demo.state()).tick === before) kinds.push(...(await demo.step(1)));
      // The last step has begun the next sweep already.
      const entered = kinds.filter((kind) => kind === "enter").length;
      const left = kinds.filter((kind) => kind === "leave").length;
      expect([8, 9]).toContain(entered);
      expect(left).toBe(8);
    }
  });

  for (const id of ["every-axis-demo", "d13c"]) {
    test(`${id}: a sweep on both axes sets a flag for each overlap on either, and tests no boxes`, async ({ page }) => {
      const demo = await new Demo(page, id).open();
      await demo.pause();
      await demo.reset();
      for (let detections = 0; detections < 5; detections++) {
        const { tests, flagChecks, axisOverlaps, pairs, balls } = await demo.finish();
        let [onAxes, onBoth] = [0, 0];
        for (const [at, [x = 0, y = 0, r = 0]] of balls.entries()) {
          for (const [otherX = 0, otherY = 0, otherR = 0] of balls.slice(at + 1)) {
            const axes = Number(Math.abs(x - otherX) <= r + otherR) + Number(Math.abs(y - otherY) <= r + otherR);
            onAxes += axes;
            onBoth += Number(axes === 2);
          }
        }
        expect([tests, flagChecks, axisOverlaps, pairs]).toEqual([0, onAxes, onAxes, onBoth]);
      }
    });
  }

  test("d12: swaps on both axes leave only pairs whose boxes overlap, and check flags where something changes", async ({ page }) => {
    for (const id of ["d12"]) {
      const demo = await new Demo(page, id).open();
      await demo.pause();
      await demo.reset();
      // At first each overlap on either axis is found; after that only changes are counted.
      const { flagChecks: atFirst, axisOverlaps } = await demo.finish();
      expect(atFirst).toBe(axisOverlaps);
      expect(atFirst).toBeGreaterThan(0);
      await expect(demo.root.locator("[data-counter=flag-checks]")).not.toBeEmpty();
      await expect(demo.root.locator("[data-counter=tests]")).toHaveCount(0);
      let before = axisOverlaps;
      for (let detections = 0; detections < 20; detections++) {
        const now = await demo.finish();
        expect(now.flagChecks).toBeGreaterThanOrEqual(Math.abs(now.axisOverlaps - before));
        expect(now.flagChecks).toBeLessThan(15);
        before = now.axisOverlaps;
      }
      const { tests, pairs, balls } = await demo.finish();
      let expected = 0;
      for (const [at, [x = 0, y = 0, r = 0]] of balls.entries()) {
        for (const [otherX = 0, otherY = 0, otherR = 0] of balls.slice(at + 1)) {
          expected += Number(Math.abs(x - otherX) <= r + otherR && Math.abs(y - otherY) <= r + otherR);
        }
      }
      expect([tests, pairs]).toEqual([0, expected]);
    }
  });

  test("d14, d15: quicksort compares far more than insertion sort, which needs 11 and one for each swap", async ({ page }) => {
    const quick = await new Demo(page, "d14").open();
    await quick.pause();
    await quick.finish();
    const insertion = await new Demo(page, "d15").open();
    await insertion.pause();
    await insertion.finish();
    for (let detections = 0; detections < 3; detections++) {
      const ofQuick = await quick.finish();
      const ofInsertion = await insertion.finish();
      expect(ofInsertion.comparisons).toBeGreaterThanOrEqual(11);
      expect(ofInsertion.comparisons).toBeLessThanOrEqual(11 + ofInsertion.swaps);
      expect(ofQuick.comparisons).toBeGreaterThan(ofInsertion.comparisons);
    }
  });

  test("d17: each left endpoint that the right endpoint of A passes is a swap and one more overlap", async ({ page }) => {
    const demo = await new Demo(page, "d17").open();
    const before = await demo.state();
    await demo.drag(0, 100);
    await expect.poll(async () => (await demo.state()).axisOverlaps).toBeGreaterThan(before.axisOverlaps);
  });

  test("the axis: 53 and 9 for the tall world, none and 64 for the wide one, 56 and 8 for the clusters", async ({ page }) => {
    const demo = await new Demo(page, "axis-demo").open();
    const world = page.locator("#axis-demo").getByLabel("World");
    const axis = page.locator("#axis-demo").getByLabel("Sweep along");
    for (const [name, x, y] of [["Tall", 53, 9], ["Wide", 0, 64], ["Two clusters", 56, 8]] as const) {
      await world.selectOption(name);
      for (const [choice, tests] of [["x", x], ["y", y], ["fewest-overlaps", Math.min(x, y)]] as const) {
        await axis.selectOption(choice);
        await expect.poll(async () => (await demo.state()).tests, { message: `${name} along ${choice}` }).toBe(tests);
      }
    }
    await axis.selectOption("widest");
    await expect.poll(async () => (await demo.state()).tests, { message: "the variance is fooled" }).toBe(56);
  });
});

test("the side-scroller: one or two tests a row along x in every frame, nearly all of 190 pairs along y", async ({ page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  await page.goto("/#side-scroller");
  const counts = await page.locator("#side-scroller").evaluate(async (comparison) => {
    // The demos are loaded when a reader comes near them.
    await customElements.whenDefined("sap-demo");
    const demos = [...comparison.querySelectorAll("sap-demo")] as (HTMLElement & { ready: Promise<void>; step(): void; state: { tests: number; tick: number } })[];
    await Promise.all(demos.map(({ ready }) => ready));
    const counts: number[][] = [];
    let [tick, last] = [0, demos.map(({ state }) => state.tests)];
    while (counts.length < 60) {
      demos[0]!.step();
      if (demos[0]!.state.tick !== tick) counts.push(last);
      tick = demos[0]!.state.tick;
      last = demos.map(({ state }) => state.tests);
    }
    return counts;
  });
  expect(Math.min(...counts.map(([x]) => x!))).toBeGreaterThan(0);
  expect(Math.max(...counts.map(([x]) => x!))).toBeLessThanOrEqual(40);
  expect(Math.min(...counts.map(([, y]) => y!))).toBeGreaterThan(150);
});

test.describe("mistakes are shown to be mistakes", () => {
  test.beforeEach(({ page }) => page.goto("/"));

  /** How many pairs of boxes overlap. */
  const overlapping = (balls: number[][]): number => {
    let pairs = 0;
    for (const [at, [x = 0, y = 0, r = 0]] of balls.entries()) {
      for (const [otherX = 0, otherY = 0, otherR = 0] of balls.slice(at + 1)) {
        pairs += Number(Math.abs(x - otherX) <= r + otherR && Math.abs(y - otherY) <= r + otherR);
      }
    }
    return pairs;
  };

  for (const [id, missed] of [["center-sort", 1], ["one-to-n-misses", 1], ["wrong-start-demo", 2]] as const) {
    test(`${id}: ${missed} of the pairs ${missed === 1 ? "is" : "are"} missed`, async ({ page }) => {
      const demo = await new Demo(page, id).open();
      const { pairs } = await demo.state();
      expect(overlapping(await demo.balls()) - pairs).toBeGreaterThanOrEqual(missed);
    });
  }

  test("one-to-n finds the large ball once its edge slips in", async ({ page }) => {
    const demo = await new Demo(page, "one-to-n-misses").open();
    // Three guesses, and then what it finds is shown: D.
    await demo.root.locator(".picture").focus();
    for (let guess = 0; guess < 3; guess++) await page.keyboard.press("1");
    const pairs = (): Promise<number[][]> => demo.root.evaluate((element) => (element as unknown as { pairs: number[][] }).pairs);
    await expect.poll(pairs).toEqual([[0, 3]]);
    await demo.drag(0, -150);
    await expect.poll(async () => JSON.stringify(await pairs())).toContain("[0,1]");
  });

  test("a wrong start finds the pair when the two part and meet again", async ({ page }) => {
    const demo = await new Demo(page, "wrong-start-demo").open();
    expect((await demo.state()).pairs).toBe(0);
    await demo.drag(0, -60);
    await demo.drag(0, 60);
    await expect.poll(async () => (await demo.state()).pairs).toBe(1);
  });

  test("ties under a strict comparison swap at rest, for ever", async ({ page }) => {
    const demo = await new Demo(page, "strict-ties").open();
    await demo.pause();
    await demo.finish();
    const swaps = [];
    const pairs = new Set<number>();
    for (let detections = 0; detections < 4; detections++) {
      const state = await demo.finish();
      swaps.push(state.swaps);
      pairs.add(state.pairs);
    }
    expect(Math.min(...swaps)).toBeGreaterThan(0);
    expect(pairs.size, "the overlaps flicker").toBeGreaterThan(1);
  });
});

test("the article has at most 5,200 words, and on a phone at most 45,000 pixels", async ({ page }) => {
  const words = readdirSync(new URL("../src/article/sections/", import.meta.url)).map((file) =>
    readFileSync(new URL(`../src/article/sections/${file}`, import.meta.url), "utf8").replace(/<[^>]*>/g, " ").split(/\s+/).filter(Boolean).length,
  );
  expect(words).toHaveLength(15);
  expect(words.reduce((sum, count) => sum + count)).toBeLessThanOrEqual(5_200);
  await page.emulateMedia({ reducedMotion: "reduce" });
  await page.setViewportSize({ width: 390, height: 844 });
  await page.goto("/");
  await page.locator("sap-demo").first().scrollIntoViewIfNeeded();
  await page.evaluate(async () => {
    await customElements.whenDefined("sap-demo");
    await Promise.all([...document.querySelectorAll("sap-demo")].map((demo) => (demo as HTMLElement & { ready: Promise<void> }).ready));
  });
  expect(await page.evaluate(() => document.documentElement.scrollHeight)).toBeLessThanOrEqual(45_000);
});

for (const place of ["#d2", "#wrong-start-demo", "library-trial"]) {
  test(`${place} is scrolled to before the article is laid out, and stays where it is`, async ({ page }) => {
    // Nothing is ever idle, and five seconds never pass: only the scrolling lays the sections out.
    await page.addInitScript(() => {
      window.requestIdleCallback = () => 0;
      const { setTimeout } = window;
      window.setTimeout = ((call: () => void, after?: number) => (after === 5000 ? 0 : setTimeout(call, after))) as typeof setTimeout;
    });
    await page.goto("/");
    const left = page.locator(".from-the-top .sections > section:not(.laid-out)");
    expect(await left.count()).toBeGreaterThan(0);
    // Not every browser keeps by itself what is in view.
    await page.evaluate(() => document.documentElement.style.setProperty("overflow-anchor", "none"));
    await page.locator(place).scrollIntoViewIfNeeded();
    await expect(left).toHaveCount(0);
    await expect(page.locator(place)).toBeInViewport();
  });
}

test.describe("listings", () => {
  test("a line lights while the demo does what it says, until that is switched off", async ({ page }) => {
    await page.goto("/");
    const demo = await new Demo(page, "d2").open();
    const listing = page.locator(".listing[data-follows=d2]");
    await demo.pause();
    await demo.step(2);
    await expect(listing.locator(".at-work")).toHaveText(/overlaps\(a, b\)/);
    const follow = listing.getByRole("button", { name: "Follow the demo" });
    await follow.click();
    await expect(follow).toHaveAttribute("aria-pressed", "false");
    await expect(listing.locator(".at-work")).toHaveCount(0);
    await demo.step(2);
    await expect(listing.locator(".at-work")).toHaveCount(0);
    await page.reload();
    await expect(page.locator(".listing [aria-pressed=true]")).toHaveCount(0);
  });

  test("what is copied is what is tested", async ({ page, context }) => {
    await context.grantPermissions(["clipboard-read", "clipboard-write"]);
    await page.goto("/");
    // Some listings are folded away.
    await page.locator("details").evaluateAll((all) => all.forEach((details) => details.setAttribute("open", "")));
    for (const listing of await page.locator("figure.listing").all()) {
      const button = listing.locator("[data-part=copy]");
      await expect(button).toHaveText("Copy");
      // It says so for a moment, which a busy machine may miss if it looks now and then.
      const said = button.evaluate((button) => new Promise((resolve) => {
        new MutationObserver(() => resolve(button.textContent)).observe(button, { childList: true });
      }));
      await button.click();
      expect(await said).toBe("Copied");
      const copied = await page.evaluate(() => navigator.clipboard.readText());
      const name = await listing.locator("figcaption span").textContent();
      const source = readFileSync(new URL(`../src/listings/${name}`, import.meta.url), "utf8");
      const shown = source.split("\n").filter((line) => !line.startsWith("import ")).join("\n");
      // The tags are all that is missing.
      expect(copied.replace(/\s+/g, "")).toBe(shown.replace(/(\/\/)?(\s+@[a-z]+)+$/gm, "").replace(/\s+/g, ""));
      expect(copied).not.toContain("@");
    }
  });
});

test("the contents lead to every section and say where one is", async ({ page }) => {
  await page.goto("/");
  const contents = page.getByRole("navigation", { name: "Contents" });
  const links = await contents.getByRole("link").all();
  expect(links.length).toBeGreaterThan(12);
  for (const link of [links[3], links.at(-1), links[0]]) {
    await link?.click();
    await expect(link as NonNullable<typeof link>).toHaveAttribute("aria-current", "true");
  }
});

test("on a phone, a line at the top names the section that is being read, and leads back to the contents", async ({ page }) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await page.goto("/");
  const here = page.locator(".here");
  await expect(here).toBeHidden();
  await page.locator(".contents summary").click();
  await page.getByRole("navigation", { name: "Contents" }).getByRole("link").nth(5).click();
  const heading = page.locator("#sweep h2");
  await expect(here).toHaveText(/^6 of 15: .* Contents$/);
  await expect(here).toContainText((await heading.textContent())!.replace("#", ""));
  await expect(here).toBeInViewport();
  const { y, height } = (await here.boundingBox())!;
  expect(y).toBeCloseTo(0, 0);
  expect((await heading.boundingBox())!.y, "the heading is not covered").toBeGreaterThanOrEqual(y + height);
  await here.click();
  await expect(page.locator("#contents-heading")).toBeInViewport();
  await expect(here).toBeHidden();
});

test.describe("without scripts", () => {
  test.use({ javaScriptEnabled: false });

  test("text, listings, figures and the table are all there", async ({ page }) => {
    await page.goto("/");
    await expect(page.locator("main section h2")).toHaveCount(15);
    await expect(page.locator("figure.listing pre .line").first()).toBeVisible();
    await expect(page.locator("svg.figure")).toHaveCount(9);
    await expect(page.locator("#cost table").first()).toBeVisible();
  });
});

test("the library's pairs are those of brute force", async ({ page }) => {
  await page.goto("/");
  await page.locator("library-trial").scrollIntoViewIfNeeded();
  await page.getByRole("button", { name: "Find pairs" }).click();
  await expect(page.locator(".trial-result")).toContainText("the same pairs");
  await page.getByLabel("Random boxes in 3D").fill("15");
  await page.getByRole("button", { name: "Find pairs" }).click();
  await expect(page.locator(".trial-result")).toContainText("among 1,000,000 boxes");
});

test("the complexity table shows every measured variant and what it claims", async ({ page }) => {
  await page.goto("/");
  const { variants } = JSON.parse(readFileSync(new URL("../../docs/complexity.json", import.meta.url), "utf8"));
  await expect(page.locator("#cost tbody tr")).toHaveCount(variants.length);
  await expect(page.locator("#cost tbody tr:visible"), "the others are folded away").toHaveCount(6);
  await page.locator("#cost .more summary").click();
  for (const { method, sort, best, worst, space, rows: measured } of variants) {
    const row = page.locator("#cost tbody tr").filter({ has: page.locator("th").filter({ hasText: new RegExp(`^\\s*${method}${sort ?? ""}\\s*$`, "i") }) });
    await expect(row).toHaveCount(1);
    await expect(row.locator("td").nth(0)).toContainText(best);
    await expect(row.locator("td").nth(2)).toContainText(worst);
    await expect(row.locator("td").nth(3)).toHaveText(space);
    const ofBest = measured.find((found: { case: string }) => found.case === "best");
    await expect(row.locator("td").nth(0)).toContainText(ofBest.slope.toFixed(2));
  }
});
