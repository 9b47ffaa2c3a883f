/// <reference lib="esnext.disposable" preserve="true" />
import { type BoxObject, type Boxes, checkBoxes, checkDimensions, type Dimensions, isNamed, readAlike, writeRows } from "../boxes/boxes.js";
import { dimensionsOf } from "../boxes/dimensions-of.js";
import { describe } from "../wasm/describe.js";
import { checkFits, Code, type Each, type Engine, type Exports } from "../wasm/engine.js";
import { InterruptedError, InvalidBoxError, OutOfMemoryError } from "../wasm/errors.js";
import { forgotten, Handle } from "../wasm/handle.js";
import { Core } from "../wasm/init.js";
import { checkOptionNames } from "../wasm/options.js";
import { chunksOf } from "./chunks.js";
import { dropMissing, renamePairs } from "./missing.js";
import { streamPairs } from "./stream.js";
import { lengthOf, tagOf } from "../wasm/typed.js";
import { allocate, checkViews, copy, guard, view } from "../wasm/views.js";

/** Options of a search. */
export interface FindPairsOptions {
  /** How many dimensions the boxes have. Boxes that are objects tell it themselves, and need no options. */
  dimensions: Dimensions;
  /**
   * What is done with a box that has a NaN, and with one that is empty (its min is `Infinity` and its max `-Infinity`, as
   * bounds of nothing in three.js and Pixi). `"raise"`, the default: the call throws {@link InvalidBoxError}. `"skip"`:
   * the box has no pairs; the indices of the others stay. So a pool can keep its free slots: fill them with NaN.
   */
  missing?: "raise" | "skip";
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

/** Is called with the indices of each pair. If it returns `false`, it is not called again. */
export type EachPair = (a: number, b: number) => unknown;

/** Where pairs are written: two indices a pair. Its buffer may be shared with workers. */
export type PairsInto = Uint32Array | Int32Array;

/** What js/wasm/src/finder.rs exports. */
interface FinderExports extends Exports {
  finder_new(dimensions: number, double: number): number;
  finder_rows(finder: number, set: number, count: number): number;
  finder_find(finder: number, a: number, b: number, chunk: Chunk): number;
  finder_free(finder: number): void;
}

/** How many pairs the core collects before it hands them over. */
const enum Chunk {
  /** It only counts them. */
  None = 0,
  /** The first ones at once: one is enough. */
  First = 1,
  /** For a callback: small, so that it stays in the cache. */
  Small = 4096,
  /** For a result that is copied: 8 MB, so that few results take more than one. */
  Large = 2 ** 20,
  /** All of them: for a view. */
  All = 2 ** 32 - 1,
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
 * order. Without options, for boxes that are objects, it holds the pairs of the objects themselves,
 * `[[a0, b0], [a1, b1], ...]`, in the same order.
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
export function findPairs<T extends BoxObject>(items: readonly T[]): [T, T][];
export function findPairs(boxes: Boxes, options: FindPairsOptions): Uint32Array<ArrayBuffer>;
export function findPairs(boxes: Boxes, options?: FindPairsOptions): Uint32Array<ArrayBuffer> | [unknown, unknown][] {
  const pairs = once([["boxes", boxes]], options, (finder, rows) => finder.find(rows!));
  return options === undefined ? itemsOf(pairs, boxes, boxes) : pairs;
}

/**
 * Finds all pairs of a box of `a` and a box of `b` that overlap: `a0, b0, a1, b1, ...`, the index in
 * `a` first. If one set is in double precision, all boxes are compared in double precision.
 * Otherwise it works as {@link findPairs}. A set with itself gives each pair both ways round, and each box with itself.
 *
 * It answers thousands of questions of the form "which boxes does this one overlap?" at once, with
 * the questions in `a`: faster than one by one, and without an index to build first.
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
export function findPairsBetween<A extends BoxObject, B extends BoxObject>(a: readonly A[], b: readonly B[]): [A, B][];
export function findPairsBetween(a: Boxes, b: Boxes, options: FindPairsOptions): Uint32Array<ArrayBuffer>;
export function findPairsBetween(
  a: Boxes,
  b: Boxes,
  options?: FindPairsOptions,
): Uint32Array<ArrayBuffer> | [unknown, unknown][] {
  const pairs = once([["a", a], ["b", b]], options, (finder, rowsA, rowsB) => finder.findBetween(rowsA!, rowsB!));
  return options === undefined ? itemsOf(pairs, a, b) : pairs;
}

/**
 * Counts the pairs that {@link findPairs} would find, without storing them.
 *
 * @throws As {@link findPairs}.
 */
export function countPairs(boxes: readonly BoxObject[], options?: FindPairsOptions): number;
export function countPairs(boxes: Boxes, options: FindPairsOptions): number;
export function countPairs(boxes: Boxes, options?: FindPairsOptions): number {
  return once([["boxes", boxes]], options, (finder, rows) => finder.count(rows!));
}

/**
 * Whether any two boxes overlap. It stops at the first pair that it finds.
 *
 * @throws As {@link findPairs}.
 */
export function anyPair(boxes: readonly BoxObject[], options?: FindPairsOptions): boolean;
export function anyPair(boxes: Boxes, options: FindPairsOptions): boolean;
export function anyPair(boxes: Boxes, options?: FindPairsOptions): boolean {
  return once([["boxes", boxes]], options, (finder, rows) => finder.any(rows!));
}

/**
 * Calls `each(a, b)` with every pair that {@link findPairs} would find, in the same order, until
 * `each` returns `false`. Stores only a small buffer of pairs. Returns `false` if `each` did. Without
 * options, for boxes that are objects, `each` gets the objects themselves.
 *
 * @throws As {@link findPairs}, before the first call of `each`; and what `each` throws.
 */
export function forEachPair<T extends BoxObject>(items: readonly T[], each: (a: T, b: T) => unknown): boolean;
export function forEachPair(boxes: Boxes, options: FindPairsOptions, each: EachPair): boolean;
export function forEachPair<T extends BoxObject>(
  boxes: Boxes,
  options: FindPairsOptions | ((a: T, b: T) => unknown),
  each?: EachPair,
): boolean {
  if (typeof options !== "function") return once([["boxes", boxes]], options, (finder, rows) => finder.forEach(rows!, each!));
  const items = boxes as readonly T[];
  return once([["boxes", boxes]], undefined, (finder, rows) => finder.forEach(rows!, (a, b) => options(items[a]!, items[b]!)));
}

/** Without options, boxes that are objects tell how many dimensions they have. No boxes have any number. */
function once<R>(sets: readonly Set[], options: FindPairsOptions | undefined, use: (finder: PairFinder, ...sets: Boxes[]) => R): R {
  const missing = sets.find(([, boxes]) => boxes === undefined || (options === undefined && isNamed(boxes) && "dimensions" in boxes));
  if (missing) throw new TypeError(`\`${missing[0]}\` is missing`);
  if (Array.isArray(options) || ArrayBuffer.isView(options)) {
    throw new TypeError("`options` is a set of boxes: the pairs between two sets are found by `findPairsBetween`, `countBetween`, `anyBetween` and `forEachBetween`");
  }
  if (options !== undefined) checkOptionNames(options, findOptions);
  const dimensions = options ? options.dimensions : dimensionsOf(sets);
  const rows = options ? sets.map(([, boxes]) => boxes) : sets.map(([name, boxes]) => readAlike(boxes as readonly unknown[], dimensions, name));
  const finder = new PairFinder(options ?? { dimensions });
  try {
    return use(finder, ...rows);
  } finally {
    finder.free();
  }
}

/** A set of boxes with the name of its argument. */
type Set = readonly [name: string, boxes: Boxes];

const findOptions = ["dimensions", "missing"];
const finderOptions = [...findOptions, "views"];

/** The pairs of the items that pairs of indices name. */
function itemsOf(pairs: Uint32Array, a: Boxes, b: Boxes): [unknown, unknown][] {
  return Array.from({ length: pairs.length / 2 }, (_, pair) => [a[pairs[2 * pair]!], b[pairs[2 * pair + 1]!]]);
}

/**
 * Finds pairs many times and keeps its memory in between: as much as its largest input needed, and of
 * pairs at most 16 MB. With the option `views` it also keeps as much as its largest result needed, and a
 * call that needs no more memory than those before it allocates nothing.
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
  readonly #dimensions: Dimensions;
  readonly #owned: Owned;
  readonly #rows: [Rows?, Rows?] = [];
  readonly #isView: boolean;
  readonly #skipsMissing: boolean;
  #pairs: Uint32Array<ArrayBuffer> | undefined;

  /**
   * A finder with empty buffers.
   *
   * @throws {@link NotInitializedError} before `init()` is done.
   * @throws `RangeError` if `dimensions` is not 1, 2 or 3; `TypeError` if `views` is not a boolean, or an option does not
   *   exist.
   */
  constructor(options: PairFinderOptions) {
    checkOptionNames(options, finderOptions);
    this.#dimensions = checkDimensions(options.dimensions);
    this.#isView = checkViews(options.views);
    this.#skipsMissing = checkMissing(options.missing);
    this.#owned = new Owned(finderCore.engine());
    forgotten?.register(this, this.#owned);
  }

  /** How many dimensions the boxes have. */
  get dimensions(): Dimensions {
    return this.#dimensions;
  }

  /**
   * Finds the pairs of {@link findPairs}. With the option `views` the result is a view, valid until the
   * next call.
   *
   * @throws As {@link findPairs}, and `TypeError` if the finder was freed. It stays usable.
   */
  find(boxes: Boxes): Uint32Array<ArrayBuffer>;
  find(boxes: Boxes, more?: unknown): Uint32Array<ArrayBuffer> {
    if (typeof more === "object") refuseSecond("find");
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
   * Writes the pairs of {@link findPairs} to an array of yours, which may be shared with workers, and
   * returns how many pairs there are. If the array is too short for them, it has the first ones.
   *
   * @throws As {@link PairFinder.find}; `TypeError` if `into` is not a `Uint32Array` or `Int32Array`.
   *
   * @example
   * ```js
   * const into = new Uint32Array(new SharedArrayBuffer(8 * 1000)); // up to 1,000 pairs
   * const count = finder.findInto(boxes, into);
   * for (let i = 0; i < 2 * count; i += 2) collide(into[i], into[i + 1]);
   * ```
   */
  findInto(boxes: Boxes, into: PairsInto): number {
    return this.#write(into, boxes, alone);
  }

  /**
   * Writes the pairs of {@link findPairsBetween}, otherwise as {@link PairFinder.findInto}.
   *
   * @throws As {@link PairFinder.findBetween} and {@link PairFinder.findInto}.
   */
  findBetweenInto(a: Boxes, b: Boxes, into: PairsInto): number {
    return this.#write(into, a, b);
  }

  /**
   * Whether any two boxes overlap. It stops at the first pair that it finds.
   *
   * @throws As {@link PairFinder.count}.
   */
  any(boxes: Boxes): boolean;
  any(boxes: Boxes, more?: unknown): boolean {
    if (typeof more === "object") refuseSecond("any");
    return this.#any(boxes, alone);
  }

  /**
   * Whether any box of `a` overlaps one of `b`. It stops at the first pair that it finds.
   *
   * @throws As {@link PairFinder.findBetween}.
   */
  anyBetween(a: Boxes, b: Boxes): boolean {
    return this.#any(a, b);
  }

  /**
   * Counts the pairs of {@link findPairs}, without storing them.
   *
   * @throws As {@link countPairs}, and `TypeError` if the finder was freed.
   */
  count(boxes: Boxes): number;
  count(boxes: Boxes, more?: unknown): number {
    if (typeof more === "object") refuseSecond("count");
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

  /**
   * Finds the pairs of {@link findPairs}, or with a second set those of {@link findPairsBetween}, chunk by chunk: each array
   * has the pairs of some thousands of boxes, and is found when the loop asks for it. So a server can wait until its client
   * has read what it sent, and holds one chunk. The boxes are copied at once, and may change meanwhile.
   *
   * The chunks are in the order of the boxes along an axis, and each pair is in one of them. All of them take 5 to 10 times
   * as long as one search, and more where many boxes reach through most others on each axis. Most of it goes into sorting the
   * boxes, before the first chunk.
   *
   * @throws As {@link PairFinder.find} and {@link PairFinder.findBetween}, at once; later if the finder was freed, or memory
   *   runs out.
   *
   * @example
   * ```js
   * for (const pairs of finder.chunks(a, b)) {
   *   if (!response.write(new Uint8Array(pairs.buffer))) await once(response, "drain");
   * }
   * ```
   */
  chunks(a: Boxes, b?: Boxes): Generator<Uint32Array<ArrayBuffer>, void, undefined> {
    let first = checkBoxes(a, this.#dimensions, b === undefined ? "boxes" : "a");
    const second = b === undefined ? undefined : checkBoxes(b, this.#dimensions, "b");
    first = checkBoxes(first, this.#dimensions, "a"); // reading the second may have changed the buffer of the first
    this.#owned.checkUsable();
    return chunksOf(first, second, this.#dimensions, this.#skipsMissing, (a, b) => this.#store(a, b ?? alone));
  }

  #store(a: Boxes, b: Boxes | typeof alone): Uint32Array<ArrayBuffer> {
    const { engine } = this.#owned;
    if (this.#isView) {
      this.#search(Chunk.All, a, b, undefined);
      return guard(engine, this.#pairs = this.#rest(this.#pairs));
    }
    const chunks: Uint32Array<ArrayBuffer>[] = [];
    this.#search(Chunk.Large, a, b, (at, count) => {
      chunks.push(copy(new Uint32Array(engine.buffer, at, 2 * count)));
      return true;
    });
    const rest = copy(this.#pairs = this.#rest(this.#pairs));
    return chunks.length === 0 ? rest : joined([...chunks, rest]);
  }

  /** A view of the pairs that the core kept at the end of the last search. */
  #rest(last: Uint32Array<ArrayBuffer> | undefined): Uint32Array<ArrayBuffer> {
    const { engine } = this.#owned;
    return view<Uint32Array<ArrayBuffer>>(Uint32Array, last, engine.buffer, engine.detail(0), 2 * engine.detail(1));
  }

  #write(into: PairsInto, a: Boxes, b: Boxes | typeof alone): number {
    checkInto(into);
    const { engine } = this.#owned;
    let total = 0;
    const write: Each = (at, count) => {
      const fitting = Math.max(0, Math.min(2 * count, lengthOf(into) - 2 * total));
      if (fitting > 0) set.call(into, new Uint32Array(engine.buffer, at, fitting), 2 * total);
      total += count;
      return true;
    };
    this.#search(Chunk.Large, a, b, write);
    write(engine.detail(0), engine.detail(1));
    return total;
  }

  #any(a: Boxes, b: Boxes | typeof alone): boolean {
    let isAny = false;
    this.#search(Chunk.First, a, b, () => {
      isAny = true;
      return false;
    });
    return isAny;
  }

  #count(a: Boxes, b: Boxes | typeof alone): number {
    const { engine } = this.#owned;
    this.#search(Chunk.None, a, b, undefined);
    return engine.detail(0) + 2 ** 32 * engine.detail(1);
  }

  #stream(each: EachPair, a: Boxes, b: Boxes | typeof alone): boolean {
    if (typeof each !== "function") throw new TypeError(`\`each\` must be a function, not ${describe(each)}`);
    const owned = this.#owned;
    const { engine } = owned;
    let isComplete = true;
    const stream: Each = (at, count) => {
      const begin = at / 4;
      for (let word = begin; word < begin + 2 * count; word += 2) {
        const words = engine.words();
        isComplete = each(words[word]!, words[word + 1]!) !== false;
        if (!isComplete) break;
      }
      return isComplete;
    };
    this.#search(Chunk.Small, a, b, stream);
    // The rest: it is in the finder's memory, so the callback must not use this finder.
    const [at, count] = [engine.detail(0), engine.detail(1)];
    owned.isBusy = true;
    try {
      stream(at, count);
    } finally {
      owned.isBusy = false;
    }
    return isComplete;
  }

