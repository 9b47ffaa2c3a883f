/// <reference lib="esnext.disposable" preserve="true" />
import {
  type BoxObject,
  type Boxes,
  checkBoxes,
  checkDimensions,
  checkNumbers,
  type Corner,
  type Dimensions,
  isNamed,
  readBox,
  readPoint,
  type TypedNumbers,
} from "./boxes.js";
import { describe } from "./describe.js";
import { dimensionsOf } from "./dimensions-of.js";
import { checkFits, Core, type Engine, type Exports } from "./engine.js";
import { OutOfMemoryError, SweepAndPruneError } from "./errors.js";
import { copy, view } from "./views.js";
import { checkCount, checkLength } from "./query-arguments.js";

/** What js/wasm/src/index.rs exports. */
export interface IndexExports extends Exports {
  index_builder(dimensions: number, double: number): number;
  index_rows(builder: number, count: number): number;
  index_build(builder: number, count: number): number;
  index_bytes_in(length: number): number;
  index_from(bytes: number, length: number): number;
  index_free(index: number): void;
  index_data(index: number): number;
  index_kind(index: number): number;
  index_numbers(index: number): number;
  index_query_rows(index: number, count: number): number;
  index_search(index: number, limit: number): number;
  index_search_many(index: number): number;
  index_neighbors(index: number, dimensions: number, k: number, maxDistance: number): number;
  index_cast(index: number, limit: number, all: number): number;
}

/** The code of js/wasm/src/status.rs for bytes that are no index. */
const invalidIndex = 7;

/** The core of the static index. */
export const indexCore: Core<IndexExports> = new Core("index_builder", "sweep-and-prune/spatial-index");

/** Options of an {@link Index}. */
export interface IndexOptions {
  /** How many dimensions the boxes have. Boxes that are objects tell it themselves, and need no options. */
  dimensions: Dimensions;
}

/** Is called with the index of a box, and returns whether to keep it. */
export type IndexFilter = (index: number) => boolean;

/** Options of {@link Index.search}. */
export interface SearchOptions {
  /** At most so many boxes are found; which ones is not defined, but always the same. All by default. */
  limit?: number;
  /** Which boxes to keep. It is called after the search, for one box after another until there are `limit`. */
  filter?: IndexFilter;
}

/** Options of {@link Index.neighbors}. */
export interface NeighborsOptions {
  /** Boxes farther away are not found. Infinite by default. */
  maxDistance?: number;
  /** Which boxes to keep. It is called for the nearest first. */
  filter?: IndexFilter;
}

/** A box near a point. */
export interface IndexNeighbor {
  /** The index of the box. */
  index: number;
  /** The distance from the point to the box; 0 if the point is in it. */
  distance: number;
}

/** A box that a ray or a line segment meets. */
export interface IndexHit {
  /** The index of the box. */
  index: number;
  /** Where it is met: at `origin + t * direction`, or at `from + t * (to - from)`. 0 if that begins in the box. */
  t: number;
}

/** A point or a direction: as many numbers as there are dimensions, or `{ x, y, z }`. */
export type Point = readonly number[] | TypedNumbers | Corner;

/** The bytes are not an index, or not one that this version can read. */
export class IndexDataError extends SweepAndPruneError {
  /** The name of this class. */
  override name = "IndexDataError";

  /** @internal */
  constructor(fault: number, found: number) {
    const faults = [
      "they do not begin as the bytes of an index do",
      `they are of version ${found}, which this version of the package cannot read: build the index again`,
      `they hold boxes of ${found} dimensions, which this package does not have`,
      "some are missing, or there are too many",
    ];
    super(`these bytes are no index: ${faults[fault] ?? faults[3]}`);
  }
}

/**
 * A static index: built once over boxes that do not move, it finds those that overlap a box, that are nearest
 * to a point, or that a ray hits. Boxes are named by their index in what it was built from.
 *
 * ```js
 * const index = new Index(new Float32Array([0, 0, 2, 2,  5, 5, 6, 6,  2, 1, 3, 4]), { dimensions: 2 });
 * index.search([1, 1, 2, 2]).sort(); // Uint32Array [0, 2]
 * index.neighbors([4, 4], 1); // [{ index: 2, distance: 1 }]
 * ```
 *
 * An index of a `Float32Array` is of single precision: the areas and points of its queries are rounded to that.
 * Any other is of double precision.
 *
 * Its memory is freed by `using`, by {@link Index.free}, or some time after the last reference to it is gone.
 */
