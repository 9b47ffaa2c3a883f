// The first picture of the article: the library finds the pairs of moving boxes, and the numbers are right.
import { expect, type Locator, type Page, test } from "@playwright/test";
import { complaints } from "./support/pages.ts";

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
  await hero.getByRole("link", { name: "10,000 spheres in 3D" }).click();
  await expect(page.locator("falling-balls#spheres [data-counter=brute-force] dd")).toHaveText("49,995,000");
});
