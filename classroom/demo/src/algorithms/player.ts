/// <reference lib="esnext.disposable" preserve="true" />
import { describe } from "../../../../js/src/wasm/describe.js";
import { forgotten, type Handle } from "../../../../js/src/wasm/handle.js";
import { eventAt, lengthBefore, type TraceEvent } from "./trace.js";
import { type AlgorithmsExports, type Counts, readCounts, Runner } from "./runner.js";

/** A place in an array: the edge there, and its coordinate. */
export interface Place {
  /** The edge: `2 * box`, and one more if it is a right end. */
  edge: number;
  /** Its coordinate. */
  at: number;
}

/** Where the sweep line stands. */
export interface Line {
  /** The position in the current array. */
  position: number;
  /** The edge there. */
  edge: number;
}

/** Two boxes that overlap on an axis. */
export interface AxisOverlap {
  /** The axis. */
  axis: number;
  /** The smaller index. */
  a: number;
  /** The greater. */
  b: number;
}

/** The state at one moment of a trace, for drawing. An edge is `2 * box` for a left end, and one more for a right end. */
export interface PlayerState {
  /** The axis along which the current step sweeps, or sweeps first. */
  axis: number;
  /** The axis whose array is being sorted or swept. */
  arrayAxis: number;
  /** The endpoints on each axis, as far as they are sorted now. */
  arrays: Place[][];
  /** The position in the current array, and the edge there, that the sweep line reached last. */
  line: Line | undefined;
  /** The boxes that the sweep line touches. */
  active: number[];
  /** The pairs that overlap on a swept axis. */
  axisOverlaps: AxisOverlap[];
  /** The pairs found in this step: `a0, b0, a1, b1, ...`. */
  overlaps: number[];
  /** The pairs that have begun and not ended: `a0, b0, a1, b1, ...`. */
  held: number[];
  /** What was counted in this step. */
  counts: Counts;
}

/** Plays what a runner has recorded so far, event by event, forward and back. */
export class Player {
  /** The words that are played. */
  readonly words: Uint32Array<ArrayBuffer>;
  readonly #handle: Handle<AlgorithmsExports>;
  #position = 0;
  /** Where in the words the next event begins. */
  #at = 0;

  /**
   * A player at the beginning of the trace of a runner.
   *
   * @throws `TypeError` if the runner was freed, or is none.
   */
  constructor(runner: Runner) {
    if (!(runner instanceof Runner)) throw new TypeError("a Player needs a Runner");
    this.words = runner.trace();
    this.#handle = runner.newPlayer();
    forgotten?.register(this, this.#handle);
  }

  /** How many events have been played. */
  get position(): number {
    return this.#position;
  }

  /** The event that was played last: the one to highlight. */
  get current(): TraceEvent | undefined {
    return this.#at === 0 ? undefined : eventAt(this.words, this.#at - lengthBefore(this.words, this.#at));
  }

  /** Plays the next event, if there is one, and returns it. */
  forward(): TraceEvent | undefined {
    if (this.#at === this.words.length) return undefined;
    this.seek(this.#position + 1);
    return this.current;
  }

  /** Undoes the event that was played last, if there is one, and returns it. */
  backward(): TraceEvent | undefined {
    const undone = this.current;
    if (undone) this.seek(this.#position - 1);
    return undone;
  }

  /** Plays or undoes until `position` events have been played, at most all of them. */
  seek(position: number): void {
    if (!(Number.isInteger(position) && position >= 0)) {
      throw new RangeError(`\`position\` is ${describe(position)}; it must be a whole number, 0 or more`);
    }
    const reached = this.#handle.call((exports, player) => exports.player_seek(player, Math.min(position, 2 ** 32 - 1))) >>> 0;
    for (; this.#position < reached; this.#position++) this.#at += this.words[this.#at]! >>> 8;
    for (; this.#position > reached; this.#position--) this.#at -= lengthBefore(this.words, this.#at);
  }

  /** What is to be drawn: objects of your own. */
  state(): PlayerState {
    const { engine } = this.#handle;
    engine.check(this.#handle.call((exports, player) => exports.player_state(player)));
    const numbers = new Float64Array(engine.buffer, engine.detail(0), engine.detail(1));
    const [axis = 0, arrayAxis = 0, position = -1, edge = -1] = numbers;
    let at = 14;
    const list = (): number[] => {
      const begin = at + 1;
      at = begin + numbers[at]!;
      return Array.from(numbers.subarray(begin, at));
    };
    const [active, overlaps, held] = [list(), list(), list()];
    const axisOverlaps = chunks(list(), 3).map(([axis = 0, a = 0, b = 0]) => ({ axis, a, b }));
    const arrays = Array.from({ length: numbers[at++]! }, () =>
      chunks(list(), 2).map(([edge = 0, at = 0]) => ({ edge, at })),
    );
    return {
      axis,
      arrayAxis,
      arrays,
      line: position < 0 ? undefined : { position, edge },
      active,
      axisOverlaps,
      overlaps,
      held,
      counts: readCounts(numbers, 4),
    };
  }

  /** Frees the memory. Freeing it twice is not an error. */
  free(): void {
    this.#handle.free();
  }

  /** As {@link Player.free}, for `using`. */
  [Symbol.dispose](): void {
    this.free();
  }
}

function chunks(values: number[], size: number): number[][] {
  return Array.from({ length: values.length / size }, (_, i) => values.slice(i * size, (i + 1) * size));
}
