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
export type Boxes<D extends Dimensions = Dimensions> = TypedNumbers | readonly number[] | readonly BoxObject<D>[];

/**
 * One box in the form of another library: `{ minX, minY, maxX, maxY }` of rbush, with `minZ` and
 * `maxZ` in 3D; `{ min, max }` of the `Box2` and `Box3` of three.js and the bounds of matter;
 * `{ lowerBound, upperBound }` of cannon and planck; `{ x, y, width, height }` of a `DOMRect`, with
 * `z` and `depth` in 3D; `{ x, y, w, h }`; `{ left, top, right, bottom }`; a row of numbers as in
 * box-intersect. Other properties of the object are ignored.
 */
export type BoxObject<D extends Dimensions = Dimensions> =
  | EdgesBox<D>
  | MinMaxBox<D>
  | BoundsBox<D>
  | SizedBox<D>
  | SidesBox<D>
  | readonly number[]
  | TypedNumbers;

/** Properties with values of a type. */
type Of<Keys extends string, Value> = { readonly [Key in Keys]: Value };

/** No such properties. */
type Without<Keys extends string> = { readonly [Key in Keys]?: undefined };

/** A box by its edges, as in rbush: `minX` and `maxX`, in 2D and 3D `minY` and `maxY`, in 3D `minZ` and `maxZ`. */
export type EdgesBox<D extends Dimensions = Dimensions> = D extends 1
  ? Of<"minX" | "maxX", number> & Without<"minY" | "maxY" | "minZ" | "maxZ">
  : D extends 2
    ? Of<"minX" | "minY" | "maxX" | "maxY", number> & Without<"minZ" | "maxZ">
    : Of<"minX" | "minY" | "minZ" | "maxX" | "maxY" | "maxZ", number>;

/** A box by its corners `min` and `max`, as in three.js and matter. */
export type MinMaxBox<D extends Dimensions = Dimensions> = D extends Dimensions ? Of<"min" | "max", Corner<D>> : never;

/** A box by its corners `lowerBound` and `upperBound`, as in cannon and planck. */
export type BoundsBox<D extends Dimensions = Dimensions> = D extends Dimensions ? Of<"lowerBound" | "upperBound", Corner<D>> : never;

/**
 * A box by a corner and its size, as a `DOMRect`. The other corner is their sum in double precision. A negative size
 * reaches to the other side, as of a rectangle that is drawn to the upper left.
 */
export type SizedBox<D extends Dimensions = Dimensions> = D extends 1
  ? (Of<"x" | "width", number> & Without<"y" | "height" | "depth">) | (Of<"x" | "w", number> & Without<"y" | "h" | "d">)
  : D extends 2
    ? Of<"x" | "y" | "width" | "height", number> | Of<"x" | "y" | "w" | "h", number>
    : Of<"x" | "y" | "z" | "width" | "height" | "depth", number> | Of<"x" | "y" | "z" | "w" | "h" | "d", number>;

/** A box by its sides, in 1D and 2D. Either of `top` and `bottom` may be the smaller one, and of `left` and `right`. */
export type SidesBox<D extends Dimensions = Dimensions> = D extends 1
  ? Of<"left" | "right", number> & Without<"top" | "bottom">
  : D extends 2
    ? Of<"left" | "top" | "right" | "bottom", number>
    : never;

/** A point, or a corner of a box: as many coordinates as there are dimensions. */
export type Corner<D extends Dimensions = Dimensions> = D extends 1 ? Corner1D : D extends 2 ? Corner2D : Corner3D;

/** A point in 1D. */
export interface Corner1D {
  /** Its coordinate. */
  readonly x: number;
  /** There is none. */
  readonly y?: undefined;
  /** There is none. */
  readonly z?: undefined;
}

/** A point in 2D. */
export interface Corner2D {
  /** The first coordinate. */
  readonly x: number;
  /** The second. */
  readonly y: number;
  /** There is none. */
  readonly z?: undefined;
}

