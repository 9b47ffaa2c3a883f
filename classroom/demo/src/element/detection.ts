import { Player, type PlayerState } from "../algorithms/player.js";
import { Runner, type Step } from "../algorithms/runner.js";
import { events, type TraceEvent } from "../algorithms/trace.js";
import type { Decorations } from "./decorations.js";
import type { Detecting, Options } from "./options.js";

/** What one run of an algorithm did, event by event. */
export interface Detection {
  /** The boxes it ran over: rows of min corner and max corner. */
  readonly boxes: Float64Array;
  readonly step: Step;
  /** How many events it has. */
  readonly length: number;
  /** Its events, the first the beginning of the step. */
  readonly events: readonly TraceEvent[];
  /** Whether its swaps show which overlaps begin and end. A detection that sweeps, or that begins with a sweep, only sorts by them. */
  readonly isDrivenBySwaps: boolean;
  /** The edges that the sort has moved. */
  readonly swapped: ReadonlySet<number>;
  /** Whether the trace was too long to be recorded in full: it then cannot be gone through. */
  readonly isTruncated: boolean;
  /** The pairs that it should have found and did not. Known where methods miss any. */
  readonly missed: readonly (readonly [number, number])[];
  /** How often the flags of a pair were read in the first `position` events. */
  flagChecksAt(position: number): number;
  /** The state to draw after this many of its events. */
  stateAt(position: number): PlayerState;
  free(): void;
}

/** The run of a compiled algorithm: its own trace. */
export class TracedDetection implements Detection {
  readonly boxes: Float64Array;
  readonly step: Step;
  readonly length: number;
  #events: TraceEvent[] | undefined;
  #swapped: ReadonlySet<number> | undefined;
  #isDrivenBySwaps: boolean | undefined;
  readonly isTruncated: boolean;
  readonly #player: Player;
  /** Events of the trace before the first of this step. */
  readonly #before: number;
  readonly missed: Detection["missed"];
  #last: { position: number; state: PlayerState } | undefined;