export class Index {
  /** How many dimensions the boxes have. */
  readonly dimensions: Dimensions;
  /** How many boxes there are. */
  readonly length: number;
  /** The precision of the boxes. */
  readonly precision: "single" | "double";
  readonly #owned: Owned;
  readonly #numbersAt: number;
  #numbers: Float64Array | undefined;
  #found: Uint32Array<ArrayBuffer> | undefined;

  /**
   * Builds an index. Time O(n log n), and while it builds, memory for the boxes and for the index once more.
   *
   * @throws `InvalidBoxError` for the first box that is inverted or NaN.
   * @throws `OutOfMemoryError` if the boxes or the index do not fit in memory.
   * @throws `NotInitializedError` before `init()` is done.
   * @throws `TypeError` if `boxes` is of another type or its buffer is detached.
   * @throws `RangeError` if `boxes` is not whole rows, or `dimensions` is not 1, 2 or 3.
   */
  constructor(boxes: readonly BoxObject[], options?: IndexOptions);
  constructor(boxes: Boxes, options: IndexOptions);
  constructor(boxes: Boxes | Owned, options?: IndexOptions) {
    const owned = boxes instanceof Owned ? boxes : build(boxes, options);
    const { exports } = owned.engine;
    const kind = exports.index_kind(owned.index);
    this.#owned = owned;
    this.#numbersAt = exports.index_numbers(owned.index) >>> 0;
    this.dimensions = (kind & 7) as Dimensions;
    this.precision = kind & 8 ? "double" : "single";
    this.length = exports.index_data(owned.index) >>> 0;
    forgotten?.register(this, owned, owned);
  }

  /**
   * An index from the {@link Index.data} of one. The bytes are copied to the memory of WebAssembly, which takes
   * most of the time; nothing is built. Any bytes are safe, but damaged ones may find wrong boxes.
   *
   * @throws {@link IndexDataError} if they do not begin as those of an index do, are of another version, or of
   * another length than its boxes have.
   * @throws `OutOfMemoryError`, `NotInitializedError`, and `TypeError` if `data` is of another type.
   */
  static from(data: ArrayBuffer | SharedArrayBuffer | ArrayBufferView): Index {
    const engine = indexCore.engine();
    const bytes = bytesOf(data);
    checkFits(bytes.length);
    engine.calls++;
    engine.check(engine.exports.index_bytes_in(bytes.length));
    const [buffer, at] = [engine.detail(0), engine.detail(1)];
    new Uint8Array(engine.exports.memory.buffer, at, bytes.length).set(bytes);
    const code = engine.exports.index_from(buffer, bytes.length);
    if (code === invalidIndex) throw new IndexDataError(engine.detail(0), engine.detail(1));
    engine.check(code);
    return new (Index as unknown as new (owned: Owned) => Index)(new Owned(engine, engine.detail(0)));
  }

  /** A copy of the bytes of the index, to store or send: the same on every machine, and in Rust and Python. */
  get data(): Uint8Array<ArrayBuffer> {
    const { engine, index } = this.#use();
    engine.exports.index_data(index);
    return copy(new Uint8Array(engine.exports.memory.buffer, engine.detail(0), engine.detail(1)));
  }

  /**
   * The indices of the boxes that overlap a box, in no particular order, but the same on every machine. Touching
   * boxes overlap.
   *
   * @throws `RangeError` if the box is inverted or NaN or has another number of dimensions.
   * @throws `TypeError` if an argument is of another type, or the index was freed.
   */
  search(box: BoxObject, options?: SearchOptions): Uint32Array<ArrayBuffer> {
    const owned = this.#use();
    this.#writeBox(box);
    const { engine, index } = owned;
    if (options === undefined) return this.#answer(owned, engine.exports.index_search(index, -1));
    const limit = options.limit === undefined || options.limit === Infinity ? 2 ** 32 - 1 : checkCount(options.limit, "limit");
    const { filter } = options;
    if (filter === undefined) return this.#answer(owned, engine.exports.index_search(index, limit));
    checkFilter(filter);
    const found = this.#answer(owned, engine.exports.index_search(index, -1));
    let kept = 0;
    for (let at = 0; at < found.length && kept < limit; at++) {
      if (filter(found[at]!)) found[kept++] = found[at]!;
    }
    return found.slice(0, kept);
  }

