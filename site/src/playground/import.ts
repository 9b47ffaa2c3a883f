// Boxes of the visitor's own, as text: CSV or JSON, in the forms in which programs write boxes.

import { messageOf } from "../message-of.ts";
import type { Shown } from "./hands.ts";

/** The most boxes that the playground takes. */
const MOST_BOXES = 20_000;

/** One box as it was written, and where. */
interface Row {
  readonly where: string;
  /** By column or key, or in order: the min corner and then the max corner. */
  readonly values: readonly unknown[] | Readonly<Record<string, unknown>>;
}

/** What each axis may be called: its two ends, or its beginning and its length. */
const AXES = [
  { ends: [["minx", "maxx"], ["xmin", "xmax"], ["left", "right"], ["x0", "x1"]], begin: "x", lengths: ["width", "w"] },
  { ends: [["miny", "maxy"], ["ymin", "ymax"], ["top", "bottom"], ["y0", "y1"]], begin: "y", lengths: ["height", "h"] },
  { ends: [["minz", "maxz"], ["zmin", "zmax"], ["front", "back"], ["z0", "z1"]], begin: "z", lengths: ["depth", "d"] },
] as const;

const FORMS = "4 numbers (2D) or 6 (3D), the min corner and then the max corner";

/**
 * Reads boxes from text: JSON if it begins as an array or an object does, otherwise CSV.
 *
 * @throws `Error` that names the line, or the index of the box, and says what is wrong with it.
 */
export function readBoxes(text: string): Shown {
  const rows = /^\s*[[{]/.test(text) ? jsonRows(text) : csvRows(text);
  if (rows.length === 0) throw new Error(`There are no boxes in it. Each line or row has to be ${FORMS}.`);
  if (rows.length > MOST_BOXES) throw new Error(`There are ${rows.length} boxes; the playground takes ${MOST_BOXES} at most.`);
  const all = rows.map(cornersOf);
  const length = all[0]!.length;
  const other = all.findIndex((corners) => corners.length !== length);
  if (other > 0) throw new Error(`${rows[other]!.where} has ${all[other]!.length / 2} dimensions, the ones before have ${length / 2}.`);
  return { dimensions: length === 6 ? 3 : 2, boxes: Float32Array.from(all.flat()) };
}

/** Lines of numbers between commas, semicolons, tabs or spaces; the first may name the columns, `#` begins a comment. */
function csvRows(text: string): Row[] {
  const lines = text.split(/\r?\n/).map((line, at) => ({ where: `Line ${at + 1}`, line: line.replace(/#.*/, "").trim() })).filter(({ line }) => line !== "");
  const separator = /[,;\t]/.exec(lines[0]?.line ?? "")?.[0] ?? /\s+/;
  const cells = lines.map(({ where, line }) => ({ where, values: line.split(separator).map((cell) => cell.trim()) }));
  const names = cells[0]?.values.map(plain) ?? [];
  if (!names.some((name) => /^[a-z]/.test(name) && !/^(nan|inf)/.test(name))) return cells;
  return cells.slice(1).map(({ where, values }) => ({ where, values: Object.fromEntries(values.map((value, at) => [names[at], value])) }));
}

/** An array of boxes, or an object that has it as `boxes`, which is what the playground itself exports. */
function jsonRows(text: string): Row[] {
  let parsed: unknown;
  try {
    parsed = JSON.parse(text);
  } catch (error) {
    throw new Error(`This is not valid JSON: ${messageOf(error)}`);
  }
  const list = Array.isArray(parsed) ? parsed : (parsed as { boxes?: unknown }).boxes;
  if (!Array.isArray(list)) throw new Error("The JSON has to be an array of boxes, or an object with such an array named boxes.");
  return list.map((box: unknown, at): Row => {
    const where = `Box ${at}`;
    if (Array.isArray(box)) return { where, values: box.flat() };
    if (typeof box !== "object" || box === null) throw new Error(`${where} is ${JSON.stringify(box)}; it has to be ${FORMS}.`);
    const { min, max } = box as { min?: unknown; max?: unknown };
    if (Array.isArray(min) && Array.isArray(max)) return { where, values: [...min, ...max] };
    return { where, values: Object.fromEntries(Object.entries(box).map(([key, value]) => [plain(key), value])) };
  });
}

/** The min corner and then the max corner. */
function cornersOf({ where, values }: Row): number[] {
  const corners = Array.isArray(values) ? values.map((value) => numberOf(value, where)) : namedCorners(values as Record<string, unknown>, where);
  if (corners.length !== 4 && corners.length !== 6) throw new Error(`${where} has ${corners.length} numbers; it has to be ${FORMS}.`);
  const dimensions = corners.length / 2;
  for (let axis = 0; axis < dimensions; axis++) {
    const [min, max] = [corners[axis]!, corners[axis + dimensions]!];
    if (min > max) throw new Error(`${where} ends before it begins on ${"xyz"[axis]}: min ${min}, max ${max}.`);
  }
  return corners;
}

function namedCorners(values: Readonly<Record<string, unknown>>, where: string): number[] {
  const ends = AXES.map(({ ends, begin, lengths }): [number, number] | undefined => {
    const named = ends.find(([first, last]) => first in values && last in values);
    if (named) {
      const [a, b] = [numberOf(values[named[0]], where), numberOf(values[named[1]], where)];
      // Where y goes up, the top is the greater.
      return named[0] === "top" ? [Math.min(a, b), Math.max(a, b)] : [a, b];
    }
    const length = lengths.find((name) => name in values);
    if (!(begin in values) || length === undefined) return undefined;
    const from = numberOf(values[begin], where);
    return [from, from + numberOf(values[length], where)];
  });
  const found = ends.filter((pair) => pair !== undefined);
  if (found.length < 2 || !ends[0] || !ends[1]) {
    throw new Error(`${where} names no box. It can have minX, minY, maxX, maxY; left, top, right, bottom; or x, y, width, height.`);
  }
  return [...found.map(([min]) => min), ...found.map(([, max]) => max)];
}

function numberOf(value: unknown, where: string): number {
  const number = typeof value === "number" ? value : typeof value === "string" && value !== "" ? Number(value) : Number.NaN;
  if (!Number.isFinite(Math.fround(number))) throw new Error(`${where}: ${JSON.stringify(value)} is not a number that single precision can hold.`);
  return number;
}

const plain = (name: string): string => name.toLowerCase().replace(/[^a-z0-9]/g, "");
