/// <reference lib="esnext.disposable" preserve="true" />
import { type Boxes, checkBoxes, checkDimensions, type Dimensions } from "../../../../js/src/boxes/boxes.js";
import { describe } from "../../../../js/src/wasm/describe.js";
import { checkFits, type Engine, type Exports } from "../../../../js/src/wasm/engine.js";
import { OutOfMemoryError } from "../../../../js/src/wasm/errors.js";
import { forgotten, Handle } from "../../../../js/src/wasm/handle.js";
import { Core } from "../../../../js/src/wasm/init.js";
import { lengthOf } from "../../../../js/src/wasm/typed.js";

/** What classroom/algorithms/wasm/ exports. */
export interface AlgorithmsExports extends Exports {
  runner_new(dimensions: number, traceWords: number): number;
  runner_copy(runner: number): number;
  runner_free(runner: number): void;
  runner_text(runner: number, length: number): number;
  runner_choose(runner: number, part: number, index: number): number;
  /** Chooses a method that only the compiled algorithms of a page have, by the text. */
  runner_choose_variant?(runner: number): number;
  runner_start(runner: number, isPersistent: number): number;
  runner_rows(runner: number, count: number): number;
  runner_step(runner: number, count: number): number;
  runner_list(runner: number, which: number): number;
  runner_is_truncated(runner: number): number;
  runner_clear_trace(runner: number): void;
  runner_trim_trace(runner: number): number;
  player_new(runner: number): number;
  player_free(player: number): void;
  player_seek(player: number, position: number): number;
  player_state(player: number): number;
}

/** The core of the observable algorithms. */
export const algorithmsCore: Core<AlgorithmsExports> = new Core("runner_new", "sweep-and-prune-classroom");

/** The algorithms, by name. The one-to-n scan finds only pairs of one box, and not all of those. */
export const methods = [
  "global pairwise",
  "sorted pairwise",
  "endpoint sweep",
  "endpoint sweep on every axis",
  "swap-driven sweep",
  "swap-driven sweep on every axis",
  "one-to-n scan",
] as const;

/** How endpoints are sorted, by name. */
export const sorts = ["standard library", "quicksort", "insertion sort", "merge sort", "Timsort"] as const;

/** How the sweep axis is chosen, by name. */
export const axes = ["fixed axis", "longest extent", "largest variance", "fewest expected overlaps"] as const;

/** An algorithm and how to run it. */
export interface RunnerOptions {
  /** How many dimensions the boxes have. */
  dimensions: Dimensions;
  /** The name of the algorithm. */
  method: (typeof methods)[number];
  /** How it sorts, if it sorts. `"standard library"` by default. */
  sort?: (typeof sorts)[number];
  /** The axis to sweep along, or the rule that chooses it at each step. `"largest variance"` by default. */
  axis?: Exclude<(typeof axes)[number], "fixed axis"> | 0 | 1 | 2;
  /** Whether a step continues from the state of the last one. Only then are begun and ended pairs reported. */
  persistent?: boolean;
  /** The box of the one-to-n scan. 0 by default. */
  focus?: number;
  /** How many words of trace to record; 0, nothing, by default. */
  traceWords?: number;
}

/** What an algorithm did. The counters mean the same for every algorithm. */
export interface Counts {
  /** Comparisons of the sort. */
  comparisons: number;
  /** Swaps of the sort. */
  swaps: number;
  /** Pairs of boxes handed to the box test. */
  tests: number;
  /** Pairs found to overlap on a swept axis. */
  axisOverlaps: number;
  /** Pairs found to overlap no longer on a swept axis. */
  axisEnds: number;
  /** Pairs that overlap on every axis. */
  pairs: number;
  /** Pairs that began. */
  begun: number;
  /** Pairs that ended. */
  ended: number;
  /** How many boxes the sweep line is in. */
  active: number;
  /** The most boxes that it has been in at once. */
  maxActive: number;
}