  /**
   * What {@link Index.search} finds for each of many boxes: two numbers for each that is found, the position of
   * the box in `boxes` and the index of the box that it overlaps: `query0, index0, query1, index1, ...`, by query.
   * One call for thousands of boxes takes less time than a call for each.
   *
   * @throws As {@link Index.search}; `InvalidBoxError` for the first box that is inverted or NaN.
   */
  searchMany(boxes: Boxes): Uint32Array<ArrayBuffer> {
    const rows = checkBoxes(boxes, this.dimensions);
    const owned = this.#use();
    const { engine, index } = owned;
    checkFits(8 * rows.length);
    const at = engine.exports.index_query_rows(index, rows.length) >>> 0;
    if (at === 0) throw new OutOfMemoryError();
    new Float64Array(engine.exports.memory.buffer, at, rows.length).set(rows);
    return this.#answer(owned, engine.exports.index_search_many(index), rows.length / (2 * this.dimensions));
  }

  /**
   * The `k` boxes nearest to a point, or all if there are fewer, sorted by distance and then by index.
   *
   * @throws `RangeError` if the point is not finite or has another number of dimensions, `k` is not a whole number,
   * or the distance is negative or NaN.
   */
  neighbors(point: Point, k: number = Infinity, options: NeighborsOptions = {}): IndexNeighbor[] {
    const count = k === Infinity ? this.length : Math.min(checkCount(k, "k"), this.length);
    const maxDistance = options.maxDistance === undefined ? Infinity : checkLength(options.maxDistance, "maxDistance");
    const { filter } = options;
    if (filter !== undefined) checkFilter(filter);
    // With a filter twice as many in each turn, until enough are kept: one call would have to stop within Rust.
    for (let asked = count; ; asked = Math.min(2 * asked + 16, this.length)) {
      const owned = this.#use();
      this.#writePoint(0, point, "point");
      owned.engine.check(owned.engine.exports.index_neighbors(owned.index, this.dimensions, asked, maxDistance));
      const found = this.#pairs(owned);
      const kept = filter ? found.filter(([index]) => filter(index)) : found;
      if (!filter || kept.length >= count || found.length < asked || asked === this.length) {
        return kept.slice(0, count).map(([index, squared]) => ({ index, distance: Math.sqrt(squared) }));
      }
    }
  }

  /**
   * The box that a ray hits first, or `undefined`: at `origin + t * direction` for the smallest t from 0 to `limit`.
   * Of several at once that with the smallest index.
   *
   * @throws `RangeError` if the origin or the direction is not finite, or the limit negative or NaN.
   */
  rayCast(origin: Point, direction: Point, limit: number = Infinity): IndexHit | undefined {
    return this.#cast(origin, "origin", direction, "direction", checkLength(limit, "limit"), false)[0];
  }

  /**
   * All boxes that a ray hits, nearest first.
   *
   * @throws As {@link Index.rayCast}.
   */
  rayCastAll(origin: Point, direction: Point, limit: number = Infinity): IndexHit[] {
    return this.#cast(origin, "origin", direction, "direction", checkLength(limit, "limit"), true);
  }

  /**
   * All boxes that the line segment between two points meets, both ends included, nearest to `from` first. t is 0
   * at `from` and 1 at `to`.
   *
   * @throws `RangeError` if a point is not finite.
   */
  segment(from: Point, to: Point): IndexHit[] {
    return this.#cast(from, "from", to, "to", -1, true);
  }

