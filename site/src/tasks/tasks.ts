// The five tasks: what is asked, the code to begin with, an answer that the checker accepts.

import { readListing } from "../code/listing.ts";
import { SWAP_WORLDS } from "../edit/swap-worlds.ts";

export interface Task {
  readonly name: string;
  readonly title: string;
  readonly asks: string;
  readonly start: string;
  readonly answer: string;
  readonly explains: string;
}

const byCenter = readListing("../edit/by-center").code;

const array = (world: (typeof SWAP_WORLDS)[number]): string =>
  `  // ${world.map(([box, side, at]) => `${side === "(" ? `(${box}` : `${box})`} ${at}`).join("   ")}\n`;

const swaps = (counts: readonly number[]): string =>
  `export const swaps = [\n${SWAP_WORLDS.map((world, at) => `${array(world)}  ${counts[at]},\n`).join("")}];`;

export const TASKS: readonly Task[] = [
  {
    name: "miss",
    title: "Make it miss a pair",
    asks: `The code of task 2 sorts by the center and stops early. Move these three boxes so that two of them overlap and it does not find them.`,
    start: `export const boxes = [
  { left: 0, top: 0, right: 4, bottom: 4 },
  { left: 6, top: 3, right: 10, bottom: 7 },
  { left: 12, top: 0, right: 16, bottom: 4 },
];`,
    answer: `export const boxes = [
  { left: 0, top: 0, right: 4, bottom: 4 },
  { left: 6, top: 6, right: 8, bottom: 8 },
  { left: 3, top: 0, right: 15, bottom: 4 },
];`,
    explains: `The row of A stops at B, which begins after A ends. C has its center behind B, but it reaches back over B to A.`,
  },
  {
    name: "repair",
    title: "Repair the sort by center",
    asks: `This code misses pairs. Repair it, so that it finds each pair once and still stops early.`,
    start: byCenter,
    answer: readListing("sorted-pairwise").code.replace("sortedPairwise", "findPairs"),
    explains: `Sort by the left edge: then every later box begins later still, and the row may stop.`,
  },
  {
    name: "key",
    title: "Break the key",
    asks: `The swap-driven sweep keeps its overlaps under this key. Change it so that a pair stays forever, though its boxes have long been apart.`,
    start: readListing("key").code,
    answer: `export function key(a, b) {\n  return \`\${a.id} \${b.id}\`;\n}`,
    explains: `An overlap that begins as A–B is stored under another key than the one under which B–A is removed.`,
  },
  {
    name: "axis",
    title: "Choose the axis",
    asks: `This rule takes the longest axis of the scene. Write one that takes the axis with fewer tests in each of six levels.`,
    start: `export function chooseAxis(boxes) {
  const width = Math.max(...boxes.map((box) => box.right))
    - Math.min(...boxes.map((box) => box.left));
  const height = Math.max(...boxes.map((box) => box.bottom))
    - Math.min(...boxes.map((box) => box.top));
  return width > height ? "x" : "y";
}`,
    answer: readListing("fewest-overlaps").code.replace("axisOfFewestOverlaps", "chooseAxis"),
    explains: `Count the overlaps on each axis. Neither the extent nor the variance can tell two towers from a floor.`,
  },
  {
    name: "swaps",
    title: "Count the swaps before you look",
    asks: `Each of these arrays was sorted one frame ago; behind each endpoint stands where it is now. How many swaps will insertion sort make?`,
    start: swaps(SWAP_WORLDS.map(() => 0)),
    answer: swaps([1, 3, 7]),
    explains: `One for each pair of endpoints in the wrong order, in whatever order they are repaired.`,
  },
];
