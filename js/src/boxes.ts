import { describe } from "./describe.js";
import { unguard } from "./views.js";

/** 1, 2 or 3. */
export type Dimensions = 1 | 2 | 3;

/**
 * Boxes, one row after another: the min corner and then the max corner, so `minX, minY, maxX, maxY`
 * in 2D.
 *
 * Coordinates are compared exactly as given: `Float32Array` in single, `Float64Array` in double
 * precision. Plain arrays, of numbers or of {@link BoxObject | boxes}, are slower: each call reads
 * every number, checks it and copies it to a `Float64Array`.
 */
export type Boxes = Float32Array | Float64Array | readonly number[] | readonly BoxObject[];

/**
 * A box in the form of another library: `{ minX, minY, maxX, maxY }` of rbush, with `minZ` and
 * `maxZ` in 3D; `{ min, max }` of the `Box2` and `Box3` of three.js and the bounds of matter;
 * `{ lowerBound, upperBound }` of cannon and planck; a row of numbers as in box-intersect. Other
 * properties of the object are ignored.
 */
export type BoxObject = EdgesBox | MinMaxBox | BoundsBox | readonly number[];

/** A box by its edges, as in rbush. */
export interface EdgesBox {
  /** The smallest x. */
  readonly minX: number;
  /** The smallest y, in 2D and 3D. */
  readonly minY?: number;
  /** The smallest z, in 3D. */
  readonly minZ?: number;
  /** The greatest x. */
  readonly maxX: number;
  /** The greatest y. */
  readonly maxY?: number;
  /** The greatest z. */
  readonly maxZ?: number;
}

/** A box by its corners, as in three.js and matter. */
export interface MinMaxBox {
  /** The min corner. */
  readonly min: Corner;
  /** The max corner. */
  readonly max: Corner;
}

/** A box by its corners, as in cannon and planck. */
export interface BoundsBox {
  /** The min corner. */
  readonly lowerBound: Corner;
  /** The max corner. */
  readonly upperBound: Corner;
}

/** A corner of a box: as many coordinates as there are dimensions. */
export interface Corner {
  /** The first coordinate. */
  readonly x: number;
  /** The second, in 2D and 3D. */
  readonly y?: number;
  /** The third, in 3D. */
  readonly z?: number;
}

/** @internal The dimensions, checked. */
export function checkDimensions(dimensions: unknown): Dimensions {
  if (dimensions === 1 || dimensions === 2 || dimensions === 3) return dimensions;
  throw new RangeError(`\`dimensions\` must be 1, 2 or 3, not ${describe(dimensions)}`);
}

/** @internal How many dimensions boxes have that are objects: those of the first; `undefined` for flat arrays. */
export function dimensionsOf(boxes: unknown): Dimensions | undefined {
  const first: unknown = Array.isArray(boxes) ? boxes[0] : undefined;
  if (Array.isArray(first)) return checkDimensions(first.length / 2);
  if (typeof first !== "object" || first === null) return undefined;
  const form = formOf(first);
  if (!form) refuseObject(first, "boxes[0]");
  const has = (axis: number): boolean => read(first, form, 0, axis) !== undefined;
  return has(2) ? 3 : has(1) ? 2 : has(0) ? 1 : undefined;
}

/** @internal The boxes as a typed array of whole rows. Their coordinates are not checked. */
export function checkBoxes(boxes: unknown, dimensions: Dimensions, name = "boxes"): Float32Array | Float64Array {
  if (Array.isArray(boxes) && typeof boxes[0] === "object") return fromObjects(boxes, dimensions, name);
  const rows = checkNumbers(boxes, name);
  const width = 2 * dimensions;
  if (rows.length % width !== 0) {
    throw new RangeError(
      `${name} holds ${rows.length} numbers, which is not a multiple of ${width}: ` +
        `a box in ${dimensions}D is the ${dimensions} of its min corner and the ${dimensions} of its max corner`,
    );
  }
  return rows;
}

/** @internal Numbers as a typed array. */
export function checkNumbers(values: unknown, name: string): Float32Array | Float64Array {
  const numbers = Array.isArray(values) ? fromNumbers(values, name) : unguard(values);
  if (!isFloatArray(numbers)) {
    throw new TypeError(`\`${name}\` must be a Float32Array, a Float64Array or a plain array, not ${describe(values)}`);
  }
  if (numbers.length === 0) refuseDetached(numbers, name);
  return numbers;
}

