import { describe } from "../wasm/describe.js";
import { lengthOf, tagOf } from "../wasm/typed.js";
import { allocate, unguard } from "../wasm/views.js";

/** 1, 2 or 3. */
export type Dimensions = 1 | 2 | 3;

/** Numbers in a typed array. Those of whole numbers are copied: of up to 16 bits to single precision, others to double. */
export type TypedNumbers =
  | Float32Array
  | Float64Array
  | Int8Array
  | Uint8Array
  | Uint8ClampedArray
  | Int16Array
  | Uint16Array
  | Int32Array
  | Uint32Array;

/**
 * Boxes, one row after another: the min corner and then the max corner, so `minX, minY, maxX, maxY`
 * in 2D.
 *
 * Coordinates are compared exactly as given: `Float32Array` in single, `Float64Array` in double
 * precision. Plain arrays, of numbers or of {@link BoxObject | boxes}, are slower: each call reads
 * every number, checks it and copies it to a `Float64Array`.
 */
export type Boxes = TypedNumbers | readonly number[] | readonly BoxObject[];

/**
 * One box in the form of another library: `{ minX, minY, maxX, maxY }` of rbush, with `minZ` and
 * `maxZ` in 3D; `{ min, max }` of the `Box2` and `Box3` of three.js and the bounds of matter;
 * `{ lowerBound, upperBound }` of cannon and planck; `{ x, y, width, height }` of a `DOMRect` or a
 * sprite, with `z` and `depth` in 3D; a row of numbers as in box-intersect. Other properties of the
 * object are ignored.
 */
export type BoxObject = EdgesBox | MinMaxBox | BoundsBox | SizedBox | readonly number[] | TypedNumbers;

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

/** A box by its min corner and its size, as a `DOMRect`. Its max corner is their sum in double precision. */
export interface SizedBox {
  /** The smallest x. */
  readonly x: number;
  /** The smallest y, in 2D and 3D. */
  readonly y?: number;
  /** The smallest z, in 3D. */
  readonly z?: number;
  /** The extent in x, 0 or more. */
  readonly width: number;
  /** The extent in y. */
  readonly height?: number;
  /** The extent in z. */
  readonly depth?: number;
}

/** A point, or a corner of a box: as many coordinates as there are dimensions. */
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

/** @internal The boxes as a typed array of whole rows. Their coordinates are not checked. */
export function checkBoxes(boxes: unknown, dimensions: Dimensions, name = "boxes"): Float32Array | Float64Array {
  if (Array.isArray(boxes) && typeof boxes[0] === "object") return fromObjects(boxes, dimensions, name);
  const rows = checkNumbers(boxes, name);
  const [length, width] = [lengthOf(rows), 2 * dimensions];
  if (length % width !== 0) {
    throw new RangeError(
      `${name} holds ${length} numbers, which is not a multiple of ${width}: ` +
        `a box in ${dimensions}D is the ${dimensions} of its min corner and the ${dimensions} of its max corner`,
    );
  }
  return rows;
}

/** @internal Numbers as a typed array. Its own properties may be overridden: see typed.ts. */
export function checkNumbers(values: unknown, name: string): Float32Array | Float64Array {
  const numbers = Array.isArray(values) ? fromNumbers(values, name) : floats(unguard(values));
  if (!numbers) throw new TypeError(`\`${name}\` must be a typed array of numbers or a plain array, not ${describe(values)}`);
  if (lengthOf(numbers) === 0) refuseDetached(numbers, name);
  return numbers;
}

/** @internal Whether a value is a box or a point as an object with named coordinates. */
export function isNamed(value: unknown): value is object {
  return typeof value === "object" && value !== null && !isRow(value);
}

/** @internal Writes the corners of a box that is an object, from `at`. They are not checked, apart from their type. */
export function readBox(box: object, dimensions: Dimensions, name: string, into: Float64Array, at: number): void {
  const form = formOf(box, name);
  for (const corner of [0, 1] as const) {
    for (let axis = 0; axis < dimensions; axis++, at++) {
      const value = form.read(box, corner, axis);
      if (typeof value !== "number") {
        throw new TypeError(`the ${corner ? "max" : "min"} ${"xyz"[axis]} of ${name} must be a number, not ${describe(value)}`);
      }
      into[at] = value;
    }
  }
}

/** The length of an array, which a proxy may give as anything. */
function checkedLength(array: readonly unknown[], name: string): number {
  const { length } = array;
  if (!(Number.isInteger(length) && length >= 0)) throw new TypeError(`\`${name}.length\` is ${describe(length)}`);
  return length;
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
  for (let from = 0, to = 0; to < into.length; from += 2 * dimensions, to += 2 * stored) {
    for (let axis = 0; axis < stored; axis++) {
      into[to + axis] = axis < dimensions ? rows[from + axis]! : 0;
      into[to + stored + axis] = axis < dimensions ? rows[from + dimensions + axis]! : 0;
    }
  }
}

function fromNumbers(numbers: readonly unknown[], name: string): Float64Array {
  const length = checkedLength(numbers, name);
  const rows = allocate(() => new Float64Array(length));
  copyNumbers(numbers, length, name, rows, 0);
  return rows;
}

