// The scene of falling balls in the playground: discs and spheres, searched by any of the algorithms.
import { expect, type Locator, type Page, test } from "@playwright/test";
import { frames, settled } from "./support/frames.ts";
import { complaints } from "./support/pages.ts";

const SCENE = "/playground.html?scene=falling+balls";

async function open(page: Page, query: string): Promise<{ root: Locator; step(count: number): Promise<void>; world(): Promise<{ boxes: number[][]; pairs: number }> }> {
  await page.goto(SCENE + query);
  const root = page.locator("box-playground");
  await expect(root).toHaveAttribute("data-step", /^\d+$/);
  return {
    root,
    step: async (count) => {
      for (let done = 0; done < count; done++) {
        const before = Number(await root.getAttribute("data-step"));
        await root.getByRole("button", { name: "Step", exact: true }).click();
        await expect(root).toHaveAttribute("data-step", String(before + 1));
      }
    },
    world: async () => {
      await root.getByLabel("As", { exact: true }).selectOption("json");
      await root.getByRole("button", { name: "Copy", exact: true }).click();
      await expect(root.locator("[data-part=exported]")).toHaveText(`Step ${await root.getAttribute("data-step")} copied.`);
      return JSON.parse(await page.evaluate(() => navigator.clipboard.readText()));
    },
  };
}

test.use({ contextOptions: { reducedMotion: "reduce" }, permissions: ["clipboard-read", "clipboard-write"] });

for (const dimensions of [2, 3]) {
  test(`${dimensions}D: four algorithms search the boxes of the balls, step by step, and find what brute force finds`, async ({ page }) => {
    const heard = complaints(page);
    const { root, step, world } = await open(page, `&dimensions=${dimensions}&boxes=100&spread=4&algorithm=global+pairwise&2=sorted+pairwise&3=swap-driven+sweep&4=find+pairs`);
    const seen = new Set<string>();
    for (let at = 0; at < 4; at++) {
      const { boxes, pairs } = await world();
      seen.add(JSON.stringify(boxes));
      expect(boxes).toHaveLength(100);
      const overlap = (a: number[], b: number[]): boolean => Array.from({ length: dimensions }, (_, axis) => a[axis]! <= b[axis + dimensions]! && b[axis]! <= a[axis + dimensions]!).every(Boolean);
      expect(pairs).toBe(boxes.reduce((sum, a, i) => sum + boxes.slice(i + 1).filter((b) => overlap(a, b)).length, 0));
      // They are balls: as wide as high.
      for (const box of boxes) expect(box[dimensions]! - box[0]!).toBeCloseTo(box[dimensions + 1]! - box[1]!, 4);
      await expect(root.locator("[data-part=verdict]")).toContainText(`All 4 found the same ${pairs} pairs`);
      await step(5);
    }
    expect(seen.size, "they move").toBe(4);
    await expect(root.locator("[data-part=alarm]")).toBeEmpty();
    await expect(root.locator("[data-lane='1'] [data-counter=tests] dd")).toHaveText("4,950");
    expect(heard).toEqual([]);
  });
}

test("the same seed gives the same balls, another seed others, and an address leads back to its step", async ({ page }) => {
  const { root, step, world } = await open(page, "&boxes=50");
  const beginning = JSON.stringify((await world()).boxes);
  await step(6);
  const first = JSON.stringify((await world()).boxes);
  expect(first).not.toBe(beginning);
  await root.getByRole("button", { name: "Reset" }).click();
  await expect(root).toHaveAttribute("data-step", "0");
  await step(6);
  expect(JSON.stringify((await world()).boxes)).toBe(first);
  const again = await open(page, "&boxes=50&step=6");
  expect(JSON.stringify((await again.world()).boxes)).toBe(first);
  const other = await open(page, "&boxes=50&seed=2&step=6");
  expect(JSON.stringify((await other.world()).boxes)).not.toBe(first);
});

test("balls have the color of the height at which they started, also where an address leads to a later step", async ({ page }) => {
  const picture = page.getByRole("img", { name: "Discs falling into a box" });
  const { step } = await open(page, "&boxes=30");
  await step(20);
  const stepped = await picture.screenshot();
  await open(page, "&boxes=30&step=20");
  await expect.poll(async () => stepped.equals(await picture.screenshot())).toBe(true);
});

