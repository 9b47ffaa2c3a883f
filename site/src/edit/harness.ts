// Runs a listing as the reader has changed it, in the place of the algorithm of a demo. The other listings are there
// under their names, as in the article; some of them report what they do, so that the demo can show it.

import type { DemoProgram, ProgramEvent } from "sweep-and-prune-classroom/demo";
import type { Box } from "../box.ts";
import { helpers } from "./helpers.ts";

const { endpointsOf, overlaps, precedes, quicksort, sweep } = helpers;

export interface Endpoint {
  readonly box: Box;
  readonly side: keyof Omit<Box, "id">;
  readonly isLeft: boolean;
  at: number;
}

export type Exports = Readonly<Record<string, (...values: never[]) => unknown>>;

/** What a listing reports while it runs. */
interface Report {
  test(a: Box, b: Box): void;
  overlap(a: Box, b: Box): void;
  /** Runs what sorts these arrays, one for each axis; its comparisons and swaps are reported. */
  sorting(arrays: readonly Endpoint[][], sort: () => unknown): void;
}

/** A world: the boxes as they are, and as they were at the detection before. */
interface World {
  readonly boxes: Box[];
  readonly before: Box[] | undefined;
}

/** How a demo runs each listing: what it calls, and with what. */
type Run = (listing: Exports, world: World, report: Report) => void;

const finds =
  (name: string): Run =>
  (listing, { boxes }, report) =>
    call(listing, name, boxes, report.overlap);

/** The listings that can be changed. */
const RUNS: Readonly<Record<string, Run>> = {
  pairwise: finds("globalPairwise"),
  "sorted-pairwise": finds("sortedPairwise"),
  "sweep-and-prune": finds("sweepAndPrune"),
  "sweep-all-axes": finds("sweepAllAxes"),
  sweep: (listing, { boxes }, report) => {
    const endpoints = endpointsOf(boxes);
    quicksort(endpoints);
    call(listing, "sweep", endpoints, candidates(report));
  },
  "one-to-n": (listing, { boxes }, report) => {
    const endpoints = endpointsOf(boxes);
    quicksort(endpoints);
    call(listing, "oneToN", endpoints, boxes[0], candidates(report));
  },
  quicksort: (listing, world, report) => sorts(listing, "quicksort", world, report),
  "insertion-sort": (listing, world, report) => sorts(listing, "insertionSort", world, report),
  "swap-driven": updates,
  "swap-all-axes": updates,
};

/** What is handed on as overlapping on x is tested on y. */
const candidates =
  (report: Report) =>
  (a: Box, b: Box): void => {
    report.test(a, b);
    if (overlaps(a, b)) report.overlap(a, b);
  };

/** Sorts what the detection before has left sorted. */
function sorts(listing: Exports, name: string, { boxes, before }: World, report: Report): void {
  const endpoints: Endpoint[] = endpointsOf(before ?? boxes);
  if (before) quicksort(endpoints);
  for (const endpoint of endpoints) endpoint.at = boxes[endpoint.box.id]![endpoint.side];
  report.sorting([endpoints], () => call(listing, name, endpoints));
  const wrong = endpoints.findIndex((endpoint, at) => at > 0 && precedes(endpoint, endpoints[at - 1]!));
  if (wrong > 0) throw new Error(`The endpoints are not sorted: number ${wrong} should stand before number ${wrong - 1}.`);
  sweep(endpoints.map((endpoint) => ({ ...endpoint, box: boxes[endpoint.box.id]! })), candidates(report));
}

/** Begins with the boxes of the detection before, which then move. */
function updates(listing: Exports, { boxes, before }: World, report: Report): void {
  const moving = structuredClone(before ?? boxes);
  const state = call(listing, "begin", moving) as { endpoints?: Endpoint[]; arrays?: Endpoint[][] };
  moving.forEach((box, id) => Object.assign(box, boxes[id]));
  let found: unknown;
  const arrays = state.arrays ?? (state.endpoints ? [state.endpoints] : []);
  report.sorting(arrays, () => (found = call(listing, "update", state)));
  if (!Array.isArray(found)) throw new Error("update() has to return an array of pairs.");
  for (const [a, b] of found as [Box, Box][]) {
    if (state.arrays) report.overlap(a, b);
    else candidates(report)(a, b);
  }
}

function call(listing: Exports, name: string, ...values: unknown[]): unknown {
  const exported = listing[name];
  if (typeof exported !== "function") throw new Error(`The demo calls ${name}(), and there is no such function any more.`);
  return exported(...(values as never[]));
}

