// One world in three structures: what a sweep, a grid and a tree test until they have found all overlapping pairs.
// The sweep is the library's own, with its trace. The grid and the tree are the plain ones of the textbooks.

import { events, Runner } from "sweep-and-prune-classroom";
import type { Box as NumberedBox } from "../box.ts";
import { overlaps } from "../listings/overlaps.js";
import { randomFrom } from "../random.ts";

export const [WIDTH, HEIGHT] = [480, 240];

export type Box = Omit<NumberedBox, "id">;

export type Pair = readonly [number, number];

/** What a structure did. */
export interface Work {
  /** Pairs of boxes handed to the box test, as often as they were. */
  readonly tests: readonly Pair[];
  /** Pairs that overlap, each once, smaller index first. */
  readonly pairs: readonly Pair[];
  /** What it did beside box tests, in words. */
  readonly beside: string;
  /** The parts of space that it has: columns, cells or nodes. */
  readonly parts: readonly Box[];
  /** Where it looks for the partners of a box. */
  partsOf(box: Box): Box[];
  /** Its arrays in memory, and what of them is read to find the partners of a box. */
  memoryOf(id: number): readonly MemoryArray[];
}

/** An array, and which of its items are read. */
export interface MemoryArray {
  readonly name: string;
  /** The bytes of an item, and how many there are. */
  readonly bytes: number;
  readonly count: number;
  readonly read: ReadonlySet<number>;
}

/** A processor loads memory by lines of this many bytes. */
const CACHE_LINE = 64;

/** Of each cache line of an array, whether it is loaded. */
export const linesOf = ({ bytes, count, read }: MemoryArray): boolean[] => {
  const lines = Array.from({ length: Math.ceil((bytes * count) / CACHE_LINE) }, () => false);
  for (const item of read) lines[Math.floor((bytes * item) / CACHE_LINE)] = true;
  return lines;
};

/** Bytes of a box, and of the number of one. */
const BOX = 16;
const NUMBER = 4;

/** Sorts by left edge, and tests each box against those that begin before it ends. */
export function sweep(boxes: readonly Box[]): Work {
  const runner = new Runner({ dimensions: 2, method: "sorted pairwise", axis: 0, traceWords: 1 << 20 });
  const { counts } = runner.step(boxes.flatMap(({ left, top, right, bottom }) => [left, top, right, bottom]));
  const trace = [...events(runner.trace())];
  runner.free();
  const pairsOf = (kind: string): Pair[] => trace.flatMap((event) => (event.kind === kind ? [ordered(Number(event["a"]), Number(event["b"]))] : []));
  return {
    tests: pairsOf("test"),
    pairs: pairsOf("overlap"),
    beside: `${counts.comparisons} comparisons to sort`,
    parts: [],
    partsOf: ({ left, right }) => [{ left, right, top: 0, bottom: HEIGHT }],
    memoryOf: (id) => {
      // The array is sorted: it is read from the box on, up to the first that begins too late.
      const sorted = [...boxes.keys()].sort((a, b) => boxes[a]!.left - boxes[b]!.left || a - b);
      const from = sorted.indexOf(id);
      const end = sorted.findIndex((other, at) => at > from && boxes[other]!.left > boxes[id]!.right);
      const read = sorted.map((_, at) => at).slice(from, end < 0 ? undefined : end + 1);
      return [{ name: "sorted boxes", bytes: BOX, count: boxes.length, read: new Set(read) }];
    },
  };
}

/** The cells of a grid, each with the boxes that touch it. */
export function grid(boxes: readonly Box[]): Work {
  const size = 40;
  const across = Math.ceil(WIDTH / size);
  const cells = Array.from({ length: across * Math.ceil(HEIGHT / size) }, (): number[] => []);
  const cellAt = (x: number, y: number): number => Math.floor(y / size) * across + Math.floor(x / size);
  const cellsOf = ({ left, top, right, bottom }: Box): number[] => {
    const touched: number[] = [];
    for (let row = Math.floor(top / size); row <= Math.floor(bottom / size); row++) {
      for (let column = Math.floor(left / size); column <= Math.floor(right / size); column++) touched.push(row * across + column);
    }
    return touched;
  };
  let copies = 0;
  for (const [id, box] of boxes.entries()) {
    for (const cell of cellsOf(box)) {
      cells[cell]!.push(id);
      copies++;
    }
  }
  const tests: Pair[] = [];
  const pairs: Pair[] = [];
  for (const [at, ids] of cells.entries()) {
    for (const [i, a] of ids.entries()) {
      for (const b of ids.slice(i + 1)) {
        tests.push([a, b]);
        const [one, other] = [boxes[a]!, boxes[b]!];
        // Boxes that share several cells are one pair: that of the cell that holds the corner of their intersection.
        if (overlaps(one, other) && at === cellAt(Math.max(one.left, other.left), Math.max(one.top, other.top))) pairs.push([a, b]);
      }
    }
  }
  const boxOf = (cell: number): Box => {
    const [left, top] = [(cell % across) * size, Math.floor(cell / across) * size];
    return { left, top, right: left + size, bottom: top + size };
  };
  const memoryOf = (id: number): MemoryArray[] => {
    // The lists of the cells stand one behind the other, and name boxes that stand elsewhere.
    const starts = cells.map((_, cell) => cells.slice(0, cell).reduce((sum, { length }) => sum + length, 0));
    const touched = cellsOf(boxes[id]!);
    const entries = touched.flatMap((cell) => cells[cell]!.map((_, at) => starts[cell]! + at));
    return [
      { name: "lists of cells", bytes: NUMBER, count: copies, read: new Set(entries) },
      { name: "boxes", bytes: BOX, count: boxes.length, read: new Set(touched.flatMap((cell) => cells[cell]!)) },
    ];
  };
  return { tests, pairs, beside: `${copies} entries in cells`, parts: [...cells.keys()].map(boxOf), partsOf: (box) => cellsOf(box).map(boxOf), memoryOf };
}