test("the motion of the balls is loaded for their scene alone, and three.js for spheres, which keys turn; another scene shows boxes again", async ({ page }) => {
  const scripts: string[] = [];
  page.on("response", (response) => void scripts.push(response.url()));
  await page.goto("/playground.html");
  await expect(page.locator("box-playground")).toHaveAttribute("data-step", /^\d+$/);
  expect(scripts.filter((url) => url.includes("/simulation"))).toEqual([]);
  const { root } = await open(page, "&boxes=20");
  await expect(root.getByRole("img", { name: "Discs falling into a box" })).toBeVisible();
  expect(scripts.filter((url) => url.includes("sphere-view"))).toEqual([]);
  await root.getByLabel("Dimensions").selectOption("3");
  const picture = root.getByRole("application", { name: /^Spheres falling/ });
  await expect(picture).toBeVisible();
  await expect.poll(() => scripts.filter((url) => url.includes("sphere-view")).length).toBeGreaterThan(0);
  const before = await picture.screenshot();
  await picture.focus();
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowRight");
  await expect.poll(async () => before.equals(await picture.screenshot())).toBe(false);
  await root.getByLabel("Scene").selectOption("uniform");
  await expect(picture).toBeHidden();
  await expect(root.locator("[data-part=surface]")).toBeVisible();
  await expect(root.getByLabel("Motion")).toBeEnabled();
});

test("balls fall more slowly on the Moon; lines are drawn for the pairs of discs; what brute force would test is said", async ({ page }) => {
  const heights = async (query: string): Promise<number[]> => {
    const { world } = await open(page, `&boxes=50&step=30${query}`);
    return (await world()).boxes.map(([, bottom]) => bottom!);
  };
  const [earth, moon] = [await heights(""), await heights("&motion=on+the+Moon")];
  expect(Math.max(...moon.map((bottom, ball) => earth[ball]! - bottom)), "no ball is higher on Earth").toBeLessThan(0);

  const { root, step } = await open(page, "&boxes=200&step=60");
  await expect(root.locator("[data-part=about]")).toContainText("Brute force would test 19,900 pairs in each step.");
  await step(1);
  await expect(root.locator("[data-part=moment]")).toHaveText(/^Step 61, moved in \d+\.\d ms$/);
  const picture = root.getByRole("img", { name: "Discs falling into a box" });
  const without = await picture.screenshot();
  await root.getByLabel("Pair lines").check();
  await expect.poll(async () => without.equals(await picture.screenshot())).toBe(false);
  await root.getByLabel("Pair lines").uncheck();
  await expect.poll(async () => without.equals(await picture.screenshot())).toBe(true);
  await expect(root.getByRole("button", { name: "Show all" })).toBeHidden();
  await root.getByLabel("Dimensions").selectOption("3");
  await expect(root.getByLabel("Pair lines")).toBeHidden();
  await root.getByLabel("Scene").selectOption("uniform");
  await expect(root.getByRole("button", { name: "Show all" })).toBeVisible();
  await expect(root.getByLabel("Motion")).toHaveValue("drift");
});

test("the picture has as many pixels as it is wide, also when the window changes", async ({ page }) => {
  const { root } = await open(page, "&boxes=20");
  const canvas = root.locator("[data-part=orbit] canvas");
  const shares = (): Promise<number> => canvas.evaluate((canvas: HTMLCanvasElement) => canvas.width / canvas.clientWidth / devicePixelRatio);
  await expect.poll(shares).toBeCloseTo(1, 2);
  await page.setViewportSize({ width: 500, height: 800 });
  await expect.poll(shares).toBeCloseTo(1, 2);
});

test("boxes of the balls that a hand changes are the visitor's own, and no longer fall", async ({ page }) => {
  const { root, step } = await open(page, "&boxes=20");
  await root.getByRole("button", { name: "Add a box" }).click();
  await expect(root.locator("[data-part=surface]")).toBeVisible();
  await expect(root.getByLabel("Scene")).toHaveValue("");
  await step(1);
  await expect(root.getByRole("status").filter({ hasText: "21 boxes of your own" })).toBeVisible();
});

test("says so where there is no WebGL, and still counts", async ({ page }) => {
  await page.addInitScript(() => {
    const original = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (this: HTMLCanvasElement, kind: string, ...rest: unknown[]) {
      return kind.startsWith("webgl") ? null : (original as (...all: unknown[]) => unknown).call(this, kind, ...rest);
    } as typeof original;
  });
  const { root, step } = await open(page, "&dimensions=3&boxes=200");
  await expect(root.locator("[data-part=message]")).toContainText("no picture: drawing the spheres needs WebGL");
  await step(2);
  await expect(root.locator("[data-part=message]")).toContainText("no picture");
  await expect(root.locator("[data-counter=pairs] dd").first()).not.toHaveText("–");
});

