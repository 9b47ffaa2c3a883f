/// <reference lib="esnext.disposable" preserve="true" />
import { type BoxObject, type Boxes, checkBoxes, checkDimensions, type Dimensions, dimensionsOf, writeRows } from "./boxes.js";
import { describe } from "./describe.js";
import { checkFits, Core, type Each, type Engine, type Exports, type Passed } from "./engine.js";
import { OutOfMemoryError } from "./errors.js";
import { checkViews, result, view } from "./views.js";

/** Options of a search. */
export interface FindPairsOptions {
  /** How many dimensions the boxes have. Boxes that are objects tell it themselves, and need no options. */
  dimensions: Dimensions;
}

/** Options of a {@link PairFinder}. */
export interface PairFinderOptions extends FindPairsOptions {
  /**
   * Whether `find` and `findBetween` return views of WebAssembly's memory, which save the time of a copy.
   * A view is valid until the next call of anything in this package: that call may overwrite it, or let
   * the memory grow, which leaves the view with length 0. False by default.
   */
  views?: boolean;
}

/** Is called with each pair. If it returns `false`, it is not called again. */
export type EachPair = (a: number, b: number) => unknown;

/** What js/wasm/src/finder.rs exports. */
interface FinderExports extends Exports {
  finder_new(dimensions: number, double: number): number;
  finder_rows(finder: number, set: number, count: number): number;
  finder_find(finder: number, a: number, b: number, use: Use): number;
  finder_free(finder: number): void;
}

/** What happens to the pairs; js/wasm/src/finder.rs has the same list. */
const enum Use {
  Store = 0,
  Count = 1,
  Stream = 2,
}

/** Instead of the size of the second set, if there is only one set. */
const noSet = -1;

/** Instead of the second set, if there is only one set. */
const alone = Symbol("no second set");

/** The core that finds pairs. */
export const finderCore: Core<FinderExports> = new Core("finder_new", "sweep-and-prune");

/**
 * Finds all pairs of boxes that overlap. The result holds indices of boxes, two a pair:
 * `a0, b0, a1, b1, ...`. Each pair is listed once, with the smaller index first, in a deterministic
 * order.
 *
 * Touching boxes overlap. Points, flat boxes and infinite edges are allowed. To find pairs many times, keep a {@link PairFinder}, which reuses its buffers.
 *
 * Time O(n log n + pairs) on typical inputs, memory O(n + pairs).
 *
 * @throws {@link InvalidBoxError} for the first box that is inverted or NaN.
 * @throws {@link OutOfMemoryError} if the boxes or their pairs do not fit in memory.
 * @throws {@link NotInitializedError} before `init()` is done.
 * @throws `TypeError` if `boxes` is of another type or its buffer is detached.
 * @throws `RangeError` if `boxes` is not whole rows, or `dimensions` is not 1, 2 or 3.
 *
 * @example
 * ```js
 * const boxes = new Float32Array([0, 0, 2, 2,  5, 5, 6, 6,  2, 1, 3, 4]);
 * findPairs(boxes, { dimensions: 2 }); // Uint32Array [0, 2]
 * ```
 */
export function findPairs(boxes: readonly BoxObject[], options?: FindPairsOptions): Uint32Array<ArrayBuffer>;
export function findPairs(boxes: Boxes, options: FindPairsOptions): Uint32Array<ArrayBuffer>;
export function findPairs(boxes: Boxes, options?: FindPairsOptions): Uint32Array<ArrayBuffer> {
  return once([boxes], options, (finder) => finder.find(boxes));
}

/**
 * Finds all pairs of a box of `a` and a box of `b` that overlap: `a0, b0, a1, b1, ...`, the index in
 * `a` first. If one set is in double precision, all boxes are compared in double precision.
 * Otherwise it works as {@link findPairs}.
 *
 * @throws As {@link findPairs}; an {@link InvalidBoxError} names the set by its `argument`.
 *
 * @example
 * ```js
 * const bullets = [0, 0, 1, 1,  5, 5, 6, 6];
 * const targets = [4, 4, 7, 7];
 * findPairsBetween(bullets, targets, { dimensions: 2 }); // Uint32Array [1, 0]
 * ```
 */
export function findPairsBetween(
  a: readonly BoxObject[],
  b: readonly BoxObject[],
  options?: FindPairsOptions,
): Uint32Array<ArrayBuffer>;
export function findPairsBetween(a: Boxes, b: Boxes, options: FindPairsOptions): Uint32Array<ArrayBuffer>;
export function findPairsBetween(a: Boxes, b: Boxes, options?: FindPairsOptions): Uint32Array<ArrayBuffer> {
  return once([a, b], options, (finder) => finder.findBetween(a, b));
}

/**
 * Counts the pairs that {@link findPairs} would find, without storing them.
 *
 * @throws As {@link findPairs}.
 */
