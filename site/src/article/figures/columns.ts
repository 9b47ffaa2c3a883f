// How the library divides a scene, worked out on a small one: the same rules, the same counts.

import type { Box } from "../../box.ts";
import { overlaps } from "../../listings/overlaps.js";
import { randomFrom } from "../../random.ts";
import { line, rect, svg, text } from "../../svg.ts";

const SIDE = 330;
const COLUMNS = 6;
const HEIGHT = SIDE / COLUMNS;

function scene(): Box[] {
  const random = randomFrom(7);
  return Array.from({ length: 90 }, (_, id) => {
    const [width, height] = [9 + 13 * random(), 9 + 13 * random()];
    const [left, top] = [random() * (SIDE - width), random() * (SIDE - height)];
    return { id, left, top, right: left + width, bottom: top + height };
  });
}

/** The rows that a box touches: it is copied to each. */
const rowsOf = ({ top, bottom }: Box): number[] => {
  const [first, last] = [Math.floor(top / HEIGHT), Math.min(COLUMNS - 1, Math.floor(bottom / HEIGHT))];
  return Array.from({ length: last - first + 1 }, (_, at) => first + at);
};

/** How many pairs overlap on x: what a sweep has to test. */
function candidates(boxes: readonly Box[]): [Box, Box][] {
  const sorted = [...boxes].sort((a, b) => a.left - b.left);
  return sorted.flatMap((a, at) => {
    const ahead = sorted.slice(at + 1);
    const end = ahead.findIndex((b) => b.left > a.right);
    return ahead.slice(0, end < 0 ? ahead.length : end).map((b): [Box, Box] => [a, b]);
  });
}

/** One sweep over the whole, beside one in each column: copies made, tests saved, pairs found once. */
export function columns(): string {
  const boxes = scene();
  const whole = candidates(boxes);
  const parts = Array.from({ length: COLUMNS }, (_, row) => boxes.filter((box) => rowsOf(box).includes(row)));
  const inParts = parts.flatMap((part, row) => candidates(part).map(([a, b]) => ({ a, b, row })));
  const copies = parts.reduce((sum, part) => sum + part.length, 0);
  const pairs = whole.filter(([a, b]) => overlaps(a, b));
  // The column with the lower corner of the intersection reports the pair.
  const reported = inParts.filter(({ a, b, row }) => overlaps(a, b) && Math.floor(Math.max(a.top, b.top) / HEIGHT) === row);
  if (reported.length !== pairs.length) throw new Error("each pair once");

  const hit = new Set(pairs.flatMap(([a, b]) => [a.id, b.id]));
  const bodies = (shift: number): string =>
    boxes.map(({ left, right, ...box }) => rect({ ...box, left: left + shift, right: right + shift }, hit.has(box.id) ? "small-body hit" : "small-body")).join("");
  const second = SIDE + 50;
  const cuts = Array.from({ length: COLUMNS - 1 }, (_, at) => line(second, HEIGHT * (at + 1), second + SIDE, HEIGHT * (at + 1), "cut"));
  const frame = (left: number): string => rect({ left, top: 0.5, right: left + SIDE, bottom: SIDE }, "frame");
  return svg(
    "columns",
    second + SIDE + 1,
    SIDE + 58,
    `${boxes.length} boxes in one sweep: ${whole.length} tests. The same boxes cut into ${COLUMNS} columns: ${copies} copies, ${inParts.length} tests. Both find ${pairs.length} pairs.`,
    frame(0.5) + frame(second) + bodies(0) + bodies(second) + cuts.join("") +
      text(SIDE / 2, SIDE + 22, `one sweep, ${boxes.length} boxes`) + text(SIDE / 2, SIDE + 47, `${whole.length} tests, ${pairs.length} pairs`, "label strong") +
      text(second + SIDE / 2, SIDE + 22, `${COLUMNS} columns, ${copies} copies`) +
      text(second + SIDE / 2, SIDE + 47, `${inParts.length} tests, same ${reported.length} pairs`, "label strong"),
  );
}
