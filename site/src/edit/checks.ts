// Whether a task is solved: the reader's code runs here, in the worker of the sandbox, and is compared with brute force.

import { compile as swapDriven } from "virtual:listing/swap-driven";
import { findPairs as byCenter } from "./by-center.js";
import type { Box } from "../box.ts";
import type { Compile, Endpoint, Exports } from "./harness.ts";
import { helpers } from "./helpers.ts";
import { insertionSort } from "../listings/insertion-sort.js";
import { randomFrom } from "../random.ts";
import { SWAP_WORLDS } from "./swap-worlds.ts";

const { key, overlaps, precedes } = helpers;
/** No demo is told which line is at work. */
const $line = <F>(_: number, report: F): F => report;

export interface Verdict {
  readonly isSolved: boolean;
  readonly says: string;
  /** The world in which that shows, and the pair that it is about. */
  readonly boxes?: readonly Box[];
  readonly pair?: Pair | undefined;
}

type Pair = readonly [Box, Box];
type Find = (boxes: Box[], onPair: (a: Box, b: Box) => void) => void;

/** Without what a reader's code has added: not all of it could be sent to the page. */
const plain = ({ id, left, top, right, bottom }: Box): Box => ({ id, left, top, right, bottom });
const letter = ({ id }: Box): string => String.fromCharCode(65 + id);
const both = ([a, b]: Pair): string => (a.id < b.id ? `${letter(a)} and ${letter(b)}` : `${letter(b)} and ${letter(a)}`);
const overlapOnX = (a: Box, b: Box): boolean => a.left <= b.right && a.right >= b.left;
const overlapOnY = (a: Box, b: Box): boolean => a.top <= b.bottom && a.bottom >= b.top;

/** Brute force: each pair by its key. */
function allPairs(boxes: readonly Box[], meets: (a: Box, b: Box) => boolean = overlaps): Map<string, Pair> {
  return new Map(boxes.flatMap((a, at) => boxes.slice(at + 1).filter((b) => meets(a, b)).map((b): [string, Pair] => [key(a, b), [a, b]])));
}

/** A few boxes on so coarse a grid that many touch, coincide or enclose each other: few first, so that a mistake shows in a small world. */
function world(seed: number): Box[] {
  const random = randomFrom(seed);
  const whole = (most: number): number => Math.floor(random() * (most + 1));
  return Array.from({ length: 2 + Math.floor(seed / 60) }, (_, id) => {
    const [left, top] = [whole(20), whole(14)];
    return { id, left, top, right: left + 1 + whole(8), bottom: top + 1 + whole(8) };
  });
}

const WORLDS = 400;

/** The code of a task is what `name` exports. */
function exported<T>(exports: Exports, name: string): T {
  if (!(name in exports)) throw new Error(`There is no “export … ${name}” any more, which the checker asks for.`);
  return exports[name] as T;
}

function functionOf<T>(exports: Exports, name: string): T {
  const value = exported<T>(exports, name);
  if (typeof value !== "function") throw new Error(`${name} has to be a function.`);
  return value;
}

/** Boxes that make the sort by center miss a pair. */
function miss(exports: Exports): Verdict {
  const given = exported<unknown>(exports, "boxes");
  if (!Array.isArray(given) || given.length < 2 || given.length > 26) throw new Error("boxes has to be an array of 2 to 26 boxes.");
  const boxes = given.map(({ left, top, right, bottom }: Box, id): Box => {
    const box = { id, left, top, right, bottom };
    if (![left, top, right, bottom].every(Number.isFinite)) throw new Error(`Box ${letter(box)} needs four numbers: left, top, right and bottom.`);
    if (left > right || top > bottom) throw new Error(`Box ${letter(box)} ends before it begins.`);
    return box;
  });
  const all = allPairs(boxes);
  const found = new Set<string>();
  (byCenter as Find)(boxes, (a, b) => found.add(key(a, b)));
  const missed = [...all.values()].find(([a, b]) => !found.has(key(a, b)));
  if (missed) return { isSolved: true, says: `Missed: ${both(missed)} overlap, and the sort by center does not find them.`, boxes, pair: missed };
  return { isSolved: false, says: `Nothing is missed: it finds all of the pairs (${all.size}).`, boxes };
}