  /** Frees the memory. The index cannot be used any more. Freeing it twice is not an error. */
  free(): void {
    forgotten?.unregister(this.#owned);
    release(this.#owned);
  }

  /** As {@link Index.free}, for `using`. */
  [Symbol.dispose](): void {
    this.free();
  }

  #cast(from: Point, fromName: string, to: Point, toName: string, limit: number, isAll: boolean): IndexHit[] {
    const owned = this.#use();
    this.#writePoint(0, from, fromName);
    this.#writePoint(this.dimensions, to, toName);
    owned.engine.check(owned.engine.exports.index_cast(owned.index, limit, Number(isAll)));
    return this.#pairs(owned).map(([index, t]) => ({ index, t }));
  }

  #use(): Owned {
    if (this.#owned.index === 0) throw new TypeError("this Index was freed");
    this.#owned.engine.calls++;
    return this.#owned;
  }

  #answer(owned: Owned, code: number, boxes = 0): Uint32Array<ArrayBuffer> {
    const { engine } = owned;
    if (code !== 0) engine.check(code, { boxes: [[boxes ? "boxes" : "box", Infinity]] });
    const { buffer } = engine.exports.memory;
    this.#found = view<Uint32Array<ArrayBuffer>>(Uint32Array, this.#found, buffer, engine.detail(0), engine.detail(1));
    return copy(this.#found);
  }

  /** The indices that the last call found, with a value for each. */
  #pairs({ engine }: Owned): [index: number, value: number][] {
    const { buffer } = engine.exports.memory;
    const count = engine.detail(1);
    const indices = new Uint32Array(buffer, engine.detail(0), count);
    const values = new Float64Array(buffer, this.#input()[0]!, count);
    return Array.from(indices, (index, at) => [index, values[at]!]);
  }

  /** Where the numbers of a query are written. */
  #input(): Float64Array {
    const { buffer } = this.#owned.engine.exports.memory;
    return (this.#numbers = view(Float64Array, this.#numbers, buffer, this.#numbersAt, 8));
  }

  #writeBox(box: BoxObject): void {
    const width = 2 * this.dimensions;
    const numbers = this.#input();
    if (isNamed(box)) {
      readBox(box, this.dimensions, "box", numbers, 0);
      return;
    }
    const row: ArrayLike<unknown> = box;
    if (row?.length !== width) {
      const given = row !== null && typeof row === "object" ? `has ${row.length} numbers` : `is ${describe(row)}`;
      throw new RangeError(`\`box\` ${given}; in ${this.dimensions}D it must have ${width} numbers`);
    }
    for (let at = 0; at < width; at++) {
      const value = row[at];
      if (typeof value !== "number") throw new TypeError(`box[${at}] must be a number, not ${describe(value)}`);
      numbers[at] = value;
    }
  }

  #writePoint(at: number, point: Point, name: string): void {
    const given = isNamed(point) ? readPoint(point, this.dimensions, name) : checkNumbers(point, name);
    if (given.length !== this.dimensions) {
      throw new RangeError(`\`${name}\` has ${given.length} numbers; in ${this.dimensions}D it must have ${this.dimensions}`);
    }
    const wrong = given.findIndex((x) => !Number.isFinite(this.precision === "single" ? Math.fround(x) : x));
    if (wrong >= 0) throw new RangeError(`\`${name}[${wrong}]\` is ${given[wrong]}; it must be finite`);
    this.#input().set(given, at);
  }
}

/** The handle of the core's object, or 0 once it is freed. */
class Owned {
  constructor(
    readonly engine: Engine<IndexExports>,
    public index: number,
  ) {}
}

function build(boxes: Boxes, options: IndexOptions | undefined): Owned {
  const areNone = Array.isArray(boxes) && boxes.length === 0;
  const dimensions = checkDimensions(options ? options.dimensions : areNone ? 2 : dimensionsOf(boxes));
  const rows = checkBoxes(boxes, dimensions);
  const engine = indexCore.engine();
  const { exports } = engine;
  const count = rows.length / (2 * dimensions);
  const isDouble = rows.BYTES_PER_ELEMENT === 8;
  checkFits(rows.byteLength);
  engine.calls++;
  const builder = exports.index_builder(dimensions, Number(isDouble));
  const at = exports.index_rows(builder, count) >>> 0;
  if (at === 0 && count > 0) {
    exports.index_build(builder, 0); // frees the builder
    engine.exports.index_free(engine.detail(0));
    throw new OutOfMemoryError();
  }
  const { buffer } = exports.memory;
  (isDouble ? new Float64Array(buffer, at, rows.length) : new Float32Array(buffer, at, rows.length)).set(rows);
  engine.check(exports.index_build(builder, count), { boxes: [["boxes", count]] });
  return new Owned(engine, engine.detail(0));
}

function bytesOf(data: unknown): Uint8Array {
  if (ArrayBuffer.isView(data)) return new Uint8Array(data.buffer, data.byteOffset, data.byteLength);
  const tag = Object.prototype.toString.call(data);
  if (tag === "[object ArrayBuffer]" || tag === "[object SharedArrayBuffer]") return new Uint8Array(data as ArrayBuffer);
  throw new TypeError(`\`data\` must be an ArrayBuffer or a view of one, not ${describe(data)}`);
}

function checkFilter(filter: unknown): void {
  if (typeof filter !== "function") throw new TypeError(`\`filter\` must be a function, not ${describe(filter)}`);
}

function release(owned: Owned): void {
  if (owned.index !== 0) owned.engine.exports.index_free(owned.index);
  owned.index = 0;
}

/** Frees the handles of indexes that were garbage collected. */
const forgotten = typeof FinalizationRegistry === "undefined" ? undefined : new FinalizationRegistry<Owned>(release);
