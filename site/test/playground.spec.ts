import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { expect, type Locator, type Page, test } from "@playwright/test";
import { complaints, requestsElsewhere, violations } from "./support/pages.ts";

/** Within the repository, where Node finds the package by its name. */
const written = fileURLToPath(new URL("../test-results/snippets/", import.meta.url));
const snippets = new URL("./snippets/", import.meta.url);

class Playground {
  readonly root: Locator;

  constructor(readonly page: Page) {
    this.root = page.locator("box-playground");
  }

  async open(query = ""): Promise<this> {
    await this.page.goto(`/playground.html${query}`);
    await expect(this.root).toHaveAttribute("data-step", /./);
    return this;
  }

  part(name: string): Locator {
    return this.root.locator(`[data-part="${name}"]`);
  }

  async value(key: string): Promise<number> {
    const text = await this.root.locator(`[data-counter="${key}"] dd`).textContent();
    return Number.parseFloat((text ?? "").replaceAll(",", ""));
  }

  async step(): Promise<void> {
    const before = Number(await this.root.getAttribute("data-step"));
    await this.root.getByRole("button", { name: "Step" }).click();
    await expect(this.root).toHaveAttribute("data-step", String(before + 1));
  }

  /** The file that is downloaded in a format. */
  async download(format: string): Promise<string> {
    await this.root.getByLabel("As", { exact: true }).selectOption(format);
    const [download] = await Promise.all([
      this.page.waitForEvent("download"),
      this.root.getByRole("button", { name: "Download" }).click(),
    ]);
    return readFileSync(await download.path(), "utf8");
  }
}

test("runs, and complains of nothing", async ({ page, baseURL }) => {
  const heard = complaints(page);
  const elsewhere = requestsElsewhere(page, baseURL ?? "");
  const playground = await new Playground(page).open();
  await expect.poll(async () => Number(await playground.root.getAttribute("data-step"))).toBeGreaterThan(10);
  for (const key of ["ms", "pairs", "tests", "axisOverlaps", "comparisons", "swaps"]) {
    await expect.poll(() => playground.value(key), { message: key }).toBeGreaterThan(0);
  }
  expect(heard).toEqual([]);
  expect(elsewhere).toEqual([]);
});

