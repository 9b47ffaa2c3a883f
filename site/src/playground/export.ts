// A world as it stands, written down: every coordinate in the fewest digits that give the same bits.

import type { RunnerOptions, WorldOptions } from "../experiment/experiment.ts";
import { formatCount } from "../panel/counters.ts";

/** What is written down. */
export interface Snapshot {
  readonly world: WorldOptions;
  readonly method: RunnerOptions;
  readonly step: number;
  /** Rows of min corner and max corner. */
  readonly boxes: Float32Array;
  readonly pairs: number;
  /** Where the world can be seen. */
  readonly address: string;
}

export type Format = "js" | "rs" | "py" | "json" | "csv";

interface Language {
  /** The media type. */
  readonly type: string;
  /** The name of the file. */
  readonly file: string;
  head(snapshot: Snapshot): string;
  row(corners: readonly string[], dimensions: number): string;
  /** Between two rows, if anything. */
  readonly comma?: string;
  tail(snapshot: Snapshot): string;
}

const what = ({ world, step, pairs }: Snapshot): string =>
  `${formatCount(world.boxes)} boxes of ${world.own ? "your own" : `the scene "${world.scene}"`}, seed ${world.seed}, step ${step}: ${formatCount(pairs)} pairs.`;

export const FORMATS: Readonly<Record<Format, Language>> = {
  js: {
    type: "text/javascript",
    file: "boxes.mjs",
    head: (snapshot) => `// ${what(snapshot)}
// npm install sweep-and-prune
import { findPairs, init } from "sweep-and-prune";

// Each row is a box: its min corner, then its max corner.
const boxes = new Float32Array([
`,
    row: (corners) => `  ${corners.join(", ")},`,
    tail: ({ world, pairs }) => `
]);

await init();
const pairs = findPairs(boxes, { dimensions: ${world.dimensions} }); // a0, b0, a1, b1, ...
console.log(pairs.length / 2); // ${pairs}
`,
  },
  rs: {
    type: "text/x-rust",
    file: "boxes.rs",
    head: (snapshot) => `// ${what(snapshot)}
// cargo add sweep-and-prune
use sweep_and_prune::{Aabb, Error, find_pairs};

fn main() -> Result<(), Error> {
    let boxes: Vec<Aabb<${snapshot.world.dimensions}>> =
        BOXES.iter().map(|&(min, max)| Aabb::new(min, max)).collect();
    let pairs = find_pairs(&boxes)?;
    println!("{}", pairs.len()); // ${snapshot.pairs}
    Ok(())
}

/// The min corner and the max corner of each box.
#[rustfmt::skip]
#[allow(clippy::excessive_precision, clippy::approx_constant)]
static BOXES: [([f32; ${snapshot.world.dimensions}], [f32; ${snapshot.world.dimensions}]); ${snapshot.world.boxes}] = [
`,
    row: (corners, dimensions) => {
      const floats = corners.map((text) => (/[.e]/.test(text) ? text : `${text}.0`));
      return `    ([${floats.slice(0, dimensions).join(", ")}], [${floats.slice(dimensions).join(", ")}]),`;
    },
    tail: () => "\n];\n",
  },
  py: {
    type: "text/x-python",
    file: "boxes.py",
    head: (snapshot) => `# ${what(snapshot)}
# pip install sweep-and-prune
import numpy as np
import sweep_and_prune as sap

# Each row is a box: its min corner, then its max corner.
boxes = np.array([
`,
    row: (corners) => `    [${corners.join(", ")}],`,
    tail: ({ pairs }) => `
], dtype=np.float32)

pairs = sap.find_pairs(boxes)  # one row per pair, smaller index first
print(len(pairs))  # ${pairs}
`,
  },
  json: {
    type: "application/json",
    file: "boxes.json",
    head: ({ world, method, step, pairs, address }) => {
      const { dimensions, scene, motion, seed, size, spread, own } = world;
      const whose = own ? { motion, seed } : { scene, motion, seed, size, spread };
      const about = JSON.stringify({ ...(address && { address }), dimensions, ...whose, ...method, step, pairs, count: world.boxes }, null, 2);
      return `${about.slice(0, -2)},\n  "boxes": [\n`;
    },
    row: (corners) => `    [${corners.join(", ")}]`,
    comma: ",",
    tail: () => "\n  ]\n}\n",
  },
  csv: {
    type: "text/csv",
    file: "boxes.csv",
    head: ({ world }) => `${["min", "max"].flatMap((end) => ["x", "y", "z"].slice(0, world.dimensions).map((axis) => `${end}_${axis}`)).join(",")}\n`,
    row: (corners) => corners.join(","),
    tail: () => "\n",
  },
};

/** Rows written before the page gets a chance to do something else. */
const AT_ONCE = 250;

/** All of it. */
export async function write(snapshot: Snapshot, format: Format): Promise<string> {
  const language = FORMATS[format];
  const rows: string[] = [];
  for (let box = 0; box < snapshot.world.boxes; box++) {
    if (box % AT_ONCE === AT_ONCE - 1) await new Promise((resolve) => setTimeout(resolve));
    rows.push(row(snapshot, language, box));
  }
  return assembled(snapshot, language, rows);
}

/** The beginning and the end of it. */
export function preview(snapshot: Snapshot, format: Format): string {
  const language = FORMATS[format];
  const shown = Math.min(snapshot.world.boxes, 3);
  const rows = Array.from({ length: shown }, (_, box) => row(snapshot, language, box));
  if (shown < snapshot.world.boxes) rows.push(`${format === "js" ? "  " : "    "}... ${formatCount(snapshot.world.boxes - shown)} more`);
  return assembled(snapshot, language, rows);
}

const assembled = (snapshot: Snapshot, { head, comma = "", tail }: Language, rows: readonly string[]): string => head(snapshot) + rows.join(`${comma}\n`) + tail(snapshot);

function row({ boxes, world }: Snapshot, language: Language, box: number): string {
  const length = 2 * world.dimensions;
  const corners = Array.from(boxes.subarray(box * length, (box + 1) * length), shortest);
  return language.row(corners, world.dimensions);
}

/** The fewest digits that are read back as the same single-precision number. */
export function shortest(value: number): string {
  if (Object.is(value, -0)) return "-0.0";
  for (let digits = 6; digits < 9; digits++) {
    const text = String(Number(value.toPrecision(digits)));
    if (Math.fround(Number(text)) === value) return text;
  }
  return String(Number(value.toPrecision(9)));
}