/** How often the coordinates of a row of boxes may be read: sorting them reads about 3,000, brute force at least 40,000. */
const ROW = 200;
const MOST_READS = 20_000;

/** A search for pairs that finds them all and still stops early. */
function repair(exports: Exports): Verdict {
  const find = functionOf<Find>(exports, "findPairs");
  for (let seed = 0; seed < WORLDS; seed++) {
    const boxes = world(seed);
    const all = allPairs(boxes);
    const found = new Map<string, Pair>();
    let wrong: Verdict | undefined;
    const fail = (says: string, pair: Pair): void => void (wrong ??= { isSolved: false, says: `${says} ${both(pair)}.`, boxes, pair });
    find([...boxes], (a, b) => {
      if (typeof a?.id !== "number" || typeof b?.id !== "number") throw new Error("onPair has to be called with two boxes.");
      if (!all.has(key(a, b))) fail("It reports boxes that are apart:", [a, b]);
      if (found.has(key(a, b))) fail("It reports this pair twice:", [a, b]);
      found.set(key(a, b), [a, b]);
    });
    const missed = [...all.values()].find(([a, b]) => !found.has(key(a, b)));
    if (missed) fail("It still misses", missed);
    if (wrong) return wrong;
  }
  let reads = 0;
  // Each counts when it is compared or calculated with, also in a copy of its box.
  const at = (value: number): unknown => ({ [Symbol.toPrimitive]: () => (reads++, value) });
  const row = Array.from({ length: ROW }, (_, id) => ({ id, left: at(10 * id), top: at(0), right: at(10 * id + 9), bottom: at(9) }));
  find(row as Box[], () => undefined);
  if (reads <= MOST_READS) return { isSolved: true, says: `It finds the pairs of brute force in ${WORLDS} random worlds, and it stops early.` };
  return { isSolved: false, says: `It finds all pairs. But for ${ROW} boxes side by side it reads ${reads.toLocaleString("en")} coordinates; the limit is ${MOST_READS.toLocaleString("en")}. Stop each row early, and sort in fewer steps.` };
}

/** A pair stays forever if it is reported in this many frames in a row in which its boxes are apart. */
const FOREVER = 30;

/** A key under which the swap-driven sweep never forgets a pair. */
function breakKey(exports: Exports): Verdict {
  const mine = functionOf<typeof key>(exports, "key");
  const { begin, update } = swapDriven({ ...helpers, $line, key: mine }) as unknown as {
    begin(boxes: Box[]): unknown;
    update(state: unknown): Pair[];
  };
  const random = randomFrom(3);
  const boxes = world(4 * 60).map((box) => ({ ...box }));
  const state = begin(boxes);
  let lost: Verdict | undefined;
  /** By pair, the frames in a row up to now in which it was reported though it is apart. */
  let stale = new Map<string, number>();
  for (let frame = 0; frame < 300; frame++) {
    for (const box of boxes) {
      const [dx, width] = [Math.floor(random() * 7) - 3, box.right - box.left];
      box.left = Math.min(Math.max(box.left + dx, 0), 28);
      box.right = box.left + width;
    }
    const found = update(state);
    const now = (): Box[] => boxes.map((box) => ({ ...box }));
    stale = new Map(found.filter((pair) => !overlapOnX(...pair)).map((pair) => [key(...pair), (stale.get(key(...pair)) ?? 0) + 1]));
    const kept = found.find((pair) => stale.get(key(...pair)) === FOREVER);
    if (kept) return { isSolved: true, says: `In frame ${frame}, ${both(kept)} are still reported, after ${FOREVER} frames in which they were apart on x.`, boxes: now(), pair: kept };
    const keys = new Set(found.map(([a, b]) => key(a, b)));
    const gone = [...allPairs(boxes, overlapOnX).values()].find(([a, b]) => !keys.has(key(a, b)));
    if (gone) lost ??= { isSolved: false, says: `Two pairs share a key: in frame ${frame}, ${both(gone)} got lost. That is broken too. Can you also make a pair stay forever?`, boxes: now(), pair: gone };
  }
  return lost ?? { isSolved: false, says: "In 300 frames every overlap began and ended as it should." };
}