/** A point in 3D. */
export interface Corner3D {
  /** The first coordinate. */
  readonly x: number;
  /** The second. */
  readonly y: number;
  /** The third. */
  readonly z: number;
}

/** @internal The dimensions, checked. */
export function checkDimensions(dimensions: unknown): Dimensions {
  if (dimensions === 1 || dimensions === 2 || dimensions === 3) return dimensions;
  throw new RangeError(`\`dimensions\` must be 1, 2 or 3, not ${describe(dimensions)}`);
}

/** @internal The boxes as a typed array of whole rows. Their coordinates are not checked. */
export function checkBoxes(boxes: unknown, dimensions: Dimensions, name = "boxes"): Float32Array | Float64Array {
  if (Array.isArray(boxes) && typeof boxes[0] === "object") return fromObjects(boxes, dimensions, name, true);
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
  if (!numbers) refuseNumbers(values, name);
  if (lengthOf(numbers) === 0) refuseDetached(numbers, name);
  return numbers;
}

/** Throws that a value is no array, and what to do if it is one box. */
function refuseNumbers(values: unknown, name: string): never {
  const isBox = isNamed(values) && ["min", "lowerBound", "minX", "width", "left", "w"].some((key) => key in values);
  const hint = isBox ? `: one box is written [box]` : "";
  throw new TypeError(`\`${name}\` must be a typed array of numbers or a plain array, not ${describe(values)}${hint}`);
}

/** @internal Whether a value is a box or a point as an object with named coordinates. */
export function isNamed(value: unknown): value is object {
  return typeof value === "object" && value !== null && !isRow(value);
}

/**
 * @internal Writes the corners of a box that is an object, from `at`. They are not checked, apart from their type. `index` is
 * that of the box if `name` is an array. Axes that it has beside are not looked at.
 */
export function readBox(box: object, dimensions: Dimensions, name: string, into: Float64Array, at: number, index: number): Form {
  const form = formOf(box, name, index);
  // A sprite has a class; of plain objects, which are alike, the first is looked at.
  if (form === rectangle && (index <= 0 || box.constructor !== Object)) refuseOrigin(box, name, index);
  for (const corner of [0, 1] as const) {
    for (let axis = 0; axis < dimensions; axis++, at++) {
      const value = form.read(box, corner, axis);
      if (typeof value !== "number") {
        throw new TypeError(`${nameOf(form, corner, axis, box)} of ${labelOf(name, index)} must be a number, not ${describe(value)}`);
      }
      into[at] = value;
    }
  }
  return form;
}

/** Throws for a sprite, which has its origin (Phaser), anchor or pivot (Pixi) at its `x` and `y`, and may be rotated. */
function refuseOrigin(box: object, name: string, index: number): void {
  const { originX, originY, anchor } = box as { originX?: unknown; originY?: unknown; anchor?: Corner | null };
  if (originX || originY || anchor?.x || anchor?.y || ("getBounds" in box && "rotation" in box)) throw new TypeError(`${labelOf(name, index)} does not begin at its position: pass its \`getBounds()\``);
}

/** Throws if a box has other axes than those before it. */
function checkAxes(box: unknown, dimensions: Dimensions, name: string, index: number): void {
  const axes = axesOf(box, name, index);
  if (axes !== dimensions) throw new TypeError(`${labelOf(name, index)} is in ${axes}D and others in ${dimensions}D; all boxes of a search have the same dimensions`);
}

/** What a box is called in errors: `index` is negative if `name` is no array. */
function labelOf(name: string, index: number): string {
  return index < 0 ? `\`${name}\`` : `${name}[${index}]`;
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
  /** The property that gives corner 0 or 1, or the size instead of corner 1; undefined if the form has no such axis. */
  name(corner: 0 | 1, axis: number): string | undefined;
  /** What that property holds. */
  given(box: object, corner: 0 | 1, axis: number): unknown;
  /** A coordinate of corner 0 or 1; the caller checks that it is a number. */
  read(box: object, corner: 0 | 1, axis: number): unknown;
}