export function countPairs(boxes: readonly BoxObject[], options?: FindPairsOptions): number;
export function countPairs(boxes: Boxes, options: FindPairsOptions): number;
export function countPairs(boxes: Boxes, options?: FindPairsOptions): number {
  return once([boxes], options, (finder) => finder.count(boxes));
}

/**
 * Calls `each(a, b)` with every pair that {@link findPairs} would find, in the same order, until
 * `each` returns `false`. Stores only a small buffer of pairs. Returns `false` if `each` did.
 *
 * @throws As {@link findPairs}, before the first call of `each`; and what `each` throws.
 */
export function forEachPair(boxes: Boxes, options: FindPairsOptions, each: EachPair): boolean {
  return once([boxes], options, (finder) => finder.forEach(boxes, each));
}

/** Without options, boxes that are objects tell how many dimensions they have. No boxes have any number. */
function once<R>(sets: readonly Boxes[], options: FindPairsOptions | undefined, use: (finder: PairFinder) => R): R {
  const areNone = sets.every((boxes) => Array.isArray(boxes) && boxes.length === 0);
  const dimensions = options ? options.dimensions : areNone ? 1 : sets.map(dimensionsOf).find(Boolean);
  if (!options && !dimensions) throw new RangeError("`options` is missing: flat arrays of boxes need `{ dimensions: 1 }`, 2 or 3");
  const finder = new PairFinder({ dimensions: dimensions! });
  try {
    return use(finder);
  } finally {
    finder.free();
  }
}

/**
 * Finds pairs many times and keeps its memory in between, as much as its largest input and result needed.
 * With the option `views` a call that needs no more memory than those before it allocates nothing.
 *
 * ```js
 * using finder = new PairFinder({ dimensions: 2 });
 * const pairs = finder.find(boxes);
 * for (let i = 0; i < pairs.length; i += 2) collide(pairs[i], pairs[i + 1]);
 * ```
 *
 * Its memory is freed by `using`, by {@link PairFinder.free}, or some time after the last reference
 * to it is gone.
 */
export class PairFinder {
  /** How many dimensions the boxes have. */
  readonly dimensions: Dimensions;
  readonly #owned: Owned;
  readonly #rows: [Rows?, Rows?] = [];
  readonly #isView: boolean;
  #pairs: Uint32Array<ArrayBuffer> | undefined;

  /**
   * A finder with empty buffers.
   *
   * @throws {@link NotInitializedError} before `init()` is done.
   * @throws `RangeError` if `dimensions` is not 1, 2 or 3; `TypeError` if `views` is not a boolean.
   */
  constructor(options: PairFinderOptions) {
    this.dimensions = checkDimensions(options?.dimensions);
    this.#isView = checkViews(options.views);
    this.#owned = { engine: finderCore.engine(), single: 0, double: 0, isBusy: false, isFreed: false };
    forgotten?.register(this, this.#owned, this.#owned);
  }

  /**
   * Finds the pairs of {@link findPairs}. With the option `views` the result is a view, valid until the
   * next call.
   *
   * @throws As {@link findPairs}, and `TypeError` if the finder was freed. It stays usable.
   */
  find(boxes: Boxes): Uint32Array<ArrayBuffer> {
    return this.#store(boxes, alone);
  }

  /**
   * Finds the pairs of {@link findPairsBetween}, otherwise as {@link PairFinder.find}.
   *
   * @throws As {@link findPairsBetween}, and `TypeError` if the finder was freed.
   */
  findBetween(a: Boxes, b: Boxes): Uint32Array<ArrayBuffer> {
    return this.#store(a, b);
  }

  /**
   * Counts the pairs of {@link findPairs}, without storing them.
   *
   * @throws As {@link countPairs}, and `TypeError` if the finder was freed.
   */
  count(boxes: Boxes): number {
    return this.#count(boxes, alone);
  }

  /**
   * Counts the pairs of {@link findPairsBetween}, without storing them.
   *
   * @throws As {@link PairFinder.findBetween}.
   */
  countBetween(a: Boxes, b: Boxes): number {
    return this.#count(a, b);
  }

  /**
   * Calls `each` as {@link forEachPair} does. Within `each` this finder cannot be used; others can.
   *
   * @throws As {@link forEachPair}, and `TypeError` if the finder was freed.
   */
  forEach(boxes: Boxes, each: EachPair): boolean {
    return this.#stream(each, boxes, alone);
  }

  /**
   * Calls `each` with the pairs of {@link findPairsBetween}, otherwise as {@link PairFinder.forEach}.
   *
   * @throws As {@link PairFinder.findBetween}; and what `each` throws.
   */
  forEachBetween(a: Boxes, b: Boxes, each: EachPair): boolean {
    return this.#stream(each, a, b);
  }

  #store(a: Boxes, b: Boxes | typeof alone): Uint32Array<ArrayBuffer> {
    const { engine } = this.#owned;
    this.#search(Use.Store, a, b, undefined);
    const { buffer } = engine.exports.memory;
    this.#pairs = view<Uint32Array<ArrayBuffer>>(Uint32Array, this.#pairs, buffer, engine.detail(0), 2 * engine.detail(1));
    return result(engine, this.#pairs, this.#isView);
  }

  #count(a: Boxes, b: Boxes | typeof alone): number {
    const { engine } = this.#owned;
    this.#search(Use.Count, a, b, undefined);
    return engine.detail(0) + 2 ** 32 * engine.detail(1);
  }