/** Levels of a game, each with boxes of about one size. */
function levels(): { name: string; boxes: Box[] }[] {
  const random = randomFrom(11);
  const between = (from: number, to: number): number => Math.round(from + (to - from) * random());
  const level = (name: string, places: readonly (readonly [x: number, y: number])[]): { name: string; boxes: Box[] } => ({
    name,
    boxes: places.map(([x, y], id) => ({ id, left: x, top: y, right: x + between(12, 18), bottom: y + between(12, 18) })),
  });
  const along = (count: number): number[] => Array.from({ length: count }, (_, at) => 22 * at);
  const tower = (count: number, x: number): [number, number][] => along(count).map((y) => [x + between(0, 10), y]);
  const floor = (count: number, y: number): [number, number][] => along(count).map((x) => [x, y + between(0, 10)]);
  return [
    level("a tower", tower(20, 100)),
    level("a side-scroller", floor(20, 100)),
    level("two towers", [...tower(10, 0), ...tower(10, 500)]),
    level("a tower, and one box far away", [...tower(20, 0), [900, 200]]),
    level("two floors", [...floor(10, 0), ...floor(10, 500)]),
    level("a floor under a balloon", [...floor(20, 800), [200, 0]]),
  ];
}

/** A rule that takes the better axis of every level. */
function axis(exports: Exports): Verdict {
  const choose = functionOf<(boxes: Box[]) => unknown>(exports, "chooseAxis");
  for (const { name, boxes } of levels()) {
    const [x, y] = [allPairs(boxes, overlapOnX).size, allPairs(boxes, overlapOnY).size];
    const chosen = choose(boxes.map((box) => ({ ...box })));
    if (chosen !== "x" && chosen !== "y") throw new Error(`chooseAxis has to return "x" or "y", not ${JSON.stringify(chosen) ?? "nothing"}.`);
    if (chosen !== (x < y ? "x" : "y")) return { isSolved: false, says: `It takes ${chosen} for “${name}”: ${chosen === "x" ? x : y} tests, where the other axis takes ${Math.min(x, y)}.`, boxes };
  }
  return { isSolved: true, says: `It takes the better axis for each of ${levels().length} levels.` };
}

/** The swaps that insertion sort makes, as counted by hand. */
function swaps(exports: Exports): Verdict {
  const counted = exported<unknown>(exports, "swaps");
  if (!Array.isArray(counted) || counted.length !== SWAP_WORLDS.length) throw new Error(`swaps has to be an array of ${SWAP_WORLDS.length} numbers.`);
  const right = SWAP_WORLDS.filter((places, at) => {
    const endpoints = places.map(([name, side, at]): Endpoint => ({ box: { id: name.charCodeAt(0) } as Box, side: side === "(" ? "left" : "right", isLeft: side === "(", at }));
    // Brute force: the pairs in the wrong order.
    const inversions = endpoints.flatMap((p, i) => endpoints.slice(i + 1).filter((q) => precedes(q, p))).length;
    let writes = 0;
    insertionSort(new Proxy(endpoints, { set: (target, place, value) => (writes++, Reflect.set(target, place, value)) }));
    if (writes !== 2 * inversions) throw new Error("Insertion sort swaps once for each inversion.");
    return counted[at] === inversions;
  }).length;
  return { isSolved: right === SWAP_WORLDS.length, says: right === SWAP_WORLDS.length ? "Insertion sort makes exactly these swaps." : `${right} of ${SWAP_WORLDS.length} are what insertion sort does.` };
}

const CHECKS: Readonly<Record<string, (exports: Exports) => Verdict>> = { miss, repair, key: breakKey, axis, swaps };

/** Whether the code solves a task. Throws what the code throws. */
export function check(task: string, compile: Compile): Verdict {
  const { boxes, pair, ...verdict } = CHECKS[task]!(compile({ ...helpers, $line }));
  return { ...verdict, ...(boxes && { boxes: boxes.map(plain) }), ...(pair && { pair: [plain(pair[0]), plain(pair[1])] }) };
}