/** @internal Each property by its name, which engines read several times faster than by a computed one. */
export function coordinate(corner: Corner | null | undefined, axis: number): unknown {
  return axis === 0 ? corner?.x : axis === 1 ? corner?.y : corner?.z;
}

/** A form that names its corners. */
function corners(min: string, max: string, read: Form["read"]): Form {
  return { name: (corner, axis) => `${corner ? max : min}.${"xyz"[axis]}`, given: read, read };
}

const minMax = corners("min", "max", (box, corner, axis) => coordinate(corner ? (box as MinMaxBox).max : (box as MinMaxBox).min, axis));

const bounds = corners("lowerBound", "upperBound", (box, corner, axis) => coordinate(corner ? (box as BoundsBox).upperBound : (box as BoundsBox).lowerBound, axis));

const readEdges: Form["read"] = (box, corner, axis) => {
  const { minX, minY, minZ, maxX, maxY, maxZ } = box as EdgesBox;
  return axis === 0 ? (corner ? maxX : minX) : axis === 1 ? (corner ? maxY : minY) : corner ? maxZ : minZ;
};

const edges: Form = {
  name: (corner, axis) => `${corner ? "max" : "min"}${"XYZ"[axis]}`,
  given: readEdges,
  read: readEdges,
};

/** A coordinate of a rectangle: a negative size reaches to the other side. */
function side(from: unknown, size: unknown, corner: 0 | 1): unknown {
  if (typeof from !== "number" || typeof size !== "number") return corner ? size : from;
  const isOther = (corner === 0) === size < 0;
  return isOther ? from + size : from;
}

const rectangle: Form = {
  name: (corner, axis) => (corner ? ["width", "height", "depth"] : "xyz")[axis],
  given: (box, corner, axis) => (corner ? extent(box as Rectangle, axis) : coordinate(box as Corner, axis)),
  read: (box, corner, axis) => side(coordinate(box as Corner, axis), extent(box as Rectangle, axis), corner),
};

interface Rectangle {
  readonly width?: unknown;
  readonly height?: unknown;
  readonly depth?: unknown;
}

function extent(box: Rectangle, axis: number): unknown {
  return axis === 0 ? box.width : axis === 1 ? box.height : box.depth;
}

const shortRectangle: Form = {
  name: (corner, axis) => (corner ? "whd" : "xyz")[axis],
  given: (box, corner, axis) => (corner ? shortExtent(box as ShortRectangle, axis) : coordinate(box as Corner, axis)),
  read: (box, corner, axis) => side(coordinate(box as Corner, axis), shortExtent(box as ShortRectangle, axis), corner),
};

interface ShortRectangle {
  readonly w?: unknown;
  readonly h?: unknown;
  readonly d?: unknown;
}

function shortExtent(box: ShortRectangle, axis: number): unknown {
  return axis === 0 ? box.w : axis === 1 ? box.h : box.d;
}

const readSides: Form["read"] = (box, corner, axis) => {
  const { left, top, right, bottom } = box as SidesBox;
  return axis === 0 ? (corner ? right : left) : axis === 1 ? (corner ? bottom : top) : undefined;
};

const sides: Form = {
  name: (corner, axis) => [["left", "right"], ["top", "bottom"]][axis]?.[corner],
  given: readSides,
  read(box, corner, axis) {
    const [from, to] = [readSides(box, 0, axis), readSides(box, 1, axis)];
    // Infinity to -Infinity are the bounds of nothing, as people accumulate them.
    const isFlipped = typeof from === "number" && typeof to === "number" && from > to && (from < Infinity || to > -Infinity);
    return corner === 1 !== isFlipped ? to : from;
  },
};

/** The property that gives a coordinate: of a rectangle the one that is missing. */
function nameOf(form: Form, corner: 0 | 1, axis: number, box: object): string {
  const at = typeof form.given(box, 0, axis) !== "number" ? 0 : corner;
  return form.name(at, axis) ?? `the ${corner ? "max" : "min"} ${"xyz"[axis]}`;
}

