// The sweep in memory and in vectors: what is shown is what a real search has done, and what an independent count says.
import { readFileSync } from "node:fs";
import { expect, test } from "@playwright/test";

interface Entry {
  left: number;
  right: number;
  min: number;
  max: number;
  id: number;
  dedup: number;
}

const record = readFileSync(new URL("../../core/src/pairs/columns.txt", import.meta.url), "utf8").trim().split("\n");
const columns: Entry[][] = [];
for (const line of record) {
  const [left = 0, right = 0, min = 0, max = 0, id = 0, dedup = 0] = line.split(" ").map(Number);
  if (line.startsWith("column")) columns.push([]);
  else if (!line.startsWith("pair")) columns.at(-1)!.push({ left, right, min, max, id, dedup });
}
const overlap = (a: Entry, b: Entry): boolean => a.left <= b.right && b.left <= a.right && a.min <= b.max && b.min <= a.max;
const largest = columns.reduce((most, column) => (column.length > most.length ? column : most));

test("the record is of a search in several columns, which finds the pairs of brute force, each once", () => {
  expect(columns.length).toBeGreaterThan(2);
  const pairs = record.filter((line) => line.startsWith("pair")).map((line) => line.slice(5)).sort();
  const boxes = [...new Map(columns.flat().map((box) => [box.id, box])).values()];
  expect(columns.flat().length, "some are in two columns").toBeGreaterThan(boxes.length);
  const expected = boxes.flatMap((a) => boxes.filter((b) => a.id < b.id && overlap(a, b)).map((b) => `${a.id} ${b.id}`)).sort();
  expect(pairs).toEqual(expected);
  const reported = columns.flatMap((column) => column.flatMap((a, at) => column.slice(at + 1).filter((b) => overlap(a, b) && (a.dedup & b.dedup) === 0).map((b) => `${Math.min(a.id, b.id)} ${Math.max(a.id, b.id)}`)));
  expect(reported.sort()).toEqual(expected);
  for (const column of columns) expect(column.every(({ left }, at) => at === 0 || column[at - 1]!.left <= left)).toBe(true);
});

test("with any number of lanes the steps are those of the kernels, and all overlaps of the column are found", async ({ page }) => {
  await page.goto("/#lanes");
  const figure = page.locator("fast-sweep");
  await figure.scrollIntoViewIfNeeded();
  await expect(figure).toHaveAttribute("data-ready", "");
  const expected = largest.flatMap((a, at) => largest.slice(at + 1).filter((b) => overlap(a, b))).length;
  const counts: number[] = [];
  for (const width of [1, 4, 8, 16]) {
    await figure.locator("select").selectOption(String(width));
    // A vector is loaded, and another one as long as the last lane has begun.
    const steps = largest.reduce((sum, a, at) => sum + Math.floor(largest.slice(at + 1).filter((b) => b.left <= a.right).length / width) + 1, 0);
    const seen = await figure.evaluate((element) => {
      const slider = element.querySelector("input")!;
      const seen = { steps: Number(slider.max) + 1, hits: 0, lanes: new Set<number>(), loaded: 0, all: 0, lost: 0 };
      for (let step = 0; step <= Number(slider.max); step++) {
        slider.value = String(step);
        slider.dispatchEvent(new Event("input", { bubbles: true }));
        seen.hits += element.querySelectorAll("svg:first-child .hit").length;
        seen.lanes.add(element.querySelectorAll("svg:nth-of-type(3) rect").length / 4);
        const [, loaded, all] = /steps.*?(\d+)\s+of (\d+) cache lines/s.exec(element.querySelector(".fast-count")!.textContent!) ?? [];
        seen.lost += Number(Number(loaded) < seen.loaded);
        [seen.loaded, seen.all] = [Number(loaded), Number(all)];
      }
      return { ...seen, lanes: [...seen.lanes] };
    });
    expect(seen).toEqual({ steps, hits: expected, lanes: [width], loaded: Math.ceil(largest.length / 16), all: Math.ceil(largest.length / 16), lost: 0 });
    counts.push(steps);
  }
  expect(counts[0]! / counts[2]!, "fewer steps with eight lanes").toBeGreaterThan(2);
});

test("a sweep loads neighbors, a grid and a tree load cache lines here and there", async ({ page }) => {
  await page.goto("/#sweep-grid-tree");
  const figure = page.locator("three-structures");
  await figure.scrollIntoViewIfNeeded();
  await expect(figure).toHaveAttribute("data-ready", "");
  const rows = await figure.evaluate((element) => (element as unknown as { rows: number[][] }).rows);
  const sorted = rows.map((_, id) => id).sort((a, b) => rows[a]![0]! - rows[b]![0]! || a - b);
  const loaded = (name: string): Promise<number[][]> =>
    figure.locator(`[data-structure=${name}] .memory-row`).evaluateAll((all) => all.map((row) => [...row.children].flatMap((cell, at) => (cell.className === "loaded" ? [at] : []))));
  for (let chosen = 0; chosen < 80; chosen += 9) {
    await figure.evaluate((element, chosen) => {
      const [left = 0, top = 0, right = 0, bottom = 0] = (element as unknown as { rows: number[][] }).rows[chosen]!;
      (element as unknown as { chosen: number; place(id: number, x: number, y: number): void }).chosen = chosen;
      (element as unknown as { place(id: number, x: number, y: number): void }).place(chosen, (left + right) / 2, (top + bottom) / 2);
    }, chosen);
    const from = sorted.indexOf(chosen);
    const after = sorted.findIndex((id, at) => at > from && rows[id]![0]! > rows[chosen]![2]!);
    const end = after < 0 ? 79 : after;
    // Four boxes of 16 bytes in a line of 64.
    const lines = Array.from({ length: Math.floor(end / 4) - Math.floor(from / 4) + 1 }, (_, at) => Math.floor(from / 4) + at);
    expect(await loaded("sweep"), `box ${chosen}`).toEqual([lines]);
    for (const name of ["grid", "tree"]) {
      const arrays = await loaded(name);
      expect(arrays).toHaveLength(2);
      // The box itself is read.
      expect(arrays[1]).toContain(Math.floor(chosen / 4));
      await expect(figure.locator(`[data-structure=${name}] [data-part=lines]`)).toHaveText(String(arrays.flat().length));
    }
  }
});