test.describe("paused", () => {
  test.use({ contextOptions: { reducedMotion: "reduce" } });

  for (const [dimensions, query] of [[2, "?boxes=1000&scene=clustered"], [3, "?dimensions=3&boxes=500&scene=mixed&size=2&spread=8"]] as const) {
    test(`JavaScript of a ${dimensions}D world, run in Node, finds the pairs that the page shows`, async ({ page }) => {
      const playground = await new Playground(page).open(query);
      for (let step = 0; step < 5; step++) await playground.step();
      const pairs = await playground.value("pairs");
      expect(pairs).toBeGreaterThan(100);
      const snippet = await playground.download("js");
      expect(snippet).toContain("step 5");
      mkdirSync(written, { recursive: true });
      const file = `${written}boxes-${dimensions}.mjs`;
      writeFileSync(file, snippet);
      expect(execFileSync(process.execPath, [file], { encoding: "utf8", env: { ...process.env, FORCE_COLOR: "0" } })).toBe(`${pairs}\n`);
    });
  }

  // That these files run and find what they say is tested in site/wasm/tests/snippet.rs and python/tests.
  for (const [language, format, printed] of [["Rust", "rs", "pairs.len()); //"], ["Python", "py", "print(len(pairs))  #"]] as const) {
    test(`${language} is the file that is run elsewhere`, async ({ page }) => {
      const playground = await new Playground(page).open(`?boxes=50&scene=mixed&motion=still&size=2&format=${format}`);
      const snippet = await playground.download(format);
      const file = new URL(`playground.${format}`, snippets);
      if (process.env["UPDATE_SNIPPETS"]) writeFileSync(file, snippet);
      expect(snippet).toBe(readFileSync(file, "utf8"));
      expect(snippet).toContain(`${printed} ${await playground.value("pairs")}\n`);
    });
  }

  test("JSON says everything, to the last bit", async ({ page }) => {
    const playground = await new Playground(page).open("?boxes=200&scene=tiny&seed=9");
    const json = JSON.parse(await playground.download("json"));
    expect(json).toMatchObject({ scene: "tiny", seed: 9, step: 0, dimensions: 2, count: 200, algorithm: "sorted pairwise" });
    expect(json.pairs).toBe(await playground.value("pairs"));
    expect(json.boxes.length).toBe(200);
    const rows = (json.boxes as number[][]).map((row) => row.map(Math.fround));
    expect(bruteForce(rows)).toBe(json.pairs);
    await page.goto(json.address);
    await expect.poll(() => playground.value("pairs")).toBe(json.pairs);
  });

  test("every algorithm finds as many pairs, in 2D and in 3D", async ({ page }) => {
    for (const dimensions of [2, 3]) {
      const playground = await new Playground(page).open(`?dimensions=${dimensions}&scene=needles&boxes=200`);
      const pairs = await playground.value("pairs");
      expect(pairs).toBeGreaterThan(0);
      for (const algorithm of await playground.root.getByLabel("Algorithm").locator("option").allTextContents()) {
        await playground.root.getByLabel("Algorithm").selectOption(algorithm);
        await expect(playground.part("status")).toContainText(`by ${algorithm}. `);
        expect(await playground.value("pairs"), algorithm).toBe(pairs);
      }
    }
  });

  test("size and number change the world; the address keeps it", async ({ page }) => {
    const playground = await new Playground(page).open();
    expect(new URL(page.url()).search).toBe("");
    const pairs = await playground.value("pairs");
    await playground.root.getByRole("slider", { name: "Size" }).fill("6");
    await expect.poll(() => playground.value("pairs")).toBeGreaterThan(2 * pairs);
    await playground.root.getByRole("slider", { name: "Boxes" }).fill("7");
    await playground.root.getByLabel("Scene").selectOption("grid");
    await playground.root.getByLabel("Seed").fill("12");
    await playground.root.getByLabel("Seed").press("Enter");
    await expect.poll(() => Object.fromEntries(new URL(page.url()).searchParams)).toEqual({ size: "2", boxes: "100", scene: "grid", seed: "12" });
    await expect(playground.part("status")).toContainText(/100 boxes, grid.*pairs/);
    const grid = await playground.value("pairs");
    await page.reload();
    await expect.poll(() => playground.value("pairs")).toBe(grid);
    await playground.open("?boxes=1e9&size=-1&spread=x&scene=nowhere&dimensions=7&motion=&algorithm=magic&format=cobol");
    expect(await playground.value("pairs")).toBe(pairs);
  });

  test("the picture moves and zooms by pointer and by keyboard", async ({ page }) => {
    const playground = await new Playground(page).open();
    const surface = playground.part("surface");
    const picture = (): Promise<string> => playground.part("picture").evaluate((canvas: HTMLCanvasElement) => canvas.toDataURL());
    const all = await picture();
    await surface.focus();
    await page.keyboard.press("+");
    await expect.poll(picture).not.toBe(all);
    const zoomed = await picture();
    await page.keyboard.press("ArrowRight");
    await expect.poll(picture).not.toBe(zoomed);
    await page.keyboard.press("0");
    await expect.poll(picture).toBe(all);
    await surface.hover({ position: { x: 200, y: 200 } });
    await page.mouse.down();
    await page.mouse.move(400, 500, { steps: 3 });
    await page.mouse.up();
    await expect.poll(picture).not.toBe(all);
    await playground.root.getByRole("button", { name: "Show all" }).click();
    await expect.poll(picture).toBe(all);
  });

  for (const colorScheme of ["light", "dark"] as const) {
    test(`axe finds nothing in ${colorScheme}, and it fits a phone`, async ({ page }) => {
      await page.emulateMedia({ colorScheme });
      await page.setViewportSize({ width: colorScheme === "dark" ? 390 : 1280, height: 844 });
      await new Playground(page).open("?boxes=100");
      expect(await violations(page)).toEqual([]);
      expect(await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth)).toBeLessThanOrEqual(0);
    });
  }
});

/** How many of these rows overlap, by definition. */
function bruteForce(rows: readonly (readonly number[])[]): number {
  const overlaps = (a: readonly number[], b: readonly number[]): boolean =>
    [0, 1].every((axis) => (a[axis] ?? 0) <= (b[axis + 2] ?? 0) && (b[axis] ?? 0) <= (a[axis + 2] ?? 0));
  return rows.reduce((sum, a, i) => sum + rows.slice(i + 1).filter((b) => overlaps(a, b)).length, 0);
}