/**
 * @internal How many axes a box has that is an object or a row: those of which it has both corners.
 *
 * @throws `TypeError` if it has half of an axis.
 */
export function axesOf(box: unknown, set: string, index: number): Dimensions {
  const name = labelOf(set, index);
  if (isRow(box)) {
    const length = rowLength(box);
    if (length === 2 || length === 4 || length === 6) return (length / 2) as Dimensions;
    throw new RangeError(`${name} has ${describe(length)} numbers; a box has 2 in 1D, 4 in 2D and 6 in 3D`);
  }
  if (!isNamed(box)) return refuseObject(box, name);
  const form = formOf(box, set, index);
  let axes = 0;
  for (const axis of [0, 1, 2]) {
    const [low, high] = [form.given(box, 0, axis) !== undefined, form.given(box, 1, axis) !== undefined];
    // A sprite may have a `z` that is no coordinate.
    if (!high && (!low || ((form === rectangle || form === shortRectangle) && axis === 2))) continue;
    if (!low || !high) throw new TypeError(`${name} has \`${form.name(high ? 1 : 0, axis)}\` but no \`${form.name(high ? 0 : 1, axis)}\``);
    if (axis > axes) throw new TypeError(`${name} has \`${form.name(0, axis)}\` but no \`${form.name(0, axes)}\``);
    axes++;
  }
  return (axes || 1) as Dimensions; // without any, reading it says what is missing
}

/** The form of a box that is an object. */
function formOf(box: object, name: string, index: number): Form {
  if ("min" in box) return minMax;
  if ("lowerBound" in box) return bounds;
  if ("minX" in box) return edges;
  if ("width" in box && ("x" in box || !("left" in box))) return rectangle;
  if ("left" in box) return sides;
  if ("w" in box) return shortRectangle;
  return refuseObject(box, labelOf(name, index));
}

/** @internal Whether a box is an array of numbers. */
export function isRow(box: unknown): box is ArrayLike<unknown> {
  return Array.isArray(box) || tagOf(box) !== undefined;
}

/** @internal How many numbers an array has: a typed array by itself, see typed.ts. */
export function rowLength(row: ArrayLike<unknown>): unknown {
  return Array.isArray(row) ? row.length : lengthOf(row);
}

/** @internal Boxes that are objects or rows, each with exactly these axes, as rows. */
export function readAlike(boxes: readonly unknown[], dimensions: Dimensions, name: string): Float64Array {
  return fromObjects(boxes, dimensions, name, false);
}

/** `areAlone` boxes may have more axes: they are not looked at. */
function fromObjects(boxes: readonly unknown[], dimensions: Dimensions, name: string, areAlone: boolean): Float64Array {
  const width = 2 * dimensions;
  const count = checkedLength(boxes, name);
  const rows = allocate(() => new Float64Array(width * count));
  for (let index = 0; index < count; index++) {
    const box = boxes[index];
    if (isNamed(box)) {
      const form = readBox(box, dimensions, name, rows, index * width, index);
      if (!areAlone && dimensions < 3 && (form.given(box, 1, dimensions) !== undefined || form.given(box, 0, dimensions) !== undefined)) {
        checkAxes(box, dimensions, name, index);
      }
      continue;
    }
    if (!isRow(box)) refuseObject(box, labelOf(name, index));
    const length = rowLength(box);
    if (length !== width) {
      if (!areAlone) checkAxes(box, dimensions, name, index);
      throw new RangeError(`${labelOf(name, index)} must hold ${width} numbers, not ${describe(length)}`);
    }
    copyNumbers(box, width, labelOf(name, index), rows, index * width);
  }
  return rows;
}

/** Throws that a value is not a box. */
function refuseObject(box: unknown, name: string): never {
  const isObject = typeof box === "object" && box !== null;
  throw new TypeError(
    `${name} must be { minX, .. }, { min, max }, { lowerBound, upperBound }, { x, .., width, .. }, { left, .. } or a row of numbers, not ` +
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
