import { checkNumbers, coordinate, copyNumbers, type Corner, type Dimensions, isNamed, readBox, rowLength } from "../boxes/boxes.js";
import { describe } from "../wasm/describe.js";
import { tagOf } from "../wasm/typed.js";

/** @internal An id, which may be stale. Only a number: `valueOf` of an object could free the world. */
export function checkId(id: unknown): number {
  if (typeof id !== "number") throw new TypeError(`\`id\` must be a number, not ${describe(id)}`);
  return id;
}

/** @internal Ids as a typed array, which may be stale. */
export function checkIds(ids: unknown, name = "ids"): Float32Array | Float64Array {
  const tag = tagOf(ids);
  if (tag === "Float32Array" || tag === "Float16Array") {
    throw new TypeError(`\`${name}\` must not be a ${tag}, which rounds ids above 2^24 to those of other bodies; use a Float64Array`);
  }
  return checkNumbers(ids, name);
}

const names = [
  ["minX", "maxX"],
  ["minX", "minY", "maxX", "maxY"],
  ["minX", "minY", "minZ", "maxX", "maxY", "maxZ"],
];

/** @internal Throws what is wrong with the corners of a box, given as separate numbers. */
export function refuseCorners(dimensions: number, corners: readonly unknown[]): never {
  const expected = names[dimensions - 1]!;
  const form = `a box in ${dimensions}D is ${expected.length} numbers: ${expected.join(", ")}`;
  const wrong = expected.findIndex((_, at) => typeof corners[at] !== "number");
  if (wrong < 0) throw new TypeError(`there are more arguments than ${expected.at(-1)}; ${form}`);
  throw new TypeError(`\`${expected[wrong]}\` must be a number, not ${describe(corners[wrong])}; ${form}`);
}

/** @internal The corners of a box, copied: while other arguments are read, it may change. */
export function readCorners(box: unknown, dimensions: Dimensions, name: string): Float64Array {
  if (!isNamed(box)) return readRow(box, dimensions, 2, name);
  const numbers = new Float64Array(2 * dimensions);
  readBox(box, dimensions, name, numbers, 0, -1);
  return numbers;
}

/** @internal The numbers of one or two corners in an array, copied. */
export function readRow(values: unknown, dimensions: Dimensions, corners: 1 | 2, name: string): Float64Array {
  const numbers = new Float64Array(corners * dimensions);
  const given: ArrayLike<unknown> = Array.isArray(values) ? (values as unknown[]) : checkNumbers(values, name);
  const length = rowLength(given);
  if (length !== corners * dimensions) {
    throw new RangeError(`\`${name}\` has ${describe(length)} numbers; in ${dimensions}D it must have ${corners * dimensions}`);
  }
  copyNumbers(given, length, name, numbers, 0);
  return numbers;
}

/** @internal A point: an array, or an object `{ x, y, z }`, with as many coordinates as there are dimensions. */
export function readPoint(point: unknown, dimensions: Dimensions, name: string): Float64Array {
  if (!isNamed(point)) return readRow(point, dimensions, 1, name);
  const numbers = new Float64Array(dimensions);
  for (let axis = 0; axis < dimensions; axis++) {
    const value = coordinate(point as Corner, axis);
    if (typeof value !== "number") throw new TypeError(`\`${name}.${"xyz"[axis]}\` must be a number, not ${describe(value)}`);
    numbers[axis] = value;
  }
  return numbers;
}

/** @internal Throws unless all numbers are as the rule says. */
export function checkRule(numbers: Float64Array, name: string, rule: "finite" | "a number"): Float64Array {
  for (let at = 0; at < numbers.length; at++) {
    const x = numbers[at]!;
    if (rule === "finite" ? !Number.isFinite(x) : Number.isNaN(x)) throw new RangeError(`\`${name}[${at}]\` is ${x}; it must be ${rule}`);
  }
  return numbers;
}
