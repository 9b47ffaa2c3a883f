/** 1, 2 or 3. */
export type Dimensions = 1 | 2 | 3;

/**
 * Boxes, one row after another: the least corner and then the greatest, so
 * `minX, minY, maxX, maxY` in 2D.
 *
 * Coordinates are compared exactly as given: `Float32Array` in single, `Float64Array` in double
 * precision. A plain array of numbers is the slower door: each number is checked and copied to a
 * `Float64Array` at each call.
 */
export type Boxes = Float32Array | Float64Array | readonly number[];

/** @internal The dimensions, checked. */
export function checkDimensions(dimensions: unknown): Dimensions {
  if (dimensions === 1 || dimensions === 2 || dimensions === 3) return dimensions;
  throw new RangeError(`dimensions must be 1, 2 or 3, not ${String(dimensions)}`);
}

/** @internal The boxes as a typed array of whole rows. Their coordinates are not looked at. */
export function checkBoxes(boxes: unknown, dimensions: Dimensions, name = "boxes"): Float32Array | Float64Array {
  const rows = checkNumbers(boxes, name);
  const width = 2 * dimensions;
  if (rows.length % width !== 0) {
    throw new RangeError(
      `${name} holds ${rows.length} numbers, which is not a multiple of ${width}: ` +
        `a box in ${dimensions}D is ${dimensions} of its least and ${dimensions} of its greatest corner`,
    );
  }
  return rows;
}

/** @internal Numbers as a typed array. */
export function checkNumbers(values: unknown, name: string): Float32Array | Float64Array {
  const numbers = Array.isArray(values) ? fromNumbers(values, name) : values;
  if (!isFloatArray(numbers)) {
    throw new TypeError(`${name} must be a Float32Array, a Float64Array or an array of numbers, not ${describe(values)}`);
  }
  if (numbers.length === 0) refuseDetached(numbers, name);
  return numbers;
}

/**
 * @internal Writes rows of boxes to memory that has at least as many dimensions; the boxes are flat
 * on those that are added.
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

/** By its tag, not by `instanceof`: arrays of another realm (a frame, a test runner) are as good. */
function isFloatArray(value: unknown): value is Float32Array | Float64Array {
  if (!ArrayBuffer.isView(value)) return false;
  const tag = (value as Float32Array)[Symbol.toStringTag] as string;
  return tag === "Float32Array" || tag === "Float64Array";
}

/** A detached array looks like an empty one; only its methods tell. */
function refuseDetached(rows: Float32Array | Float64Array, name: string): void {
  try {
    rows.indexOf(0);
  } catch {
    throw new TypeError(`the buffer of ${name} is detached: it was transferred, or its memory has grown`);
  }
}

function describe(value: unknown): string {
  if (value === null || typeof value !== "object") return typeof value === "string" ? "a string" : String(value);
  return `a ${value.constructor?.name ?? "object"}`;
}
