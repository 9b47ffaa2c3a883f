import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { expect, type Locator, type Page, test } from "@playwright/test";
import { boxAt } from "../src/playground/hands.ts";
import { shortest } from "../src/playground/export.ts";
import { readBoxes } from "../src/playground/import.ts";
import { frames } from "./support/frames.ts";
import { complaints, requestsElsewhere } from "./support/pages.ts";

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

test("no description of a scene and a motion moves what follows: there is room for the longest at any width", async ({ page }) => {
  const playground = await new Playground(page).open();
  await playground.root.getByRole("button", { name: "Pause" }).click();
  const scene = playground.root.getByLabel("Scene", { exact: true });
  const motion = playground.root.getByLabel("Motion", { exact: true });
  await scene.selectOption("more …");
  const described = new Set<string>();
  for (const name of await motion.locator("option").allTextContents()) {
    await motion.selectOption(name);
    described.add((await playground.part("about").textContent()) ?? "");
  }
  const [first = ""] = described;
  const ofScene = first.slice(0, first.lastIndexOf(". ") + 1);
  const motions = [...described].map((text) => text.slice(ofScene.length));
  const scenes: string[] = [];
  for (const name of await scene.locator("option").allTextContents()) {
    await scene.selectOption(name);
    scenes.push((await playground.part("about").textContent()) ?? "");
  }
  // Each with the motion that was chosen last: its place is taken by each other one.
  const texts = scenes.flatMap((text) => motions.map((motion) => text.replace(motions.at(-1)!, motion)));
  expect(texts.length).toBeGreaterThan(100);
  for (const width of [1280, 1000, 820, 640, 390, 320]) {
    await page.setViewportSize({ width, height: 900 });
    const heights = await playground.part("about").evaluate((about, texts) => texts.map((text) => ((about.textContent = text), about.getBoundingClientRect().height)), texts);
    expect(new Set(heights).size, `at ${width} pixels`).toBe(1);
  }
});

test("boxes are read from CSV and JSON in the forms in which programs write them, and errors say where", () => {
  const rows = (text: string): number[][] => {
    const { dimensions, boxes } = readBoxes(text);
    return Array.from({ length: boxes.length / (2 * dimensions) }, (_, box) => [...boxes.subarray(2 * dimensions * box, 2 * dimensions * (box + 1))]);
  };
  const two = [[0, 1, 2, 3], [-0.5, 1.5, 4, 5]];
  for (const text of [
    "0,1,2,3\n-0.5,1.5,4,5",
    "0 1 2 3\r\n-.5 1.5 4 5\r\n",
    "# a comment\nmin_x;min_y;max_x;max_y\n0;1;2;3\n\n-0.5;1.5;4;5 # the second",
    "id\tx\ty\twidth\theight\na\t0\t1\t2\t2\nb\t-0.5\t1.5\t4.5\t3.5",
    "[[0,1,2,3],[-0.5,1.5,4,5]]",
    "[[[0,1],[2,3]],[[-0.5,1.5],[4,5]]]",
    '{"boxes":[{"minX":0,"minY":1,"maxX":2,"maxY":3},{"left":-0.5,"top":5,"right":4,"bottom":1.5}]}',
    '[{"min":[0,1],"max":[2,3]},{"x":-0.5,"y":1.5,"w":4.5,"h":3.5}]',
  ]) {
    expect(rows(text), text).toEqual(two);
  }
  expect(readBoxes("0 0 0 1 1 1").dimensions).toBe(3);
  expect(rows("minx,miny,minz,maxx,maxy,maxz\n1,2,3,4,5,6")).toEqual([[1, 2, 3, 4, 5, 6]]);
  for (const [text, said] of [
    ["0,1,2,3\n0,1,2", "Line 2 has 3 numbers"],
    ["0,1,2,3\n0,x,2,3", 'Line 2: "x" is not a number'],
    ["[[0,0,1,1],[1,0,0,1]]", "Box 1 ends before it begins on x: min 1, max 0"],
    ["[[0,0,1,null]]", "Box 0: null is not a number"],
    ["0,0,1e99,1", "single precision"],
    ["0 0 1 1\n0 0 0 1 1 1", "Line 2 has 3 dimensions"],
    ["a,b\n1,2", "Line 2 names no box"],
    ["", "no boxes in it"],
    ["[3]", "Box 0 is 3"],
    ["{}", "array of boxes"],
    ["[1", "not valid JSON"],
    ["0 0 1 1\n".repeat(20_001), "20000 at most"],
  ] as const) {
    expect(() => readBoxes(text), text.slice(0, 40)).toThrow(said);
  }
  expect(boxAt({ dimensions: 2, boxes: Float32Array.of(0, 0, 10, 10, 4, 4, 6, 6) }, { x: 5, y: 5 }, 10), "the smaller one").toBe(1);
});

