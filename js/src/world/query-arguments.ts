import { coordinate, type Corner, type Dimensions, isNamed } from "../boxes/boxes.js";
import { describe } from "../wasm/describe.js";
import { checkOptionNames } from "../wasm/options.js";
import { checkIds, readRow } from "./arguments.js";

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
const queryOptions = ["sorted", "exclude"];
const castOptions = ["exclude", "ignoreTouching"];
const excludeOptions = ["exclude"];

/** @internal Whether ids are to be sorted, as the core takes it. */
export function checkSorted(options: unknown): 0 | 1 {
  if (options === undefined) return 1;
  checkOptionNames(options, sortOptions);
  return readFlag(options as object, "sorted", true) ? 1 : 0;
}

/** @internal What a query leaves out and how it sorts, checked. */
export interface QueryChoices {
  readonly isSorted: 0 | 1;
  readonly ignoresTouching: boolean;
  readonly excluded: Float32Array | Float64Array;
}

const none = new Float64Array(0);
const byDefault: QueryChoices = { isSorted: 1, ignoresTouching: false, excluded: none };

/** @internal The options of a query of a kind. */
export function readChoices(options: unknown, kind: "region" | "cast" | "nearest"): QueryChoices {
  if (options === undefined) return byDefault;
  checkOptionNames(options, kind === "region" ? queryOptions : kind === "cast" ? castOptions : excludeOptions);
  const { exclude } = options as { exclude?: unknown };
  return {
    isSorted: readFlag(options as object, "sorted", true) ? 1 : 0,
    ignoresTouching: readFlag(options as object, "ignoreTouching", false),
    excluded: exclude === undefined ? none : typeof exclude === "number" ? Float64Array.of(exclude) : checkIds(exclude, "exclude"),
  };
}

function readFlag(options: object, name: string, byDefault: boolean): boolean {
  const value = (options as Record<string, unknown>)[name] ?? byDefault;
  if (typeof value !== "boolean") throw new TypeError(`\`${name}\` must be true or false, not ${describe(value)}`);
  return value;
}
