// What the figure of three structures shows: three panels of one world, as html. Written when the site is built, and
// again whenever a box is moved.

import { rect } from "../svg.ts";
import { type Box, grid, HEIGHT, linesOf, type MemoryArray, type Pair, sweep, tree, WIDTH, type Work, world } from "./structures.ts";

export const structures = [
  { name: "Sweep", says: "along x", run: sweep },
  { name: "Grid", says: "cells of equal size", run: grid },
  { name: "Tree", says: "boxes in boxes", run: tree },
] as const;

/** All that stands in a `<three-structures>` at first. Its choice can be used once there are scripts. */
export function inside(): string {
  const boxes = world("even");
  return `
    <div class="structures" role="group" aria-label="Eighty boxes in a sweep, a grid and a tree. B chooses the next box, the arrow keys move it.">${panels(boxes, 0)}</div>
    <div class="choices"><label>World
      <select autocomplete="off" disabled>
        <option value="even">Boxes of similar size, everywhere</option>
        <option value="long">A long level</option>
        <option value="one large">One large box among small ones</option>
      </select></label></div>
    <p class="caption">All three find the same <strong data-part="pairs">${countPairs(boxes)}</strong> pairs.</p>`;
}

/** The three panels, with what is shown of one box. */
export function panels(boxes: readonly Box[], chosen: number): string {
  const works = structures.map(({ run }) => run(boxes));
  const most = Math.max(...works.map(({ tests }) => tests.length));
  return structures
    .map(({ name, says }, at) => {
      const work = works[at]!;
      const ofChosen = new Set(partners(work.tests, chosen));
      const share = (100 * work.tests.length) / most;
      return `<figure class="structure" data-structure="${name.toLowerCase()}">
        <p class="structure-name"><strong>${name}</strong> ${says}</p>
        ${picture(boxes, work, chosen, ofChosen, `${name}: ${boxes.length} boxes; box ${chosen + 1} is tested against ${ofChosen.size} others.`)}
        ${memory(work.memoryOf(chosen))}
        <div class="work-bar" aria-hidden="true"><span style="width:${share.toFixed(1)}%"></span></div>
        <p class="structure-count"><strong data-part="tests">${work.tests.length}</strong> box tests, and ${work.beside}</p>
      </figure>`;
    })
    .join("");
}

/** How many pairs there are: all three find the same ones. */
export function countPairs(boxes: readonly Box[]): number {
  return sweep(boxes).pairs.length;
}

function picture(boxes: readonly Box[], work: Work, chosen: number, tested: ReadonlySet<number>, label: string): string {
  const overlapping = new Set(work.pairs.flat());
  const shapes = boxes.map((box, id) => {
    const kinds = ["box", overlapping.has(id) ? "overlaps" : "", tested.has(id) ? "tested" : "", id === chosen ? "chosen" : ""];
    return rect(box, kinds.filter(Boolean).join(" "));
  });
  // The one that is chosen is never hidden.
  const last = shapes.splice(chosen, 1);
  return `<svg viewBox="0 0 ${WIDTH} ${HEIGHT}" role="img" aria-label="${label}">${work.partsOf(boxes[chosen]!).map((part) => rect(part, "looked")).join("")}${work.parts.map((part) => rect(part, "part")).join("")}${shapes.join("")}${last.join("")}</svg>`;
}

/** A cell for each cache line: filled where it is loaded to find the partners of the box in question. */
function memory(arrays: readonly MemoryArray[]): string {
  const all = arrays.map((array) => ({ name: array.name, lines: linesOf(array) }));
  const loaded = all.reduce((sum, { lines }) => sum + lines.filter(Boolean).length, 0);
  const rows = all.map(({ lines, name }) => `<span class="memory-row" title="${name}">${lines.map((isLoaded) => `<i${isLoaded ? ' class="loaded"' : ""}></i>`).join("")}</span>`);
  return `<div class="memory" role="img" aria-label="Memory: ${all.map(({ name, lines }) => `${name}, ${lines.filter(Boolean).length} of ${lines.length} cache lines`).join("; ")}">${rows.join("")}</div>
        <p class="structure-count"><strong data-part="lines">${loaded}</strong> cache lines for this box</p>`;
}

function partners(tests: readonly Pair[], id: number): number[] {
  return tests.flatMap(([a, b]) => (a === id ? [b] : b === id ? [a] : []));
}
