// The sweep of a column as the kernels of the library do it, step by step: each step loads one vector of each array. The columns
// are those of a real search, recorded by core/src/pairs/columns_record.rs.

import type { Box } from "../box.ts";

type Column = readonly Box[];

/** The columns of the record. */
export function columnsOf(record: string): readonly Column[] {
  const columns: Box[][] = [];
  for (const line of record.trim().split("\n")) {
    const [left = 0, right = 0, top = 0, bottom = 0, id = 0] = line.split(" ").map(Number);
    if (line.startsWith("column")) columns.push([]);
    else if (!line.startsWith("pair")) columns.at(-1)!.push({ left, right, top, bottom, id });
  }
  return columns;
}

/** The numbers of a cache line of 64 bytes. */
export const LINE = 16;

/** One vector of each array, compared with one box. */
export interface Step {
  /** The position of the box whose partners are looked for. */
  readonly probe: number;
  /** The position of the first lane. */
  readonly from: number;
  /** Of each lane, what the three comparisons say; behind the last box nothing holds. */
  readonly lanes: readonly { readonly begun: boolean; readonly above: boolean; readonly below: boolean }[];
  /** The positions that overlap. */
  readonly hits: readonly number[];
}

/** All steps of the sweep of a column with vectors of this many lanes. */
export function stepsOf(column: Column, width: number): Step[] {
  const steps: Step[] = [];
  for (const [probe, a] of column.entries()) {
    for (let from = probe + 1; ; from += width) {
      const lanes = Array.from({ length: width }, (_, lane) => {
        const b = column[from + lane];
        return { begun: b !== undefined && b.left <= a.right, above: b !== undefined && b.top <= a.bottom, below: b !== undefined && a.top <= b.bottom };
      });
      const hits = lanes.flatMap(({ begun, above, below }, lane) => (begun && above && below ? [from + lane] : []));
      steps.push({ probe, from, lanes, hits });
      // They are sorted: if the last lane has begun, there may be more.
      if (!lanes.at(-1)!.begun) break;
    }
  }
  return steps;
}