/**
 * @internal Writes rows of boxes to memory that has at least as many dimensions. The boxes are flat
 * on the axes that are added.
 */
export function writeRows(
  rows: Float32Array | Float64Array,
  dimensions: Dimensions,
  into: Float32Array | Float64Array,
  stored: Dimensions,
): void {
  if (dimensions === stored) {
    into.set(rows);
    return;
  }
  for (let from = 0, to = 0; from < rows.length; from += 2 * dimensions, to += 2 * stored) {
    for (let axis = 0; axis < stored; axis++) {
      into[to + axis] = axis < dimensions ? rows[from + axis]! : 0;
      into[to + stored + axis] = axis < dimensions ? rows[from + dimensions + axis]! : 0;
    }
  }
}

function fromNumbers(numbers: readonly unknown[], name: string): Float64Array {
  const rows = new Float64Array(numbers.length);
  for (let at = 0; at < rows.length; at++) {
    const value = numbers[at];
    if (typeof value !== "number") throw new TypeError(`${name}[${at}] must be a number, not ${describe(value)}`);
    rows[at] = value;
  }
  return rows;
}

/** The names of a box's two corners, and whether these are objects (`min.x`) or prefixes (`minX`). */
type Form = readonly [readonly [string, string], nested: boolean];

const forms: readonly Form[] = [
  [["min", "max"], true],
  [["lowerBound", "upperBound"], true],
  [["min", "max"], false],
];

function formOf(box: object): Form | undefined {
  return forms.find(([[min], nested]) => (nested ? min : "minX") in box);
}

/** A coordinate of corner 0 or 1 of a box; the caller checks that it is a number. */
function read(box: object, [corners, nested]: Form, corner: 0 | 1, axis: number): unknown {
  const name = corners[corner];
  const [from, key] = nested
    ? [(box as Record<string, unknown>)[name], "xyz"[axis]!]
    : [box, name + "XYZ"[axis]!];
  return (from as Record<string, unknown> | null | undefined)?.[key];
}

function fromObjects(boxes: readonly unknown[], dimensions: Dimensions, name: string): Float64Array {
  const rows = new Float64Array(2 * dimensions * boxes.length);
  let at = 0;
  for (let index = 0; index < boxes.length; index++) {
    const box = boxes[index];
    const isRow = Array.isArray(box);
    const form = typeof box === "object" && box !== null && !isRow ? formOf(box) : undefined;
    if (!isRow && form === undefined) refuseObject(box, `${name}[${index}]`);
    if (isRow && box.length !== 2 * dimensions) {
      throw new RangeError(`${name}[${index}] must hold ${2 * dimensions} numbers, not ${box.length}`);
    }
    for (const corner of [0, 1] as const) {
      for (let axis = 0; axis < dimensions; axis++, at++) {
        const value: unknown = form ? read(box as object, form, corner, axis) : (box as unknown[])[corner * dimensions + axis];
        if (typeof value !== "number") {
          const which = `${corner ? "max" : "min"} ${"xyz"[axis]}`;
          throw new TypeError(`the ${which} of ${name}[${index}] must be a number, not ${describe(value)}`);
        }
        rows[at] = value;
      }
    }
  }
  return rows;
}

/** Throws that a value is not a box. */
function refuseObject(box: unknown, name: string): never {
  const isObject = typeof box === "object" && box !== null;
  throw new TypeError(
    `${name} must be { minX, .. }, { min, max }, { lowerBound, upperBound } or a row of numbers, not ` +
      (isObject ? `an object with ${Object.keys(box).slice(0, 6).join(", ") || "no properties"}` : describe(box)),
  );
}

/** By its tag, not by `instanceof`, which is false for arrays of another realm (a frame, a test runner). */
function isFloatArray(value: unknown): value is Float32Array | Float64Array {
  if (!ArrayBuffer.isView(value)) return false;
  const tag = (value as Float32Array)[Symbol.toStringTag] as string;
  return tag === "Float32Array" || tag === "Float64Array";
}

/** A detached array looks like an empty one; only its methods throw. */
function refuseDetached(rows: Float32Array | Float64Array, name: string): void {
  try {
    rows.indexOf(0);
  } catch {
    throw new TypeError(`the buffer of ${name} is detached: it was transferred, or its memory grew`);
  }
}