  #search(chunk: Chunk, a: Boxes, b: Boxes | typeof alone, each: Each | undefined): void {
    const owned = this.#owned;
    const dimensions = this.#dimensions;
    // First of all: this reads objects, and a getter may do anything.
    let first = checkBoxes(a, dimensions, b === alone ? "boxes" : "a");
    let second = b === alone ? undefined : checkBoxes(b, dimensions, "b");
    // Reading the second may have changed the buffer of the first.
    if (second) checkBoxes(first, dimensions, "a");
    owned.checkUsable();
    // The indices of the boxes that take part, if not all do.
    let keptA: Uint32Array | undefined;
    let keptB: Uint32Array | undefined;
    if (this.#skipsMissing) {
      [first, keptA] = dropMissing(first, dimensions);
      if (second) [second, keptB] = dropMissing(second, dimensions);
    }
    const isDouble = tagOf(first) === "Float64Array" || tagOf(second) === "Float64Array";
    // The core has no type for 1D boxes, nor for 2D in double precision: see js/wasm/src/finder.rs.
    const stored = isDouble ? 3 : (Math.max(2, dimensions) as Dimensions);
    owned.isBusy = true;
    try {
      const { engine } = owned;
      engine.calls++;
      const finder = owned.finder(isDouble, stored);
      // Writing one set may let the memory grow, which detaches an array of it.
      const [countA, countB] = [this.#countOf(first), second ? this.#countOf(second) : noSet];
      this.#writeRows(finder, 0, first, countA, isDouble, stored);
      if (second) this.#writeRows(finder, 1, second, countB, isDouble, stored);
      const find = () => finder.call((exports, at) => exports.finder_find(at, countA, countB, chunk));
      const isRenamed = keptA !== undefined || keptB !== undefined;
      const taking = each && isRenamed ? this.#renaming(each, keptA, second ? keptB : keptA) : each;
      const code = taking ? streamPairs(engine, find, taking) : find();
      if (code === Code.InvalidBox) this.#refuseBox(first, second, keptA, keptB);
      engine.check(code);
      if (isRenamed && chunk !== Chunk.None) renamePairs(engine.words(), engine.detail(0), engine.detail(1), keptA, second ? keptB : keptA);
    } catch (error) {
      // A finder that ran out of memory should not keep what it allocated; nor can one be used whose call ended halfway.
      if (error instanceof OutOfMemoryError) owned.release("discard");
      else if (error instanceof InterruptedError) owned.release("free");
      throw error;
    } finally {
      owned.isBusy = false;
    }
  }