  #stream(each: EachPair, a: Boxes, b: Boxes | typeof alone): boolean {
    if (typeof each !== "function") throw new TypeError(`\`each\` must be a function, not ${describe(each)}`);
    const { engine } = this.#owned;
    let isComplete = true;
    this.#search(Use.Stream, a, b, (at, count) => {
      const begin = at / 4;
      for (let word = begin; word < begin + 2 * count; word += 2) {
        const words = engine.words();
        isComplete = each(words[word]!, words[word + 1]!) !== false;
        if (!isComplete) break;
      }
      return isComplete;
    });
    return isComplete;
  }

  #search(use: Use, a: Boxes, b: Boxes | typeof alone, each: Each | undefined): void {
    const owned = this.#owned;
    // First of all: this reads objects, and a getter may do anything.
    const first = checkBoxes(a, this.dimensions, b === alone ? "boxes" : "a");
    const second = b === alone ? undefined : checkBoxes(b, this.dimensions, "b");
    if (owned.isFreed) throw new TypeError("this PairFinder was freed");
    if (owned.isBusy) throw new TypeError("this PairFinder is in use: within its callback, use another one");
    const isDouble = (first.BYTES_PER_ELEMENT | (second?.BYTES_PER_ELEMENT ?? 0)) >= 8;
    // The core has no type for 1D boxes, nor for 2D in double precision: see js/wasm/src/finder.rs.
    const stored = isDouble ? 3 : (Math.max(2, this.dimensions) as Dimensions);
    owned.isBusy = true;
    try {
      const { engine } = owned;
      engine.calls++;
      const finder = (owned[isDouble ? "double" : "single"] ||= engine.exports.finder_new(stored, Number(isDouble)));
      const countA = this.#write(finder, 0, first, isDouble, stored);
      const countB = second ? this.#write(finder, 1, second, isDouble, stored) : noSet;
      const passed: Passed = { boxes: second ? [["a", countA], ["b", countB]] : [["boxes", countA]] };
      if (each) engine.stream(() => engine.exports.finder_find(finder, countA, countB, use), each, passed);
      else engine.check(engine.exports.finder_find(finder, countA, countB, use), passed);
    } catch (error) {
      // A finder that ran out of memory should not keep what it allocated.
      if (error instanceof OutOfMemoryError) release(owned);
      throw error;
    } finally {
      owned.isBusy = false;
    }
  }

  /** Writes the rows of a set, and returns how many boxes there are. */
  #write(finder: number, set: 0 | 1, rows: Rows, isDouble: boolean, stored: Dimensions): number {
    const { exports } = this.#owned.engine;
    const count = rows.length / (2 * this.dimensions);
    const length = 2 * stored * count;
    checkFits(length * (isDouble ? 8 : 4));
    const at = exports.finder_rows(finder, set, count) >>> 0;
    if (at === 0) throw new OutOfMemoryError();
    const { buffer } = exports.memory;
    const into = isDouble
      ? view(Float64Array, this.#rows[set], buffer, at, length)
      : view(Float32Array, this.#rows[set], buffer, at, length);
    this.#rows[set] = into;
    writeRows(rows, this.dimensions, into, stored);
    return count;
  }

  /**
   * Frees the memory. The finder cannot be used any more. Freeing it twice is not an error.
   *
   * @throws `TypeError` within the callback of its own `forEach`.
   */
  free(): void {
    if (this.#owned.isFreed) return;
    if (this.#owned.isBusy) throw new TypeError("this PairFinder is in use: free it after its callback");
    this.#owned.isFreed = true;
    forgotten?.unregister(this.#owned);
    release(this.#owned);
  }

  /** As {@link PairFinder.free}, for `using`. */
  [Symbol.dispose](): void {
    this.free();
  }
}

type Rows = Float32Array | Float64Array;

/** The handles of the core's finders, one for each precision, or 0. */
interface Owned {
  readonly engine: Engine<FinderExports>;
  single: number;
  double: number;
  /** Whether a call is running: then Rust uses the handle, and only a callback can call us. */
  isBusy: boolean;
  isFreed: boolean;
}

function release(owned: Owned): void {
  const { finder_free } = owned.engine.exports;
  if (owned.single !== 0) finder_free(owned.single);
  if (owned.double !== 0) finder_free(owned.double);
  owned.single = owned.double = 0;
}

/** Frees the handles of finders that were garbage collected. */
const forgotten =
  typeof FinalizationRegistry === "undefined" ? undefined : new FinalizationRegistry<Owned>(release);
