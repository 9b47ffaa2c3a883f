/// <reference lib="esnext.disposable" preserve="true" />
import { type Boxes, checkBoxes, checkDimensions, type Dimensions } from "./boxes.js";
import { engine, type Engine } from "./engine.js";
import { OutOfMemoryError } from "./errors.js";

/** How to find pairs. */
export interface FindPairsOptions {
  /** How many dimensions the boxes have. */
  dimensions: Dimensions;
}

/**
 * All pairs of boxes that overlap: `a0, b0, a1, b1, ...`, indices of boxes, each pair once and
 * its smaller index first, in a deterministic order.
 *
 * Touching boxes overlap. Points, flat boxes and infinite edges are allowed. The result is a copy
 * of your own; nothing else is kept. To find pairs again and again, keep a {@link PairFinder}.
 *
 * Time O(n log n + overlaps on the sweep axis), memory O(n + pairs).
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
export function findPairs(boxes: Boxes, options: FindPairsOptions): Uint32Array<ArrayBuffer> {
  const finder = new PairFinder(options);
  try {
    return copy(finder.find(boxes));
  } finally {
    finder.free();
  }
}

function copy(pairs: Uint32Array): Uint32Array<ArrayBuffer> {
  try {
    return new Uint32Array(pairs);
  } catch {
    throw new OutOfMemoryError(); // the copy is what JavaScript itself could not allocate
  }
}

/**
 * Finds pairs again and again, and keeps its buffers in between: where the sizes are those of the
 * last call, nothing is allocated.
 *
 * ```js
 * using finder = new PairFinder({ dimensions: 2 });
 * const pairs = finder.find(boxes);
 * for (let i = 0; i < pairs.length; i += 2) collide(pairs[i], pairs[i + 1]);
 * ```
 *
 * Its memory comes back when it is freed: by `using`, by {@link PairFinder.free}, or at some time
 * after the last reference to it is gone.
 */
export class PairFinder {
  /** How many dimensions the boxes have. */
  readonly dimensions: Dimensions;
  readonly #owned: Owned;
  #rows: Float32Array | Float64Array | undefined;
  #pairs: Uint32Array | undefined;

  /**
   * A finder with empty buffers.
   *
   * @throws {@link NotInitializedError} before `init()` is done.
   * @throws `RangeError` if `dimensions` is not 1, 2 or 3.
   */
  constructor(options: FindPairsOptions) {
    this.dimensions = checkDimensions(options?.dimensions);
    this.#owned = { engine: engine(), single: 0, double: 0, isFreed: false };
    forgotten?.register(this, this.#owned, this.#owned);
  }

  /**
   * As {@link findPairs}, but the result is a view of this package's memory, valid until the next
   * call of anything in this package: that may overwrite it, or let the memory grow, which leaves
   * the view with length 0. Copy it (`pairs.slice()`) to keep it.
   *
   * @throws As {@link findPairs}, and `TypeError` if the finder was freed. It stays usable.
   */
  find(boxes: Boxes): Uint32Array {
    const owned = this.#owned;
    if (owned.isFreed) throw new TypeError("this PairFinder was freed");
    const rows = checkBoxes(boxes, this.dimensions);
    try {
      return this.#find(rows, rows.length / (2 * this.dimensions));
    } catch (error) {
      // Whoever ran out of memory should not go on holding what it got.
      if (error instanceof OutOfMemoryError) release(owned);
      throw error;
    }
  }

  #find(rows: Float32Array | Float64Array, count: number): Uint32Array {
    const owned = this.#owned;
    const { engine } = owned;
    const { exports } = engine;
    const precision = rows.BYTES_PER_ELEMENT === 8 ? "double" : "single";
    const finder = (owned[precision] ||= exports.finder_new(this.dimensions, Number(precision === "double")));
    const at = exports.finder_rows(finder, count) >>> 0;
    if (at === 0) throw new OutOfMemoryError();
    const { buffer } = exports.memory;
    this.#rows =
      precision === "double"
        ? view(Float64Array, this.#rows, buffer, at, rows.length)
        : view(Float32Array, this.#rows, buffer, at, rows.length);
    this.#rows.set(rows);
    engine.check(exports.finder_find(finder, count));
    this.#pairs = view(Uint32Array, this.#pairs, exports.memory.buffer, engine.detail(0), 2 * engine.detail(1));
    return this.#pairs;
  }

  /** Gives the memory back. The finder cannot be used any more; to free it twice is no error. */
  free(): void {
    if (this.#owned.isFreed) return;
    this.#owned.isFreed = true;
    forgotten?.unregister(this.#owned);
    release(this.#owned);
  }

  /** As {@link PairFinder.free}, for `using`. */
  [Symbol.dispose](): void {
    this.free();
  }
}

/** What a finder holds on the other side: a handle for each precision, or 0. */
interface Owned {
  readonly engine: Engine;
  single: number;
  double: number;
  isFreed: boolean;
}

function release(owned: Owned): void {
  const { finder_free } = owned.engine.exports;
  if (owned.single !== 0) finder_free(owned.single);
  if (owned.double !== 0) finder_free(owned.double);
  owned.single = owned.double = 0;
}

/** Frees the finders that nobody freed and nobody can reach. */
const forgotten =
  typeof FinalizationRegistry === "undefined" ? undefined : new FinalizationRegistry<Owned>(release);

type View = Float32Array | Float64Array | Uint32Array;

/** The last view if it still is the one asked for, which saves the garbage, or a new one. */
function view<T extends View>(
  Type: new (buffer: ArrayBuffer, at: number, length: number) => T,
  last: View | undefined,
  buffer: ArrayBuffer,
  at: number,
  length: number,
): T {
  const isSame =
    last instanceof Type && last.buffer === buffer && last.byteOffset === at && last.length === length;
  return isSame ? last : new Type(buffer, at, length);
}