/** @internal Copies values that are to be numbers. */
export function copyNumbers(values: ArrayLike<unknown>, length: number, name: string, into: Float64Array, to: number): void {
  for (let at = 0; at < length; at++) {
    const value = values[at];
    if (typeof value !== "number") throw new TypeError(`${name}[${at}] must be a number, not ${describe(value)}`);
    into[to + at] = value;
  }
}

/** A form of boxes that are objects. */
interface Form {
  /** A property that only boxes of this form have. */
  readonly key: string;
  /** A coordinate of corner 0 or 1; the caller checks that it is a number. */
  read(box: object, corner: 0 | 1, axis: number): unknown;
}

/** @internal Each property by its name, which engines read several times faster than by a computed one. */
export function coordinate(corner: Corner | null | undefined, axis: number): unknown {
  return axis === 0 ? corner?.x : axis === 1 ? corner?.y : corner?.z;
}

const minMax: Form = {
  key: "min",
  read: (box, corner, axis) => coordinate(corner ? (box as MinMaxBox).max : (box as MinMaxBox).min, axis),
};

const bounds: Form = {
  key: "lowerBound",
  read: (box, corner, axis) => coordinate(corner ? (box as BoundsBox).upperBound : (box as BoundsBox).lowerBound, axis),
};

const edges: Form = {
  key: "minX",
  read(box, corner, axis) {
    const { minX, minY, minZ, maxX, maxY, maxZ } = box as EdgesBox;
    return axis === 0 ? (corner ? maxX : minX) : axis === 1 ? (corner ? maxY : minY) : corner ? maxZ : minZ;
  },
};

/** @internal The form of a `DOMRect`. */
export const sized: Form = {
  key: "width",
  read(box, corner, axis) {
    const from = coordinate(box as SizedBox, axis);
    if (!corner || typeof from !== "number") return from;
    const size: unknown = extent(box as SizedBox, axis);
    return typeof size === "number" ? from + size : size;
  },
};

/** @internal The size of a box on an axis. */
export function extent(box: SizedBox, axis: number): number | undefined {
  return axis === 0 ? box.width : axis === 1 ? box.height : box.depth;
}

const forms: readonly Form[] = [minMax, bounds, edges, sized];

/** @internal The form of a box that is an object. */
export function formOf(box: object, name: string): Form {
  return forms.find(({ key }) => key in box) ?? refuseObject(box, name);
}

/** @internal Whether a box is an array of numbers. */
export function isRow(box: unknown): box is ArrayLike<unknown> {
  return Array.isArray(box) || tagOf(box) !== undefined;
}

/** @internal How many numbers an array has: a typed array by itself, see typed.ts. */
export function rowLength(row: ArrayLike<unknown>): unknown {
  return Array.isArray(row) ? row.length : lengthOf(row);
}

function fromObjects(boxes: readonly unknown[], dimensions: Dimensions, name: string): Float64Array {
  const width = 2 * dimensions;
  const count = checkedLength(boxes, name);
  const rows = allocate(() => new Float64Array(width * count));
  for (let index = 0; index < count; index++) {
    const box = boxes[index];
    if (isNamed(box)) {
      readBox(box, dimensions, `${name}[${index}]`, rows, index * width);
      continue;
    }
    if (!isRow(box)) refuseObject(box, `${name}[${index}]`);
    const length = rowLength(box);
    if (length !== width) throw new RangeError(`${name}[${index}] must hold ${width} numbers, not ${describe(length)}`);
    copyNumbers(box, width, `${name}[${index}]`, rows, index * width);
  }
  return rows;
}

/** Throws that a value is not a box. */
function refuseObject(box: unknown, name: string): never {
  const isObject = typeof box === "object" && box !== null;
  throw new TypeError(
    `${name} must be { minX, .. }, { min, max }, { lowerBound, upperBound }, { x, .., width, .. } or a row of numbers, not ` +
      (isObject ? `an object with ${Object.keys(box).slice(0, 6).join(", ") || "no properties"}` : describe(box)),
  );
}

/**
 * A typed array of numbers as one of floats, or `undefined` for another value. By its tag, not by
 * `instanceof`, which is false for arrays of another realm (a frame, a test runner).
 */
function floats(value: unknown): Float32Array | Float64Array | undefined {
  switch (tagOf(value)) {
    case "Float32Array":
    case "Float64Array":
      return value as Float32Array | Float64Array;
    case "Float16Array":
    case "Int8Array":
    case "Uint8Array":
    case "Uint8ClampedArray":
    case "Int16Array":
    case "Uint16Array":
      return new Float32Array(value as Int16Array);
    case "Int32Array":
    case "Uint32Array":
      return new Float64Array(value as Int32Array);
    default:
      return undefined;
  }
}

const { indexOf } = Float64Array.prototype;

/** A detached array looks like an empty one; only its methods throw. */
function refuseDetached(rows: Float32Array | Float64Array, name: string): void {
  try {
    indexOf.call(rows, 0);
  } catch {
    throw new TypeError(`the buffer of ${name} is detached: it was transferred, or its memory grew`);
  }
}