test("the tools say what they do among falling balls: to draw makes their boxes the visitor's own, and a file takes their place", async ({ page }) => {
  await page.goto(`${SCENE}&dimensions=2&boxes=50`);
  const root = page.locator("box-playground");
  await expect(root).toHaveAttribute("data-step", /^\d+$/);
  const tools = root.getByRole("group", { name: "Change the boxes" });
  const says = tools.getByText("make their boxes yours: they no longer fall");
  await expect(says).toBeVisible();
  await expect(tools.getByText("Drag a box to move it")).toBeHidden();
  await tools.getByRole("button", { name: "Draw" }).click();
  await expect(root.getByLabel("Scene")).toHaveValue("");
  await expect(says).toBeHidden();
  // A box is drawn among those of the balls.
  const surface = root.locator("[data-part=surface]");
  await expect(surface).toBeVisible();
  await surface.scrollIntoViewIfNeeded();
  const { x, y, width, height } = (await surface.boundingBox())!;
  await page.mouse.move(x + 0.4 * width, y + 0.2 * height);
  await page.mouse.down();
  await page.mouse.move(x + 0.6 * width, y + 0.3 * height, { steps: 3 });
  await page.mouse.up();
  await expect(tools).toContainText("Box 50:");
  await root.getByLabel("Scene").selectOption("falling balls");
  await expect(says).toBeVisible();
  await root.getByRole("img", { name: "Discs falling into a box" }).evaluate((picture) => {
    const dataTransfer = new DataTransfer();
    dataTransfer.items.add(new File(["0,0,2,2\n1,1,3,3\n"], "boxes.csv", { type: "text/csv" }));
    picture.dispatchEvent(new DragEvent("drop", { dataTransfer, bubbles: true, cancelable: true }));
  });
  await expect(tools).toContainText("2 boxes imported.");
});

test("old addresses of falling balls lead to the same scene", async ({ page }) => {
  for (const [old, expected] of [
    ["/falling.html#spheres", ["falling balls", "3", "find pairs", "1", "10,000"]],
    ["/falling.html?discs.bodies=50&discs.algorithm=endpoint+sweep&discs.seed=4#discs", ["falling balls", "2", "endpoint sweep", "4", "50"]],
  ] as const) {
    await page.goto("about:blank");
    await page.goto(old);
    const root = page.locator("box-playground");
    await expect(root).toHaveAttribute("data-step", /^\d+$/);
    const shown = ["Scene", "Dimensions", "Algorithm", "Seed"].map((label) => root.getByLabel(label, { exact: true }).inputValue());
    expect([...(await Promise.all(shown)), await root.locator("[data-part=boxes-value]").textContent()]).toEqual(expected);
  }
});

test.describe("in the article", () => {
  test.use({ contextOptions: { reducedMotion: "no-preference" } });

  test("discs fall, another algorithm races, the address keeps what was chosen, and nothing is edited there", async ({ page }) => {
    const heard = complaints(page);
    await page.goto("/#falling");
    const root = page.locator("#d20 box-playground");
    await root.scrollIntoViewIfNeeded();
    await expect.poll(async () => Number(await root.getAttribute("data-step"))).toBeGreaterThan(5);
    await expect(root.getByRole("img", { name: "Discs falling into a box" })).toBeVisible();
    expect(new URL(page.url()).search).toBe("");
    await expect(root.getByRole("button", { name: "Draw", exact: true })).toBeHidden();
    await root.getByRole("button", { name: "Add an algorithm" }).click();
    await expect(root.locator(".lane")).toHaveCount(2);
    await root.locator("[data-lane='2']").getByLabel("Algorithm", { exact: true }).selectOption("global pairwise");
    await expect(root.locator("[data-lane='2'] [data-counter=tests] dd")).toHaveText("124,750");
    await expect(root.locator("[data-part=verdict]")).toContainText("All 2 found the same");
    expect(Object.fromEntries(new URL(page.url()).searchParams)).toMatchObject({ "2": "global pairwise" });
    await page.reload();
    await root.scrollIntoViewIfNeeded();
    await expect(root.locator(".lane")).toHaveCount(2);
    // It sleeps while it cannot be seen.
    await page.locator("h1").scrollIntoViewIfNeeded();
    const before = await settled(page, async () => Number(await root.getAttribute("data-step")), "it sleeps");
    await frames(page, 60);
    expect(Number(await root.getAttribute("data-step"))).toBe(before);
    expect(heard).toEqual([]);
  });
});
