import { coordinate, type Corner, type Dimensions, isNamed } from "../boxes/boxes.js";
import { describe } from "../wasm/describe.js";
import { checkOptionNames } from "../wasm/options.js";
import { readRow } from "./arguments.js";

/** @internal A length that may be infinite. */
export function checkLength(value: unknown, name: string): number {
  if (typeof value !== "number") throw new TypeError(`\`${name}\` must be a number, not ${describe(value)}`);
  if (!(value >= 0)) throw new RangeError(`\`${name}\` is ${value}; it must be 0 or more`);
  return value;
}

/** @internal A whole number below 2^32. */
export function checkCount(value: unknown, name: string): number {
  if (!(Number.isInteger(value) && (value as number) >= 0 && (value as number) < 2 ** 32)) {
    throw new RangeError(`\`${name}\` is ${describe(value)}; it must be a whole number from 0 to 2^32 - 1`);
  }
  return value as number;
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

const sortOptions = ["sorted"];

/** @internal Whether ids are to be sorted, as the core takes it. */
export function checkSorted(options: unknown): 0 | 1 {
  if (options === undefined) return 1;
  checkOptionNames(options, sortOptions);
  const { sorted = true } = options as { sorted?: unknown };
  if (typeof sorted !== "boolean") throw new TypeError(`\`sorted\` must be true or false, not ${describe(sorted)}`);
  return sorted ? 1 : 0;
}