  /** Takes pairs under the indices that their boxes had before some were dropped. */
  #renaming(each: Each, keptA: Uint32Array | undefined, keptB: Uint32Array | undefined): Each {
    const { engine } = this.#owned;
    return (at, count) => {
      renamePairs(engine.words(), at, count, keptA, keptB);
      return each(at, count);
    };
  }

  /** Throws that a box is invalid, which the core counts through both sets. */
  #refuseBox(first: Rows, second: Rows | undefined, keptA: Uint32Array | undefined, keptB: Uint32Array | undefined): never {
    const { engine } = this.#owned;
    const [counted, axis, countA] = [engine.detail(0), engine.detail(1), this.#countOf(first)];
    const isSecond = second !== undefined && counted >= countA;
    const [rows, kept, index] = isSecond ? [second, keptB, counted - countA] : [first, keptA, counted];
    const at = index * 2 * this.#dimensions + axis;
    throw new InvalidBoxError(kept?.[index] ?? index, axis, isSecond ? "b" : second ? "a" : "boxes", rows[at], rows[at + this.#dimensions]);
  }

  #countOf(rows: Rows): number {
    return lengthOf(rows) / (2 * this.#dimensions);
  }

  /** Writes the rows of a set. */
  #writeRows(finder: Handle<FinderExports>, set: 0 | 1, rows: Rows, count: number, isDouble: boolean, stored: Dimensions): void {
    const length = 2 * stored * count;
    checkFits(length * (isDouble ? 8 : 4));
    const at = finder.call((exports, at) => exports.finder_rows(at, set, count)) >>> 0;
    if (at === 0) throw new OutOfMemoryError();
    const { buffer } = finder.engine;
    const into = isDouble
      ? view(Float64Array, this.#rows[set], buffer, at, length)
      : view(Float32Array, this.#rows[set], buffer, at, length);
    this.#rows[set] = into;
    writeRows(rows, this.#dimensions, into, stored);
  }

  /**
   * Frees the memory. The finder cannot be used any more. Freeing it twice is not an error.
   *
   * @throws `TypeError` within the callback of its own `forEach`.
   */
  free(): void {
    if (!this.#owned.isFreed) this.#owned.checkUsable();
    this.#owned.free();
  }

  /** As {@link PairFinder.free}, for `using`. */
  [Symbol.dispose](): void {
    this.free();
  }
}

type Rows = Float32Array | Float64Array;

/** Throws that a method of one set got another argument. */
function refuseSecond(method: string): never {
  throw new TypeError(`\`${method}\` takes one set of boxes; the pairs between two are those of \`${method}Between\``);
}

function checkMissing(missing: unknown): boolean {
  if (missing === undefined || missing === "raise") return false;
  if (missing === "skip") return true;
  throw new RangeError(`\`missing\` must be "raise" or "skip", not ${describe(missing)}`);
}

const { set } = Uint32Array.prototype;

/** Throws unless pairs can be written to it. By its tag, not by `instanceof`: it may be of another realm. */
function checkInto(into: unknown): void {
  const tag = tagOf(into);
  if (tag === "Uint32Array" || tag === "Int32Array") return;
  throw new TypeError(`\`into\` must be a Uint32Array or an Int32Array, not ${describe(into)}`);
}

/** Chunks of pairs as one array. */
function joined(chunks: readonly Uint32Array[]): Uint32Array<ArrayBuffer> {
  const all = allocate(() => new Uint32Array(chunks.reduce((length, chunk) => length + chunk.length, 0)));
  let at = 0;
  for (const chunk of chunks) {
    all.set(chunk, at);
    at += chunk.length;
  }
  return all;
}

/** The core's finders, one for each precision, made when they are needed. */
class Owned {
  #single: Handle<FinderExports> | undefined;
  #double: Handle<FinderExports> | undefined;
  /** Whether a call is running: then only a callback can call us. */
  isBusy = false;
  isFreed = false;

  constructor(readonly engine: Engine<FinderExports>) {}

  checkUsable(): void {
    if (this.isFreed) throw new TypeError("this PairFinder was freed");
    if (this.isBusy) throw new TypeError("this PairFinder is in use: its callback can only use others");
  }

  finder(isDouble: boolean, stored: Dimensions): Handle<FinderExports> {
    return isDouble ? (this.#double ??= this.#new(1, stored)) : (this.#single ??= this.#new(0, stored));
  }

  #new(isDouble: 0 | 1, stored: Dimensions): Handle<FinderExports> {
    const at = this.engine.call((exports) => exports.finder_new(stored, isDouble));
    return new Handle(this.engine, at, "PairFinder", (exports, at) => exports.finder_free(at));
  }

  free(): void {
    this.isFreed = true;
    this.release("free");
  }

  /** Frees the core's finders. Later calls make new ones. */
  release(how: "free" | "discard"): void {
    this.#single?.[how]();
    this.#double?.[how]();
    this.#single = this.#double = undefined;
  }
}
