import { lengthOf, tagOf } from "../wasm/typed.js";

type Rows = Float32Array | Float64Array;

/** The boxes without those that have a NaN or are empty, and the index of each one that is left; the boxes as they are if all are left. */
export function dropMissing(rows: Rows, dimensions: number): [Rows, Uint32Array | undefined] {
  const width = 2 * dimensions;
  const count = lengthOf(rows) / width;
  const isMissing = (index: number): boolean => {
    for (let at = index * width; at < index * width + dimensions; at++) {
      const [min, max] = [rows[at]!, rows[at + dimensions]!];
      if (Number.isNaN(min) || Number.isNaN(max) || (min === Infinity && max === -Infinity)) return true;
    }
    return false;
  };
  let first = 0;
  while (first < count && !isMissing(first)) first++;
  if (first === count) return [rows, undefined];
  const left = tagOf(rows) === "Float64Array" ? new Float64Array(rows) : new Float32Array(rows);
  const kept = new Uint32Array(count);
  for (let index = 0; index < first; index++) kept[index] = index;
  let to = first;
  for (let index = first + 1; index < count; index++) {
    if (isMissing(index)) continue;
    left.copyWithin(to * width, index * width, (index + 1) * width);
    kept[to++] = index;
  }
  return [left.subarray(0, to * width), kept];
}

/** Replaces the indices of pairs in memory by those that the boxes had before some were dropped. */
export function renamePairs(words: Uint32Array, at: number, count: number, keptA: Uint32Array | undefined, keptB: Uint32Array | undefined): void {
  for (let word = at / 4, end = word + 2 * count; word < end; word += 2) {
    if (keptA) words[word] = keptA[words[word]!]!;
    if (keptB) words[word + 1] = keptB[words[word + 1]!]!;
  }
}