interface Node {
  readonly box: Box;
  readonly children: readonly Node[];
  readonly ids: readonly number[];
}

/** A node of the tree with more boxes is divided. */
const LEAF = 4;

/** Bounding boxes within bounding boxes: divided at the middle box, along the longer side. */
export function tree(boxes: readonly Box[]): Work {
  const root = node(boxes, [...boxes.keys()]);
  let visits = 0;
  let visited = new Set<Node>();
  const visit = (box: Box, at: Node, leaf: (ids: readonly number[], bounds: Box) => void): void => {
    const { children, ids, box: bounds } = at;
    visits++;
    visited.add(at);
    if (!overlaps(box, bounds)) return;
    if (children.length === 0) leaf(ids, bounds);
    for (const child of children) visit(box, child, leaf);
  };
  const tests: Pair[] = [];
  const pairs: Pair[] = [];
  for (const [id, box] of boxes.entries()) {
    visit(box, root, (ids) => {
      for (const other of ids) {
        if (other <= id) continue;
        tests.push([id, other]);
        if (overlaps(box, boxes[other]!)) pairs.push([id, other]);
      }
    });
  }
  const beside = `${visits} tests of nodes`;
  /** The nodes in the order in which they were made, parents first. */
  const nodes: Node[] = [];
  const collect = (each: Node): void => {
    nodes.push(each);
    each.children.forEach(collect);
  };
  collect(root);
  const found = nodes.filter(({ children }) => children.length === 0).map(({ box }) => box);
  const partsOf = (box: Box): Box[] => {
    const looked: Box[] = [];
    visit(box, root, (_, bounds) => void looked.push(bounds));
    return looked;
  };
  const memoryOf = (id: number): MemoryArray[] => {
    visited = new Set();
    const read = new Set<number>();
    visit(boxes[id]!, root, (ids) => ids.forEach((other) => read.add(other)));
    // A node is its box and where its children or boxes stand.
    const ofNodes = { name: "nodes", bytes: 2 * BOX, count: nodes.length, read: new Set(nodes.flatMap((each, at) => (visited.has(each) ? [at] : []))) };
    return [ofNodes, { name: "boxes", bytes: BOX, count: boxes.length, read }];
  };
  return { tests, pairs, beside, parts: found, partsOf, memoryOf };
}

function node(boxes: readonly Box[], ids: number[]): Node {
  const all = ids.map((id) => boxes[id]!);
  const box = {
    left: Math.min(...all.map(({ left }) => left)),
    top: Math.min(...all.map(({ top }) => top)),
    right: Math.max(...all.map(({ right }) => right)),
    bottom: Math.max(...all.map(({ bottom }) => bottom)),
  };
  if (ids.length <= LEAF) return { box, children: [], ids };
  const isWide = box.right - box.left >= box.bottom - box.top;
  const center = (id: number): number => (isWide ? boxes[id]!.left + boxes[id]!.right : boxes[id]!.top + boxes[id]!.bottom);
  const sorted = ids.toSorted((a, b) => center(a) - center(b));
  const middle = sorted.length >> 1;
  return { box, children: [node(boxes, sorted.slice(0, middle)), node(boxes, sorted.slice(middle))], ids: [] };
}

function ordered(a: number, b: number): Pair {
  return a < b ? [a, b] : [b, a];
}

// Worlds

export type WorldName = "even" | "long" | "one large";

/** The same boxes at each call. */
export function world(name: WorldName): Box[] {
  const random = randomFrom(name.length);
  const between = (low: number, high: number): number => low + (high - low) * random();
  const boxes = Array.from({ length: 80 }, (): Box => {
    const size = between(10, 22);
    const y = name === "long" ? between(100, 140) : between(20, HEIGHT - 20);
    return moved({ left: 0, top: 0, right: size, bottom: size }, between(20, WIDTH - 20), y);
  });
  if (name === "one large") boxes[0] = { left: 60, top: 30, right: 420, bottom: 90 };
  return boxes;
}

/** A box with another center, inside the world. */
export function moved({ left, top, right, bottom }: Box, x: number, y: number): Box {
  const [width, height] = [right - left, bottom - top];
  const newLeft = Math.min(Math.max(x - width / 2, 0), WIDTH - width - 0.01);
  const newTop = Math.min(Math.max(y - height / 2, 0), HEIGHT - height - 0.01);
  return { left: newLeft, top: newTop, right: newLeft + width, bottom: newTop + height };
}
