// What `<fast-sweep>` shows of one step: the boxes, the arrays of their column in memory, and the lanes of a vector.

import type { Box } from "../box.ts";
import { rect } from "../svg.ts";
import { columnsOf, LINE, type Step, stepsOf } from "./sweep-steps.ts";

export const WIDTHS = [1, 4, 8, 16] as const;
const WIDE = 560;
/** Where the squares of the comparisons begin. */
const LABELS = 178;

export interface Shown {
  readonly steps: readonly Step[];
  readonly html: (step: number) => string;
}

const cell = (left: number, top: number, width: number, height: number, kind: string): string => rect({ left, top, right: left + width, bottom: top + height }, kind);

/** The sweep of the largest column of a recorded search, with vectors of this many lanes. */
export function sweepOf(record: string, width: number): Shown {
  const columns = columnsOf(record);
  const column = columns.reduce((largest, each) => (each.length > largest.length ? each : largest));
  const all = columns.flat();
  const steps = stepsOf(column, width);
  const [left, right] = [Math.min(...all.map((box) => box.left)), Math.max(...all.map((box) => box.right))];
  const [top, bottom] = [Math.min(...all.map((box) => box.top)), Math.max(...all.map((box) => box.bottom))];
  const height = 300;
  const x = (at: number): number => ((at - left) * WIDE) / (right - left);
  const y = (at: number): number => ((at - top) * height) / (bottom - top);
  const shape = (box: Box, kind: string): string => rect({ left: x(box.left), top: y(box.top), right: x(box.right), bottom: y(box.bottom) }, kind);
  const tests = stepsOf(column, 1).length;
  const lineCount = Math.ceil(column.length / LINE);

  const scene = ({ probe, from, lanes, hits }: Step): string => {
    const others = all.filter((box) => !column.some(({ id }) => id === box.id)).map((box) => shape(box, "other"));
    const boxes = column.map((box, at) => {
      const kind = at === probe ? "probe" : hits.includes(at) ? "hit" : at >= from && at < from + lanes.length ? "lane" : "box";
      return shape(box, kind);
    });
    return `<svg viewBox="-2 -2 ${WIDE + 4} ${height + 4}" role="img" aria-label="A column of ${column.length} boxes; box number ${probe + 1} is compared with ${lanes.length === 1 ? "the one" : `the ${lanes.length}`} at ${from + 1}.">${others.join("")}${boxes.join("")}${boxes[probe]}</svg>`;
  };

  const pitch = WIDE / (Math.ceil((column.length + 16) / LINE) * LINE + 4);
  /** How many cache lines of each array are loaded after a step: a later probe begins further left. */
  const linesAt = (at: number): number => Math.max(...steps.slice(0, at + 1).map(({ from }) => Math.min(Math.floor((from + width - 1) / LINE) + 1, lineCount)));
  const memory = ({ probe, from, lanes }: Step, lines: number): string => {
    const rows = ["left", "top", "bottom"].map((name, row) => {
      const begin = 78;
      const place = (at: number): number => begin + (at * (WIDE - begin)) / (WIDE / pitch) + (Math.floor(at / LINE) * (WIDE - begin)) / WIDE * 3;
      const size = ((WIDE - begin) * pitch) / WIDE;
      const cells = Array.from({ length: column.length }, (_, at) => {
        const inVector = at >= from && at < from + lanes.length;
        const kind = at === probe ? "probe" : inVector ? "lane" : Math.floor(at / LINE) < lines ? "loaded" : "cell";
        return cell(place(at), 6 + 26 * row, size * 0.86, 18, kind);
      });
      return `<text x="0" y="${20 + 26 * row}">${name}</text>${cells.join("")}`;
    });
    return `<svg viewBox="0 0 ${WIDE} 86" role="img" aria-label="Three arrays in memory, in cache lines of ${LINE} numbers. A vector of ${lanes.length} from position ${from + 1} is loaded from each.">${rows.join("")}</svg>`;
  };

  const vector = ({ lanes, hits, from }: Step): string => {
    const says = [
      ["b.left ≤ a.right", ({ begun }: Step["lanes"][number]) => begun],
      ["b.top ≤ a.bottom", ({ above }: Step["lanes"][number]) => above],
      ["b.bottom ≥ a.top", ({ below }: Step["lanes"][number]) => below],
      ["all three", ({ begun, above, below }: Step["lanes"][number]) => begun && above && below],
    ] as const;
    const size = Math.min(30, (WIDE - LABELS) / lanes.length);
    const rows = says.map(([name, holds], row) => {
      const top = 4 + 30 * row + (row === 3 ? 6 : 0);
      return `<text x="0" y="${top + 18}">${name}</text>${lanes.map((lane, at) => cell(LABELS + size * at, top, size - 3, 24, holds(lane) ? "yes" : "no")).join("")}`;
    });
    const found = hits.length === 0 ? "none overlaps" : hits.length === 1 ? `number ${hits[0]! + 1} overlaps` : `numbers ${hits.map((at) => at + 1).join(" and ")} overlap`;
    return `<svg viewBox="0 0 ${WIDE} 134" role="img" aria-label="The comparisons of the lanes from number ${from + 1} on: ${found}.">${rows.join("")}</svg>`;
  };

  return {
    steps,
    html: (at) => {
      const step = steps[at]!;
      const lines = linesAt(at);
      return `${scene(step)}${memory(step, lines)}${vector(step)}
        <p class="fast-count"><strong>${at + 1}</strong> of ${steps.length} steps (one lane: ${tests.toLocaleString("en")}); <strong>${lines}</strong> of ${lineCount} cache lines of each array loaded</p>`;
    },
  };
}

/** The step that is shown first: one that finds something in the middle of the column. */
export function firstStep({ steps }: Shown): number {
  const middle = steps.findIndex(({ hits }, at) => at > steps.length / 3 && hits.length > 0);
  return Math.max(0, middle);
}

/** All that stands in a `<fast-sweep>` at first. Its controls can be used once there are scripts. */
export function inside(record: string): string {
  const shown = sweepOf(record, 8);
  const at = firstStep(shown);
  return `<div class="fast-picture">${shown.html(at)}</div>
    <div class="choices">
      <label>Step <input type="range" min="0" max="${shown.steps.length - 1}" value="${at}" autocomplete="off" disabled /></label>
      <label>Lanes <select autocomplete="off" disabled>${WIDTHS.map((width) => `<option${width === 8 ? " selected" : ""}>${width}</option>`).join("")}</select></label>
    </div>`;
}
