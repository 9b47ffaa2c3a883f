// The first picture of the article: the library finds the pairs of moving boxes, and the numbers are right.
import { expect, type Locator, type Page, test } from "@playwright/test";
import { frames } from "./support/frames.ts";
import { complaints } from "./support/pages.ts";
import { RETRIED } from "./support/retried.ts";

interface Hero {
  hero: Locator;
  tests(): Promise<number>;
  rows(): Promise<number[]>;
}

async function open(page: Page): Promise<Hero> {
  await page.goto("/");
  const hero = page.locator("hero-boxes");
  await expect(hero).toHaveAttribute("data-ready", "");
  return {
    hero,
    tests: async () => Number(await hero.getAttribute("data-tests")),
    rows: () => hero.evaluate((element) => [...(element as HTMLElement & { rows: Float64Array }).rows]),
  };
}

/** How many pairs overlap, and how many do so on x: what a sweep along x tests. */
function count(rows: number[]): { pairs: number; onX: number } {
  let [pairs, onX] = [0, 0];
  const boxes = Array.from({ length: rows.length / 4 }, (_, box) => rows.slice(4 * box, 4 * box + 4) as [number, number, number, number]);
  for (const [at, [left, top, right, bottom]] of boxes.entries()) {
    for (const [otherLeft, otherTop, otherRight, otherBottom] of boxes.slice(at + 1)) {
      if (left > otherRight || otherLeft > right) continue;
      onX++;
      pairs += Number(top <= otherBottom && otherTop <= bottom);
    }
  }
  return { pairs, onX };
}

test("sections out of sight are laid out when the first picture works, and at once where the address leads into them", async ({ page }) => {
  let answer = (): void => undefined;
  const held = new Promise<void>((resolve) => (answer = resolve));
  await page.route("**/algorithms-*.wasm", async (route) => {
    await held;
    await route.continue();
  });
  const isLaidOut = (): Promise<boolean> => page.locator("#cost > p").first().evaluate((text) => text.checkVisibility());
  await page.goto("/#cost", { waitUntil: "domcontentloaded" });
  expect(await isLaidOut()).toBe(true);
  await expect(page.locator("#cost h2")).toBeInViewport();
  await page.goto("about:blank");
  await page.goto("/", { waitUntil: "domcontentloaded" });
  expect(await isLaidOut()).toBe(false);
  await expect(page.locator("#naive h2")).toBeVisible();
  answer();
  await expect(page.locator("hero-boxes")).toHaveAttribute("data-ready", "");
  await expect.poll(isLaidOut).toBe(true);
});

test("400 boxes move; every pair is 79,800 tests, the sweep as many as overlap on x, and both find the same pairs", async ({ page }) => {
  const heard = complaints(page);
  const { hero, tests, rows } = await open(page);
  const before = await rows();
  expect(before).toHaveLength(4 * 400);
  await expect.poll(rows).not.toEqual(before);
  await hero.getByRole("button", { name: "Pause" }).click();
  const { pairs, onX } = count(await rows());
  expect(pairs).toBeGreaterThan(40);
  expect(await tests()).toBe(onX);
  await expect(hero.locator("[data-part=count]")).toHaveText(onX.toLocaleString("en"));
  await hero.getByRole("radio", { name: "Every pair" }).check();
  expect(await tests()).toBe(79_800);
  await expect(hero.locator("[data-part=count]")).toHaveText("79,800");
  await expect(hero.locator("[data-part=at-line]")).toContainText(/399|0/);
  await expect(hero.locator("[data-part=pairs]")).toHaveText(String(pairs));
  await hero.getByLabel("Boxes", { exact: true }).press("ArrowLeft");
  expect(await tests()).toBe((200 * 199) / 2);
  expect(heard).toEqual([]);
});