test("coordinates are written with the fewest digits that are read back as the same bits", () => {
  const bits = new Uint32Array(1);
  const float = new Float32Array(bits.buffer);
  const wrong: string[] = [];
  for (let at = 0; at < 20_000; at++) {
    bits[0] = Math.imul(at, 0x9e3779b1);
    const value = float[0]!;
    if (!Number.isFinite(value)) continue;
    const text = shortest(value);
    if (!Object.is(Math.fround(Number(text)), value)) wrong.push(`${value} as ${text}`);
  }
  expect(wrong).toEqual([]);
  expect([0.1, 1 / 3, -0, 16777216].map(Math.fround).map(shortest)).toEqual(["0.1", "0.33333334", "-0.0", "16777216"]);
});

test("what is copied while it runs is the step that is shown, and its address leads back to it", async ({ page, context }) => {
  await context.grantPermissions(["clipboard-read", "clipboard-write"]);
  const playground = await new Playground(page).open("?boxes=300&motion=fast&format=json");
  await expect.poll(async () => Number(await playground.root.getAttribute("data-step"))).toBeGreaterThan(5);
  await playground.root.getByRole("button", { name: "Copy", exact: true }).click();
  await expect(playground.part("exported")).toHaveText(/Step \d+ copied/);
  const copied = JSON.parse(await page.evaluate(() => navigator.clipboard.readText()));
  const shown = async (): Promise<unknown> => ({
    step: Number(await playground.root.getAttribute("data-step")),
    pairs: await playground.value("pairs"),
    beginning: await playground.part("preview").textContent().then((text) => JSON.parse(`${/"boxes": (\[[^]*?\]),\n/.exec(text!)![1]}]`)[0]),
  });
  const expected = { step: copied.step, pairs: copied.pairs, beginning: copied.boxes[0] };
  expect(await shown()).toEqual(expected);
  expect(new URL(copied.address).searchParams.get("step")).toBe(String(copied.step));
  await frames(page, 20);
  expect(await shown(), "it stays paused there").toEqual(expected);
  await page.goto("about:blank");
  await page.goto(copied.address);
  await expect(playground.root).toHaveAttribute("data-step", String(copied.step));
  await expect.poll(shown).toEqual(expected);
});

test("runs, and complains of nothing", async ({ page, baseURL }) => {
  const heard = complaints(page);
  const elsewhere = requestsElsewhere(page, baseURL ?? "");
  const playground = await new Playground(page).open();
  await expect.poll(async () => Number(await playground.root.getAttribute("data-step"))).toBeGreaterThan(10);
  for (const key of ["ms", "pairs", "tests", "axis-overlaps", "comparisons", "swaps"]) {
    await expect.poll(() => playground.value(key), { message: key }).toBeGreaterThan(0);
  }
  expect(heard).toEqual([]);
  expect(elsewhere).toEqual([]);
});