  /** Runs one step of `runner`, whose trace is trimmed. `missedOf` says which pairs are not among those found. */
  constructor(runner: Runner, boxes: Float64Array, missedOf?: (found: Uint32Array) => Detection["missed"]) {
    this.boxes = boxes;
    this.#before = runner.trimTrace();
    this.step = runner.step(boxes);
    this.isTruncated = runner.isTruncated;
    this.#player = new Player(runner);
    this.length = countEvents(this.#player.words) - this.#before;
    this.missed = missedOf?.(this.step.pairs) ?? [];
  }

  /** Read when they are first asked for. */
  get events(): readonly TraceEvent[] {
    return (this.#events ??= [...events(this.#player.words)].slice(this.#before));
  }

  get isDrivenBySwaps(): boolean {
    return (this.#isDrivenBySwaps ??= !this.events.some(({ kind }) => kind === "enter"));
  }

  get swapped(): ReadonlySet<number> {
    return (this.#swapped ??= new Set(this.events.flatMap(({ kind, a, b }) => (kind === "swap" ? [Number(a), Number(b)] : []))));
  }

  /** Once for each overlap that was found on an axis, or began there or ended. */
  flagChecksAt(position: number): number {
    let count = 0;
    for (const { kind } of this.events.slice(0, position)) count += Number(kind === "axis overlap" || kind === "axis apart");
    return count;
  }

  stateAt(position: number): PlayerState {
    if (this.#last?.position !== position) {
      this.#player.seek(this.#before + position);
      this.#last = { position, state: this.#player.state() };
    }
    return this.#last.state;
  }

  free(): void {
    this.#player.free();
  }
}

function countEvents(words: Uint32Array): number {
  let count = 0;
  for (let at = 0; at < words.length; at += words[at]! >>> 8) count++;
  return count;
}

/** Brute force, to tell what a method that is wrong has missed. */
export class Oracle {
  readonly #runner: Runner = new Runner({ dimensions: 2, method: "global pairwise" });
  readonly #focus: number | undefined;

  /** Of the pairs of one ball, or of all. */
  constructor(focus: number | undefined) {
    this.#focus = focus;
  }

  /** The pairs of boxes that overlap and are not among those found. */
  missed(boxes: Float64Array, ...founds: Uint32Array[]): [number, number][] {
    const key = (a: number, b: number): number => Math.min(a, b) * 2 ** 24 + Math.max(a, b);
    const known = new Set<number>();
    for (const found of founds) for (let i = 0; i < found.length; i += 2) known.add(key(found[i]!, found[i + 1]!));
    const pairs = this.pairs(boxes);
    const all = Array.from({ length: pairs.length / 2 }, (_, i): [number, number] => [pairs[2 * i]!, pairs[2 * i + 1]!]);
    return all.filter((pair) => !known.has(key(...pair)) && (this.#focus === undefined || pair.includes(this.#focus)));
  }

  /** All pairs of boxes that overlap. */
  pairs(boxes: Float64Array): Uint32Array {
    return this.#runner.step(boxes).pairs;
  }

  free(): void {
    this.#runner.free();
  }
}

/** The oracle for a method that may miss pairs, or for boxes that jump; none for the others. */
export function oracleFor({ detecting: { method, like, focus }, swept }: Options): Oracle | undefined {
  if (method === "one-to-n scan") return new Oracle(focus);
  return swept === "off" || method !== like ? new Oracle(undefined) : undefined;
}

/** A runner for what the attributes ask for. */
export function newRunner({ like: _, ...detecting }: Detecting): Runner {
  return new Runner({ dimensions: 2, ...detecting, persistent: true, traceWords: 1 << 22 });
}

/** Whether flags of pairs take the place of box tests. */
export function hasFlags({ method }: Detecting): boolean {
  return method.endsWith("on every axis");
}

/** Whether a detection is the full sweep that tells a swap-driven method what overlaps before anything is swapped. */
export function isStart(detection: Detection, { method }: Detecting): boolean {
  return method.startsWith("swap-driven") && !detection.isDrivenBySwaps;
}

/** Which kinds of events are worth a stop. */
export function shownKinds({ checks, sweep, array }: Decorations, detecting: Detecting): Set<TraceEvent["kind"]> {
  const kinds = new Set<TraceEvent["kind"]>();
  if (checks) kinds.add(hasFlags(detecting) ? "overlap" : "test").add("prune");
  // Swaps tell the flags that change; a sweep sets all of them again.
  if (checks && detecting.method === "endpoint sweep on every axis") kinds.add("axis overlap");
  // Swap-driven methods have no line; where they are told to draw one, it stands at an edge.
  if (sweep && !detecting.method.startsWith("swap-driven")) kinds.add("enter").add("leave");
  if (array?.isSortShown) kinds.add("compare").add("swap");
  return kinds;
}

/** Whether other options of the same world leave its detections as they were, and change only how they are shown. */
export function areDetectionsKept(before: Options, after: Options): boolean {
  const key = ({ detecting, decorations, skip, swept, predicts }: Options): string =>
    JSON.stringify([detecting, [...shownKinds(decorations, detecting)], skip, swept, predicts]);
  return before.program === after.program && key(before) === key(after);
}

/** Whether anything moves, or can be stepped through; while a ball is dragged that stays as it is. */
export function canPlay(options: Options | undefined): boolean {
  return !options?.isStatic || shownKinds(options.decorations, options.detecting).size > 0;
}

/** The positions at which to stop: after each event of these kinds, and at the end. The full sweep that swaps begin with is only its end. */
export function stopsOf(detection: Detection, kinds: ReadonlySet<TraceEvent["kind"]>, isStart: boolean): number[] {
  const stops: number[] = [];
  if (!detection.isTruncated && kinds.size > 0 && !isStart) {
    detection.events.forEach(({ kind }, index, { [index + 1]: next }) => {
      // The last flag of a pair and the pair are one moment.
      const isLastFlag = kind === "axis overlap" && next?.kind === "overlap" && kinds.has("overlap");
      if (kinds.has(kind) && !isLastFlag) stops.push(index + 1);
    });
  }
  const end = detection.length;
  if (stops.at(-1) !== end) stops.push(end);
  return stops;
}