/** More events than this are too many to look at, and take memory. */
const MOST_EVENTS = 20_000;

/** Collects what a listing does in one detection. */
class Recorder implements Report {
  readonly events: ProgramEvent[] = [];
  /** The line that is at work, if the code tells. */
  line: number | undefined;
  /** The arrays that are being sorted, and the order in which they were when last looked at. */
  #arrays: readonly Endpoint[][] = [];
  #seen: Endpoint[][] = [];
  #axis = -1;

  test = (a: Box, b: Box): void => this.#add({ kind: "test", ...pair(a, b), line: this.line });
  overlap = (a: Box, b: Box): void => this.#add({ kind: "overlap", ...pair(a, b), line: this.line });
  axisOverlap = (axis: number, a: Box, b: Box): void => this.#add({ kind: "axis overlap", axis, ...pair(a, b) });

  sorting(arrays: readonly Endpoint[][], sort: () => unknown): void {
    this.#arrays = arrays;
    this.#seen = arrays.map((endpoints) => [...endpoints]);
    this.#show(0);
    sort();
    this.#look();
    // What follows is done with what the listing returned.
    this.line = undefined;
    this.#arrays = [];
  }

  compare(p: Endpoint, q: Endpoint): void {
    if (this.#arrays.length === 0) return;
    this.#look();
    this.#show(axisOf(p));
    this.#add({ kind: "compare", a: edge(p), b: edge(q), line: this.line });
  }

  /** Reports what has been swapped since the last look: a listing that exchanges two places does so between comparisons. */
  #look(): void {
    for (const [axis, endpoints] of this.#arrays.entries()) {
      const seen = this.#seen[axis]!;
      for (let i = 0; i < seen.length; i++) {
        if (endpoints[i] === seen[i]) continue;
        const j = seen.indexOf(endpoints[i]!);
        if (j < 0) throw new Error("An endpoint was lost while sorting: the array has to keep all of them.");
        this.#show(axis);
        [seen[i], seen[j]] = [seen[j]!, seen[i]!];
        this.#add({ kind: "swap", i, j });
      }
    }
  }

  /** The array of an axis is the one that is worked on. */
  #show(axis: number): void {
    if (axis === this.#axis || !this.#seen[axis]) return;
    this.#axis = axis;
    this.#add({ kind: "array", axis, edges: this.#seen[axis].map(edge) });
  }

  #add(event: ProgramEvent): void {
    if (this.events.length >= MOST_EVENTS) throw new Error(`It does more than ${MOST_EVENTS.toLocaleString("en")} things in one detection.`);
    this.events.push(event);
  }
}

const pair = (a: Box, b: Box): { a: number; b: number } => ({ a: a.id, b: b.id });
const edge = ({ box, isLeft }: Endpoint): number => 2 * box.id + (isLeft ? 0 : 1);
const axisOf = ({ side }: Endpoint): number => (side === "left" || side === "right" ? 0 : 1);

/** Compiles the code with the other listings beside it: some of them report to `recorder()`, which changes from run to run. */
export type Compile = (helpers: Readonly<Record<string, unknown>>) => Exports;

/** What a demo is to run instead of its algorithm. Throws what the code throws when it is compiled. */
export function programOf(name: string, compile: Compile): DemoProgram {
  let recorder = new Recorder();
  const listing = compile({
    ...helpers,
    $line: <F>(line: number, report: F): F => ((recorder.line = line), report),
    overlaps: (a: Box, b: Box): boolean => {
      recorder.test(a, b);
      return overlaps(a, b);
    },
    precedes: (p: Endpoint, q: Endpoint): boolean => {
      recorder.compare(p, q);
      return precedes(p, q);
    },
    sweep: (endpoints: Endpoint[], onOverlap: (a: Box, b: Box) => void): void =>
      sweep(endpoints, (a: Box, b: Box) => {
        if (name === "sweep-all-axes") recorder.axisOverlap(endpoints[0] ? axisOf(endpoints[0]) : 0, a, b);
        else if (name === "sweep-and-prune") recorder.test(a, b);
        onOverlap(a, b);
      }),
  });
  return (rows, before) => {
    recorder = new Recorder();
    RUNS[name]!(listing, { boxes: boxesOf(rows), before: before && boxesOf(before) }, recorder);
    return recorder.events;
  };
}

function boxesOf(rows: Float64Array): Box[] {
  return Array.from({ length: rows.length / 4 }, (_, id) => {
    const [left = 0, top = 0, right = 0, bottom = 0] = rows.subarray(4 * id, 4 * id + 4);
    return { id, left, top, right, bottom };
  });
}