test("boxes that are imported or drawn stand still until Play", async ({ page }) => {
  const playground = await new Playground(page).open("?motion=fast");
  const play = playground.part("play");
  await expect(play).toHaveText("Pause");
  await playground.part("file").setInputFiles({ name: "a.csv", mimeType: "text/plain", buffer: Buffer.from("0,0,2,2\n5,5,6,6\n2,1,3,4") });
  await expect(play).toHaveText("Play");
  await expect.poll(() => playground.value("pairs")).toBe(1);
  expect(await playground.root.getAttribute("data-step")).toBe("0");
  await play.click();
  await expect.poll(async () => Number(await playground.root.getAttribute("data-step"))).toBeGreaterThan(2);
  await playground.root.getByRole("button", { name: "Add a box" }).click();
  await expect(play).toHaveText("Play");
  await expect(playground.root).toHaveAttribute("data-step", "0");
  await playground.open("?motion=fast&own=0,0,2,2;5,5,6,6");
  await expect(play).toHaveText("Play");
  await expect(playground.root).toHaveAttribute("data-step", "0");
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

  test("boxes are dragged, drawn, added, deleted, and that is undone; the address holds them", async ({ page }) => {
    const heard = complaints(page);
    const playground = await new Playground(page).open("?motion=still&own=0,0,2,2;5,5,6,6;2,1,3,4");
    const pairs = (expected: number): Promise<void> => expect.poll(() => playground.value("pairs")).toBe(expected);
    const rows = async (): Promise<number[][]> => JSON.parse(await playground.download("json")).boxes;
    await pairs(1);
    await expect(playground.part("status")).toContainText("3 boxes of your own");

    // The view shows 6 x 6 units, with a little around them.
    const at = async (x: number, y: number): Promise<[number, number]> => {
      await playground.part("surface").scrollIntoViewIfNeeded();
      const surface = (await playground.part("surface").boundingBox())!;
      const scale = (0.94 * Math.min(surface.width, surface.height)) / 6;
      return [surface.x + surface.width / 2 + (x - 3) * scale, surface.y + surface.height / 2 - (y - 3) * scale];
    };
    const drag = async (from: [number, number], to: [number, number]): Promise<void> => {
      await page.mouse.move(...(await at(...from)));
      await page.mouse.down();
      await page.mouse.move(...(await at(...to)), { steps: 5 });
      await page.mouse.up();
    };
    await drag([5.5, 5.5], [1.8, 1.8]);
    await pairs(3);
    const [, moved] = await rows();
    expect(moved!.map(Math.round)).toEqual([1, 1, 2, 2]);
    await expect(playground.part("selected")).toContainText("Box 1:");

    await playground.root.getByRole("button", { name: "Draw" }).click();
    await drag([4, 3], [5, 5]);
    await pairs(3);
    expect((await rows())[3]!.map(Math.round)).toEqual([4, 3, 5, 5]);
    await playground.root.getByRole("button", { name: "Draw" }).click();
    await playground.root.getByRole("button", { name: "Delete" }).click();
    await expect.poll(async () => (await rows()).length).toBe(3);
    await playground.root.getByRole("button", { name: "Undo" }).click();
    await expect.poll(async () => (await rows()).length).toBe(4);

    // By keys alone: the next box, a step to the left, wider, gone; one more.
    await playground.part("surface").focus();
    await page.keyboard.press("b");
    await expect(playground.part("selected")).toContainText("Box 0: x 0 to 2");
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("Shift+ArrowRight");
    await expect(playground.part("selected")).toContainText(/x 0\.0\d+ to 2\.1\d/);
    await page.keyboard.press("Delete");
    await pairs(1);
    await page.keyboard.press("n");
    await expect.poll(async () => (await rows()).length).toBe(4);
    // The download has taken the focus.
    await playground.part("surface").focus();
    await page.keyboard.press("Control+z");
    await expect.poll(async () => (await rows()).length).toBe(3);
    const kept = await rows();
    await expect.poll(() => new URL(page.url()).searchParams.get("own")?.split(";").length).toBe(3);
    await page.reload();
    await expect.poll(() => playground.value("pairs")).toBe(1);
    expect(await rows()).toEqual(kept);

    await playground.root.getByRole("button", { name: "Clear" }).click();
    await expect(playground.part("status")).toContainText("0 boxes of your own");
    await playground.root.getByLabel("Scene").selectOption("grid");
    await expect(playground.part("status")).toContainText("500 boxes, grid");
    expect(heard).toEqual([]);
  });

  test("boxes are imported from files, from text and by a drop; what was exported comes back bit for bit", async ({ page }) => {
    const playground = await new Playground(page).open("?boxes=150&scene=mixed&size=3");
    await playground.step();
    const pairs = await playground.value("pairs");
    expect(pairs).toBeGreaterThan(20);
    for (const format of ["csv", "json"] as const) {
      const exported = await playground.download(format);
      await playground.root.getByRole("button", { name: "Clear" }).click();
      await expect.poll(() => playground.value("pairs")).toBe(0);
      await playground.part("file").setInputFiles({ name: `boxes.${format}`, mimeType: "text/plain", buffer: Buffer.from(exported) });
      await expect(playground.part("imported")).toHaveText("150 boxes imported.");
      await expect.poll(() => playground.value("pairs")).toBe(pairs);
      const boxes = (text: string): string => text.slice(format === "json" ? text.indexOf('"boxes"') : 0);
      expect(boxes(await playground.download(format))).toBe(boxes(exported));
    }
    await playground.root.getByText("Paste boxes as text").click();
    await playground.part("pasted").fill("0,0,2,2\n1,1,0,3");
    await playground.root.getByRole("button", { name: "Use these boxes" }).click();
    await expect(playground.part("imported")).toHaveText("Line 2 ends before it begins on x: min 1, max 0.");
    expect(await playground.value("pairs"), "nothing has changed").toBe(pairs);
    await playground.part("surface").evaluate((surface) => {
      const dataTransfer = new DataTransfer();
      dataTransfer.items.add(new File(["0 0 0 1 1 1\n1 1 1 2 2 2\n5 5 5 6 6 6"], "boxes.txt"));
      surface.dispatchEvent(new DragEvent("drop", { dataTransfer, bubbles: true, cancelable: true }));
    });
    await expect.poll(() => playground.value("pairs")).toBe(1);
    await expect(playground.root.getByLabel("Dimensions")).toHaveValue("3");
  });

  test("where the first algorithm was stopped, the pairs of another one are exported", async ({ page }) => {
    const playground = await new Playground(page).open("?boxes=20000&scene=tower&algorithm=swap-driven+sweep&axis=x&2=find+pairs");
    await expect(playground.root.locator(".lane-out").first()).toContainText("would have to keep");
    const { algorithm, count, pairs } = JSON.parse(await playground.download("json"));
    expect([algorithm, count]).toEqual(["find pairs", 20_000]);
    expect(pairs).toBeGreaterThan(0);
  });

  test("an address that would not lead back is refused, with the reason", async ({ page }) => {
    const playground = await new Playground(page).open("?boxes=2&step=10000");
    await playground.step();
    await playground.part("share").click();
    await expect(playground.part("exported")).toContainText("an address leads to step 10,000 at most");
    const json = JSON.parse(await playground.download("json"));
    expect([json.step, json.address]).toEqual([10_001, undefined]);
    await playground.root.getByRole("button", { name: "Clear" }).click();
    await expect(playground.part("status")).toContainText("0 boxes of your own");
    await playground.part("share").click();
    await expect(playground.part("exported")).toContainText("there are no boxes to share");
  });

  test("JSON says everything", async ({ page }) => {
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
        // What the one before found is cleared at once.
        await expect(playground.part("status")).toContainText(`by ${algorithm}. ${pairs.toLocaleString("en")} pairs`);
        expect(await playground.value("pairs"), algorithm).toBe(pairs);
      }
    }
  });

  test("size and number change the world; the address keeps it", async ({ page }) => {
    const playground = await new Playground(page).open();
    expect(new URL(page.url()).search).toBe("");
    const pairs = await playground.value("pairs");
    await playground.root.getByRole("slider", { name: "Size", exact: true }).fill("6");
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

  test("six scenes are offered at once, and all of them after more", async ({ page }) => {
    const playground = await new Playground(page).open("?boxes=10&motion=still");
    const scene = playground.root.getByLabel("Scene");
    const names = (): Promise<string[]> => scene.locator("option").allTextContents();
    expect(await names()).toEqual(["falling balls", "uniform", "clustered", "tower", "mixed", "grid", "more …"]);
    await scene.selectOption("more …");
    await expect.poll(async () => (await names()).length).toBeGreaterThan(25);
    await expect(scene).toHaveValue("clustered");
    await scene.selectOption("needles");
    await expect(playground.part("status")).toContainText("needles");
    await page.reload();
    await expect(scene).toHaveValue("needles");
    expect(await names()).toHaveLength(8);
  });

  test("the picture moves and zooms by pointer and by keyboard", async ({ page }) => {
    const playground = await new Playground(page).open("?boxes=10");
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
    // Where no box is: one would be moved.
    await surface.hover({ position: { x: 4, y: 4 } });
    await page.mouse.down();
    await page.mouse.move(400, 500, { steps: 3 });
    await page.mouse.up();
    await expect.poll(picture).not.toBe(all);
    await playground.root.getByRole("button", { name: "Show all" }).click();
    await expect.poll(picture).toBe(all);
  });
});

/** How many of these rows overlap, by definition. */
function bruteForce(rows: readonly (readonly number[])[]): number {
  const overlaps = (a: readonly number[], b: readonly number[]): boolean =>
    [0, 1].every((axis) => (a[axis] ?? 0) <= (b[axis + 2] ?? 0) && (b[axis] ?? 0) <= (a[axis + 2] ?? 0));
  return rows.reduce((sum, a, i) => sum + rows.slice(i + 1).filter((b) => overlaps(a, b)).length, 0);
}
