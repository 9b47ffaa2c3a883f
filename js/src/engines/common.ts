import { describe } from "../wasm/describe.js";

/** The error for an argument that is not the engine's object: what it is, and what it must be. */
export function wrongArgument(name: string, value: unknown, must: string): TypeError {
  return new TypeError(`\`${name}\` is ${describe(value)}; it must be ${must}`);
}

/** Whether a value has these methods. */
export function hasMethods(value: unknown, ...names: readonly string[]): boolean {
  const object = Object(value) as Record<string, unknown>;
  return names.every((name) => typeof object[name] === "function");
}

/** Pairs of indices below `count`, sorted by the first index and then by the second. */
export function* sortedPairs(pairs: Uint32Array, count: number): Generator<readonly [number, number]> {
  // As one number each: numbers are sorted much faster than pairs.
  const keys = new Float64Array(pairs.length / 2);
  for (let at = 0; at < keys.length; at++) keys[at] = pairs[2 * at]! * count + pairs[2 * at + 1]!;
  for (const key of keys.sort()) yield [Math.floor(key / count), key % count];
}

/** An array for boxes of `width` numbers each. It is kept, and replaced by a larger one where that is needed. */
export class Rows {
  #rows = new Float64Array(0);

  constructor(readonly width: number) {}

  /** The array for this many boxes. What it held before may still be in it. */
  for(count: number): Float64Array {
    const length = this.width * count;
    if (this.#rows.length < length) this.#rows = new Float64Array(2 * length);
    return this.#rows.subarray(0, length);
  }
}
