// Balls that are dragged and thrown while the world moves, other worlds, and only those controls and counters that
// apply.
import { expect, test } from "@playwright/test";
import type { SapDemo } from "sweep-and-prune-classroom/demo";
import { complainOfNothing, open, pairwise, stateOf } from "./support/embedded.ts";

complainOfNothing();

test("in a world that moves a ball follows the hand, also while pairs are highlighted, and flies on when let go", async ({ page }) => {
  const demo = await open(page, { strategy: "pairwise", decorations: "checks:60000", balls: "[[100,100,30,0,0],[400,330,40,0,0],[500,330,40,0,0]]" });
  await demo.evaluate((element: SapDemo) => element.play());
  const picture = (await demo.locator(".picture").boundingBox())!;
  const scale = picture.width / 600;
  const [x = 0, y = 0] = (await demo.evaluate((element: SapDemo) => element.balls[0]!)).map(Number);
  await page.mouse.move(picture.x + x * scale, picture.y + y * scale);
  await page.mouse.down();
  await page.mouse.move(picture.x + 200 * scale, picture.y + 120 * scale, { steps: 4 });
  const place = (): Promise<number> => demo.evaluate((element: SapDemo) => Number(element.balls[0]![0]));
  await expect.poll(place, { message: "though a test would be highlighted for a minute" }).toBeCloseTo(200, -1);
  const { tick } = await stateOf(demo);
  await expect.poll(async () => (await stateOf(demo)).tick, { message: "the world goes on" }).toBeGreaterThan(tick + 3);
  // A throw, however slow this machine is: two movements and the release at the same moment.
  const velocity = await demo.evaluate((element: SapDemo, { x, y, scale }) => {
    const picture = element.shadowRoot!.querySelector(".picture")!;
    const point = (type: string, atX: number): boolean =>
      picture.dispatchEvent(new PointerEvent(type, { pointerId: 1, clientX: x + atX * scale, clientY: y + 120 * scale, button: 0, bubbles: true }));
    point("pointermove", 250);
    point("pointermove", 300);
    point("pointerup", 300);
    const balls = JSON.parse(new URLSearchParams(new URL(element.share()).hash.slice(1)).get("balls")!) as number[][];
    return balls[0]!.slice(3);
  }, { x: picture.x, y: picture.y, scale });
  expect(velocity[0], "thrown to the right").toBeGreaterThan(100);
  expect(Math.abs(velocity[1]!)).toBeLessThan(20);
  await page.mouse.up();
});

test("a ball that must not move does not", async ({ page }) => {
  const demo = await open(page, { balls: "[[100,100,30]]", static: "", draggable: "false" });
  const picture = (await demo.locator(".picture").boundingBox())!;
  const scale = picture.width / 600;
  await page.mouse.move(picture.x + 100 * scale, picture.y + 100 * scale);
  await page.mouse.down();
  await page.mouse.move(picture.x + 300 * scale, picture.y + 200 * scale, { steps: 4 });
  await page.mouse.up();
  expect((await demo.evaluate((element: SapDemo) => element.balls[0]!))[0]).toBe(100);
});

test("a new world has another seed, which the link contains; a demo that was paused stays paused", async ({ page }) => {
  const demo = await open(page, pairwise);
  expect(await demo.evaluate((element: SapDemo) => element.share())).toContain("seed=1");
  const { hash } = await stateOf(demo);
  await demo.getByRole("button", { name: "New world" }).click();
  await expect.poll(async () => (await stateOf(demo)).hash).not.toBe(hash);
  const [seed, link, plays] = await demo.evaluate((element: SapDemo) => [element.getAttribute("seed"), element.share(), element.isPlaying] as const);
  expect(link).toContain(`seed=${seed}`);
  expect(plays).toBe(false);
  const { hash: another } = await stateOf(demo);
  await page.goto("about:blank");
  await page.goto(link);
  const shared = page.locator("sap-demo");
  await page.evaluate(() => customElements.whenDefined("sap-demo"));
  await shared.evaluate((element: SapDemo) => element.ready);
  await shared.evaluate((element: SapDemo) => (element.pause(), element.seek(0)));
  expect((await stateOf(shared)).hash).toBe(another);
  const given = await open(page, { balls: "[[100,100,30,10,0],[300,200,30,0,0]]", paused: "" });
  await expect(given.getByRole("button", { name: "New world" }), "there is only one").toHaveCount(0);
});

test("where nothing plays there is nothing to play with, and a link carries no velocities", async ({ page }) => {
  const demo = await open(page, { balls: "[[150,250,50],[300,150,55]]", static: "", decorations: "edges" });
  expect(await demo.getByRole("button").evaluateAll((all) => all.map((button) => button.getAttribute("aria-label")))).toEqual(["Reset", "Share or embed"]);
  await expect(demo.getByRole("slider")).toHaveCount(0);
  await demo.locator(".picture").focus();
  for (const key of ["b", "ArrowRight"]) await page.keyboard.press(key);
  const link = await demo.evaluate((element: SapDemo) => element.share());
  expect(new URLSearchParams(new URL(link).hash.slice(1)).get("balls")).toBe("[[155,250,50],[300,150,55]]");
});

for (const [attributes, labels] of [
  [{ strategy: "pairwise" }, ["tests", "pairs"]],
  [{ strategy: "sorted-pairwise" }, ["tests", "pairs", "comparisons"]],
  [{ strategy: "sweep", sort: "quicksort" }, ["tests", "axis overlaps", "pairs", "comparisons", "swaps"]],
  [{ strategy: "swap" }, ["tests", "axis overlaps", "pairs", "comparisons", "swaps"]],
  [{ strategy: "sweep-all-axes" }, ["flag checks", "axis overlaps", "pairs", "comparisons"]],
] as const) {
  test(`${Object.values(attributes).join(", ")}: only the counters that apply`, async ({ page }) => {
    const demo = await open(page, { ...attributes, paused: "" });
    expect(await demo.locator(".counters dt").allTextContents()).toEqual(labels);
  });
}