test("the line and the boxes can be dragged, by pointer and by keys", async ({ page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  const { hero, rows } = await open(page);
  await expect(hero.getByRole("button", { name: "Play" }), "with reduced motion it begins still").toBeVisible();
  const picture = (await hero.locator("canvas").boundingBox())!;
  const scale = picture.height / 100;
  const before = await rows();
  const line = hero.getByLabel("Sweep line", { exact: true });

  // A box far from the line, and from the other boxes at its middle.
  const at = Array.from({ length: 400 }, (_, box) => box).find((box) => before[4 * box]! * scale > 0.5 * picture.width && before[4 * box + 2]! - before[4 * box]! > 4)!;
  const [left = 0, top = 0, right = 0, bottom = 0] = before.slice(4 * at, 4 * at + 4);
  await page.mouse.move(picture.x + ((left + right) / 2) * scale, picture.y + ((top + bottom) / 2) * scale);
  await page.mouse.down();
  await page.mouse.move(picture.x + 0.4 * picture.width, picture.y + 0.5 * picture.height, { steps: 5 });
  await page.mouse.up();
  const after = await rows();
  const moved = Array.from({ length: 400 }, (_, box) => box).filter((box) => before[4 * box] !== after[4 * box]);
  expect(moved).toHaveLength(1);
  const [box = 0] = moved;
  expect(((after[4 * box]! + after[4 * box + 2]!) / 2) * scale).toBeCloseTo(0.4 * picture.width, -1);

  const place = Number(await line.inputValue());
  await page.mouse.move(picture.x + (place / 1000) * picture.width, picture.y + 3);
  await page.mouse.down();
  await page.mouse.move(picture.x + 0.75 * picture.width, picture.y + 3, { steps: 5 });
  await page.mouse.up();
  await expect(line).toHaveValue("750");
  await line.press("ArrowRight");
  await expect(line).toHaveValue("751");
  await expect(line).toHaveAttribute("aria-valuetext", /touching \d+ of 400 boxes/);
  expect(await rows(), "the line moves no box").toEqual(after);

  await hero.getByRole("button", { name: "New world" }).click();
  expect(await rows()).not.toEqual(after);
});

test("10,000 boxes: 49,995,000 tests against thousands; one click leads to 10,000 spheres", async ({ page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  const { hero, tests } = await open(page);
  await hero.getByLabel("Boxes", { exact: true }).press("End");
  const ofSweep = await tests();
  expect(ofSweep).toBeLessThan(1_000_000);
  await hero.getByRole("radio", { name: "Every pair" }).check();
  expect(await tests()).toBe(49_995_000);
  await expect(hero.locator("[data-part=ms]")).toHaveText(/^about [\d,]+ ms a frame here, so the picture stands still$/);
  await hero.getByRole("link", { name: "10,000 spheres in 3D" }).click();
  await expect(page.locator("box-playground [data-part=boxes-value]")).toHaveText("10,000");
  await expect(page.getByRole("application", { name: /^Spheres falling/ })).toBeVisible();
});

test("every pair of 10,000 boxes never runs: what is shown are the sweep's pairs, and the picture stands still until there are fewer", async ({ page }) => {
  // Counted work, not time: how many tests a frame makes.
  await page.goto("/");
  const hero = page.locator("hero-boxes");
  await expect(hero).toHaveAttribute("data-ready", "");
  const slider = hero.getByLabel("Boxes", { exact: true });
  const rows = (): Promise<string> => hero.evaluate((element) => String((element as HTMLElement & { rows: Float64Array }).rows));
  for (const [presses, runs] of [[0, true], [2, true], [3, false]] as const) {
    await slider.fill("3");
    for (let press = 0; press < presses; press++) await slider.press("ArrowRight");
    await hero.getByRole("radio", { name: "Every pair" }).check();
    const before = await rows();
    if (runs) await expect.poll(rows).not.toBe(before);
    else {
      await frames(page, 10);
      expect(await rows()).toBe(before);
      await expect(hero.locator("[data-part=ms]")).toContainText("stands still");
    }
    await hero.getByRole("radio", { name: "Sweep" }).check();
    await expect.poll(rows).not.toBe(before);
  }
});

test("on a phone the article begins within 1,700 pixels, the pages take one row, and the count and the choice lie on the picture", async ({ page }) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await page.goto("/");
  const hero = page.locator("hero-boxes");
  await expect(hero).toHaveAttribute("data-ready", "");
  const top = (selector: string): Promise<number> => page.locator(selector).first().evaluate((element) => element.getBoundingClientRect().top + scrollY);
  expect(await top(".sections h2")).toBeLessThan(1_700);
  const links = await page.getByRole("navigation", { name: "Site" }).getByRole("link").evaluateAll((all) => all.map((link) => link.getBoundingClientRect()).map(({ top, right }) => [top, right]));
  expect(new Set(links.map(([top]) => top)).size).toBe(1);
  expect(Math.max(...links.map(([, right]) => right!))).toBeLessThanOrEqual(390);
  const picture = (await hero.locator("canvas").boundingBox())!;
  for (const part of [".hero-count", ".hero-switch span >> nth=0"]) {
    const { x, y, width, height } = (await hero.locator(part).boundingBox())!;
    expect(x >= picture.x && y >= picture.y && x + width <= picture.x + picture.width && y + height <= picture.y + picture.height, part).toBe(true);
  }
});

test("the tests of the box that the line has entered are drawn over the line", async ({ page }) => {
  await page.emulateMedia({ colorScheme: "light", reducedMotion: "reduce" });
  await page.goto("/");
  const hero = page.locator("hero-boxes");
  await expect(hero).toHaveAttribute("data-ready", "");
  /** Pixels of the color of a test, #0b7a4b. */
  const painted = await hero.locator("canvas").evaluate((canvas: HTMLCanvasElement) => {
    const { data } = canvas.getContext("2d")!.getImageData(0, 0, canvas.width, canvas.height);
    let count = 0;
    for (let at = 0; at < data.length; at += 4) count += Number(data[at] === 0x0b && data[at + 1] === 0x7a && data[at + 2] === 0x4b);
    return count;
  });
  expect(painted).toBeGreaterThan(400);
});

test.describe("without scripts", () => {
  test.use({ javaScriptEnabled: false });

  test("the picture is whole, and the numbers in the text are its own", async ({ page, request }) => {
    await page.goto("/");
    const image = page.locator(".hero-stage img");
    await expect.poll(() => image.evaluate((element: HTMLImageElement) => element.naturalWidth)).toBeGreaterThan(100);
    const svg = await (await request.get("/still/hero.svg", RETRIED)).text();
    const boxesOf = (kind: string): number[][] =>
      [...(new RegExp(`class="${kind}" d="([^"]*)"`).exec(svg)?.[1] ?? "").matchAll(/M([\d.]+) ([\d.]+)H([\d.]+)V([\d.]+)/g)].map((match) => match.slice(1).map(Number));
    const overlapping = boxesOf("overlap");
    const all = [...boxesOf("box"), ...overlapping];
    expect(all).toHaveLength(400);
    const { pairs, onX } = count(all.flat());
    const shown = async (part: string): Promise<number> => Number((await page.locator(`hero-boxes [data-part=${part}]`).textContent())!.replace(/\D/g, ""));
    // Drawn to a hundredth of a unit: boxes that nearly touch may differ.
    expect(Math.abs((await shown("pairs")) - pairs)).toBeLessThanOrEqual(1);
    expect(Math.abs((await shown("count")) - onX)).toBeLessThanOrEqual(5);
  });
});