/** What a step found. The arrays are copies. */
export interface Step {
  /** The overlapping pairs, in the order of the method: `a0, b0, a1, b1, ...`. */
  pairs: Uint32Array;
  /** The pairs that the previous step did not have, sorted. */
  begun: Uint32Array;
  /** The pairs that only the previous step had, sorted. */
  ended: Uint32Array;
  /** The axis that was swept, or swept first. */
  axis: number;
  /** What was done. */
  counts: Counts;
  /** The memory that the algorithm uses, in bytes. */
  bytes: number;
}

/**
 * Runs one of the classic algorithms, step by step, and records what it does. To find pairs fast, use
 * `findPairs` of `sweep-and-prune`.
 *
 * ```js
 * const runner = new Runner({ dimensions: 1, method: "swap-driven sweep", persistent: true });
 * runner.step([0, 2, 1, 3]).pairs; // Uint32Array [0, 1]
 * ```
 */
export class Runner {
  readonly #dimensions: Dimensions;
  readonly #handle: Handle<AlgorithmsExports>;

  /**
   * A new runner; or a copy of another runner, with the same state and trace, which continues as that
   * one would. Free each of them.
   *
   * @throws {@link NotInitializedError} before `init()` is done; `RangeError` for a name that does
   *   not exist, or an axis or dimensions that do not.
   */
  constructor(options: RunnerOptions | Runner) {
    if (options instanceof Runner) {
      this.#dimensions = options.#dimensions;
      this.#handle = own(options.#handle.engine, options.#handle.call((exports, runner) => exports.runner_copy(runner)));
      forgotten?.register(this, this.#handle);
      return;
    }
    this.#dimensions = checkDimensions(options?.dimensions);
    const { method, sort = "standard library", axis = "largest variance", persistent = false } = options;
    const { focus = 0, traceWords = 0 } = options;
    for (const [name, value] of [["focus", focus], ["traceWords", traceWords]] as const) {
      if (!(Number.isInteger(value) && value >= 0 && value < 2 ** 32)) {
        throw new RangeError(`\`${name}\` is ${describe(value)}; it must be a whole number from 0 to 2^32 - 1`);
      }
    }
    if (typeof persistent !== "boolean") throw new TypeError(`\`persistent\` must be true or false, not ${describe(persistent)}`);
    const isFixed = typeof axis === "number";
    if (isFixed && !(Number.isInteger(axis) && axis >= 0 && axis < this.#dimensions)) {
      throw new RangeError(`axis ${axis} does not exist in ${this.#dimensions} dimensions`);
    }
    if (typeof method !== "string") refuseName("method", method);
    checkName("sort", sort, sorts);
    if (!isFixed) checkName("axis", axis, axes);
    const engine = algorithmsCore.engine();
    this.#handle = own(engine, engine.call((exports) => exports.runner_new(this.#dimensions, traceWords)));
    forgotten?.register(this, this.#handle);
    const isVariant = (): boolean => this.#handle.call((exports, runner) => exports.runner_choose_variant?.(runner)) === 1;
    if (!this.#choose(0, method, focus) && !isVariant()) {
      this.free();
      refuseName("method", method);
    }
    this.#choose(1, sort, 0);
    this.#choose(2, isFixed ? "fixed axis" : axis, isFixed ? axis : 0);
    engine.check(this.#handle.call((exports, runner) => exports.runner_start(runner, persistent ? 1 : 0)));
  }

  /** How many dimensions the boxes have. */
  get dimensions(): Dimensions {
    return this.#dimensions;
  }

  /**
   * Finds the pairs of these boxes. A box is its row: the third in one step is the third in the
   * next.
   *
   * @throws {@link InvalidBoxError}; then nothing has changed.
   */
  step(boxes: Boxes): Step {
    const rows = checkBoxes(boxes, this.#dimensions);
    const length = lengthOf(rows);
    const count = length / (2 * this.#dimensions);
    checkFits(8 * length);
    const handle = this.#handle;
    const { engine } = handle;
    const at = handle.call((exports, runner) => exports.runner_rows(runner, count)) >>> 0;
    if (at === 0) throw new OutOfMemoryError();
    new Float64Array(engine.buffer, at, length).set(rows);
    const d = this.#dimensions;
    engine.check(handle.call((exports, runner) => exports.runner_step(runner, count)), {}, (_, index, axis) => [rows[2 * d * index + axis]!, rows[2 * d * index + d + axis]!]);
    const numbers = new Float64Array(engine.buffer, engine.detail(0), engine.detail(1));
    const [axis = 0, bytes = 0] = numbers;
    const counts = readCounts(numbers, 2);
    return { pairs: this.#list(0), begun: this.#list(1), ended: this.#list(2), axis, counts, bytes };
  }

  /** A copy of the words recorded so far. {@link events} decodes them. */
  trace(): Uint32Array<ArrayBuffer> {
    return this.#list(3);
  }

  /** Whether something was not recorded because of the limit. */
  get isTruncated(): boolean {
    return this.#handle.call((exports, runner) => exports.runner_is_truncated(runner)) !== 0;
  }

  /** Clears the recording. */
  clearTrace(): void {
    this.#handle.call((exports, runner) => exports.runner_clear_trace(runner));
  }

  /**
   * Clears the recording except for what the next step continues from: the arrays, the axis overlaps
   * and the current pairs are then its only events. With this, each step has a trace of its own that a
   * {@link Player} can play. The time depends on the length of the recording. Of one that {@link Runner.isTruncated}
   * they are those of its last event, and the next step's trace begins with them.
   *
   * @returns how many events remain.
   */
  trimTrace(): number {
    return this.#handle.call((exports, runner) => exports.runner_trim_trace(runner)) >>> 0;
  }

  /** @internal The handle of a player of what was recorded. */
  newPlayer(): Handle<AlgorithmsExports> {
    const player = this.#handle.call((exports, runner) => exports.player_new(runner));
    return new Handle(this.#handle.engine, player, "Player", (exports, player) => exports.player_free(player));
  }

  /** Frees the memory. Freeing it twice is not an error. */
  free(): void {
    this.#handle.free();
  }

  /** As {@link Runner.free}, for `using`. */
  [Symbol.dispose](): void {
    this.free();
  }

  /** Whether the compiled algorithms know the name. */
  #choose(part: number, name: string, index: number): boolean {
    const { engine } = this.#handle;
    const text = new TextEncoder().encode(name);
    const at = this.#handle.call((exports, runner) => exports.runner_text(runner, text.length)) >>> 0;
    new Uint8Array(engine.buffer, at, text.length).set(text);
    return this.#handle.call((exports, runner) => exports.runner_choose(runner, part, index)) !== 0;
  }

  #list(which: number): Uint32Array<ArrayBuffer> {
    const { engine } = this.#handle;
    engine.check(this.#handle.call((exports, runner) => exports.runner_list(runner, which)));
    return new Uint32Array(engine.buffer, engine.detail(0), engine.detail(1)).slice();
  }
}

/** @internal Counts in the order in which classroom/algorithms/wasm/src/numbers.rs has them. */
export function readCounts(numbers: Float64Array, from: number): Counts {
  const [comparisons = 0, swaps = 0, tests = 0, axisOverlaps = 0, axisEnds = 0] = numbers.subarray(from);
  const [pairs = 0, begun = 0, ended = 0, active = 0, maxActive = 0] = numbers.subarray(from + 5);
  return { comparisons, swaps, tests, axisOverlaps, axisEnds, pairs, begun, ended, active, maxActive };
}

function own(engine: Engine<AlgorithmsExports>, runner: number): Handle<AlgorithmsExports> {
  return new Handle(engine, runner, "Runner", (exports, runner) => exports.runner_free(runner));
}

function checkName(kind: string, name: unknown, names: readonly string[]): void {
  if (typeof name !== "string" || !names.includes(name)) refuseName(kind, name);
}

function refuseName(kind: string, name: unknown): never {
  throw new RangeError(`there is no ${kind} named ${typeof name === "string" ? `"${name}"` : describe(name)}`);
}
