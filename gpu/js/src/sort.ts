import { type Bound, type Steps, THREADS } from "./steps.js";

/** The numbers that a workgroup of `wgsl/scan.wgsl` sums. */
const BLOCK = 16 * THREADS;

/** The keys of a workgroup of `wgsl/sort_count.wgsl` and `wgsl/sort_scatter.wgsl`. */
const TILE = 16 * THREADS;

/** The values of a digit, and its bits. */
const DIGITS = 16;
const DIGIT_BITS = 4;

/** How many numbers the table of a sort has. */
export const tableLength = (keys: number): number => DIGITS * Math.ceil(keys / TILE);

/** How many numbers the sums of each level of a scan have. */
export function scanLevels(count: number): number[] {
  return Array.from({ length: 4 }, () => (count = Math.max(1, Math.ceil(count / BLOCK))));
}

/** Replaces each of `count` numbers by the sum of those before it. `sums` has {@link scanLevels} numbers. */
export function scan(steps: Steps, numbers: Bound, count: number, sums: readonly Bound[]): void {
  const blocks = Math.ceil(count / BLOCK);
  const [blockSums, ...above] = sums as [Bound, ...Bound[]];
  steps.add("scan", [count, blocks], [numbers, blockSums], blocks);
  if (blocks > 1) {
    scan(steps, blockSums, blocks, above);
    steps.forEach("scan_add", count, [count], [numbers, blockSums]);
  }
}

/** Two arrays that a pass of the sort reads and writes in turn. */
export interface Swapped {
  now: Bound;
  other: Bound;
}

/** What a sort needs beside the keys: {@link tableLength} numbers, and the sums of a scan of that many. */
export interface SortSpace {
  readonly table: Bound;
  readonly sums: readonly Bound[];
}

/**
 * Sorts `count` keys by their lowest `bits` bits, and the values beside them. Equal keys keep their order. Afterwards `now`
 * of both is the sorted array.
 */
export function sort(steps: Steps, { table, sums }: SortSpace, keys: Swapped, values: Swapped | undefined, count: number, bits: number): void {
  const tiles = Math.ceil(count / TILE);
  for (let shift = 0; shift < bits; shift += DIGIT_BITS) {
    const params = [count, tiles, shift];
    steps.add("count_digits", params, [keys.now, table], tiles);
    scan(steps, table, tableLength(count), sums);
    if (values) {
      steps.add("scatter_values", params, [table, keys.now, keys.other, values.now, values.other], tiles);
      swap(values);
    } else {
      steps.add("scatter_keys", params, [table, keys.now, keys.other], tiles);
    }
    swap(keys);
  }
}

function swap(arrays: Swapped): void {
  [arrays.now, arrays.other] = [arrays.other, arrays.now];
}
