import { checkNumbers, type Dimensions } from "../boxes/boxes.js";
import { describe } from "../wasm/describe.js";
import { checkOptionNames } from "../wasm/options.js";
import { allocate } from "../wasm/views.js";
import { checkIds, readPoint } from "./arguments.js";
import { defaultFilter, type FilterWords, filterWords } from "./filter.js";
import type { QueryFilter } from "./types.js";

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

/** @internal Numbers that were read, in an array that no code of the user can change: `values` are those that it passed. */
export function own(numbers: Float32Array | Float64Array, values: unknown): Float64Array {
  return Array.isArray(values) && numbers instanceof Float64Array ? numbers : allocate(() => new Float64Array(numbers));
}

/** @internal Points in one array: an array of points, or their numbers one after another. */
export function readPoints(points: unknown, dimensions: Dimensions, name: string): Float64Array {
  if (Array.isArray(points) && typeof points[0] === "object") {
    const read = points.map((point: unknown, at) => readPoint(point, dimensions, `${name}[${at}]`));
    const all = allocate(() => new Float64Array(read.length * dimensions));
    read.forEach((point, at) => all.set(point, at * dimensions));
    return all;
  }
  const numbers = own(checkNumbers(points, name), points);
  if (numbers.length % dimensions === 0) return numbers;
  throw new RangeError(`\`${name}\` holds ${numbers.length} numbers, which is not a multiple of ${dimensions}: a point in ${dimensions}D is as many`);
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

/** @internal No ids. */
export const noIds: Float64Array = new Float64Array(0);
const byDefault: QueryChoices = { isSorted: 1, ignoresTouching: false, excluded: noIds };

/** @internal The options of a query of a kind. */
export function readChoices(options: unknown, kind: "region" | "cast" | "nearest"): QueryChoices {
  if (options === undefined) return byDefault;
  checkOptionNames(options, kind === "region" ? queryOptions : kind === "cast" ? castOptions : excludeOptions);
  const { exclude } = options as { exclude?: unknown };
  return {
    isSorted: readFlag(options as object, "sorted", true) ? 1 : 0,
    ignoresTouching: readFlag(options as object, "ignoreTouching", false),
    excluded: exclude === undefined ? noIds : typeof exclude === "number" ? Float64Array.of(exclude) : checkIds(exclude, "exclude"),
  };
}

function readFlag(options: object, name: string, byDefault: boolean): boolean {
  const value = (options as Record<string, unknown>)[name] ?? byDefault;
  if (typeof value !== "boolean") throw new TypeError(`\`${name}\` must be true or false, not ${describe(value)}`);
  return value;
}

/** @internal What the core takes for no filter: a query without one finds every body. */
const noFilter: FilterWords = [0, 0, 0, 2];

/** @internal The filter of a query as the core takes it: none if it is a function, which is called afterwards. */
export function wordsOf(filter: QueryFilter | undefined): FilterWords {
  return filter == null || typeof filter === "function" ? noFilter : filterWords(filter, defaultFilter);
}
