// What `<sap-demo>` shows of an algorithm: the events, their number, the pairs, forward and back.
import { expect, test } from "@playwright/test";
import type { DemoState, SapDemo } from "sweep-and-prune-classroom/demo";
import { type Attributes, complainOfNothing, open, pairwise, stateOf, step, walk } from "./support/embedded.ts";

complainOfNothing();

for (const [balls, tests] of [["5", 10], ["20", 190], ["10", 45], ["0", 0], ["1", 0], ["2", 1]] as const) {
  test(`pairwise: ${balls} balls are ${tests} tests, each highlighted once`, async ({ page }) => {
    const demo = await open(page, { ...pairwise, balls });
    expect((await stateOf(demo)).tests).toBe(0);
    const highlighted = (await walk(demo)).filter(({ kind }) => kind === "test");
    const first = highlighted.slice(0, tests);
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
  { variant: "strict-ties" },
  { variant: "teleport" },
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

test("a detection that runs again from an earlier tick gives the same bits", async ({ page }) => {
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
    const reported: { kind: string; i: number; j: number }[] = [];
    element.addEventListener("sap-sort", ({ detail }) => reported.push(detail));
    const sorts: { swaps: number; reported: number; comparisons: number; compared: number }[] = [];
    let tick = element.state.tick;
    for (let count = 0; count < 300; count++) {
      const before = element.state;
      element.step();
      if (element.state.tick === tick) continue;
      sorts.push({
        swaps: before.swaps,
        reported: reported.filter(({ kind }) => kind === "swap").length,
        comparisons: before.comparisons,
        compared: reported.filter(({ kind }) => kind === "compare").length,
      });
      reported.length = 0;
      tick = element.state.tick;
    }
    return sorts;
  });
  expect(arrays.length).toBeGreaterThan(2);
  // The first event of the next detection may have been reported with it.
  for (const { swaps, reported, comparisons, compared } of arrays) {
    expect(Math.abs(reported - swaps)).toBeLessThanOrEqual(1);
    expect(Math.abs(compared - comparisons)).toBeLessThanOrEqual(1);
  }
});

test("a broken variant that starts later finds what it finds when it is stepped there", async ({ page }) => {
  const pairsAt = async (attributes: Attributes, start: number, steps: number): Promise<string> => {
    const demo = await open(page, { ...attributes, decorations: "", "skip-interval": "0", start: String(start), paused: "" });
    return demo.evaluate((element: SapDemo, steps) => {
      // The first step shows what was detected at the start.
      for (let made = 0; made <= steps; made++) element.step();
      return `${element.state.tick}: ${JSON.stringify(element.pairs)}`;
    }, steps);
  };
  for (const [variant, tick] of [["strict-ties", 4], ["strict-ties", 5], ["wrong-start", 20]] as const) {
    expect(await pairsAt({ variant }, tick, 0), `${variant} at ${tick}`).toBe(await pairsAt({ variant }, 0, tick));
  }
});

test("the broken variants miss pairs as they should, and say so", async ({ page }) => {
  const ties = await open(page, { variant: "strict-ties", decorations: "", "skip-interval": "0", paused: "" });
  const counts = await ties.evaluate((element: SapDemo) => Array.from({ length: 6 }, () => (element.step(), element.pairs.length)));
  expect(new Set(counts.filter((_, index) => index % 2 === 0)).size).toBe(1);
  expect(counts[0]).not.toBe(counts[1]);
  const hashes = await ties.evaluate((element: SapDemo) => new Set([element.state.hash, (element.step(), element.state.hash)]).size);
  expect(hashes, "nothing moves").toBe(1);

  const center = await open(page, { variant: "center-sort" });
  expect(await center.evaluate((element: SapDemo) => element.pairs)).toEqual([[1, 2]]);
  await expect(center.locator('[part="said"]')).toContainText("Missed: A and C");

  const one = await open(page, { variant: "one-to-n" });
  await expect(one.locator('[part="said"]')).toContainText("Missed: A and B");

  const start = await open(page, { variant: "wrong-start", paused: "" });
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

  const thrown = await open(page, { variant: "teleport", decorations: "", "skip-interval": "0", paused: "" });
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
