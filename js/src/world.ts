/// <reference lib="esnext.disposable" preserve="true" />
import { type Boxes, checkBoxes, checkDimensions, checkNumbers, type Dimensions } from "./boxes.js";
import { checkFits } from "./engine.js";
import { OutOfMemoryError } from "./errors.js";
import { defaultFilter, everything, type Filter, filterWords } from "./filter.js";
import { Query } from "./world-core.js";
import { WorldMemory } from "./world-memory.js";

/**
 * The name of a body: a whole number below 2^53. The lower 26 bits are its slot (see
 * {@link slotOf}), the others tell how many bodies have had the slot. So an id never comes to mean
 * another body before its slot has had 134 million others.
 */
export type ProxyId = number;

/**
 * The slot of a body, less than the greatest number of bodies there ever were at once: an index
 * into tables of your own.
 */
export function slotOf(id: ProxyId): number {
  return id % 2 ** 26;
}

/** How a world treats its boxes. */
export interface BroadPhaseOptions {
  /** How many dimensions the boxes have. */
  dimensions: Dimensions;
  /**
   * In which precision coordinates are kept and compared: `"single"`, to which they are rounded,
   * or `"double"`. Single by default.
   */
  precision?: "single" | "double";
  /** Which boxes the reported pairs are those of: as given, or the fat ones. Exact by default. */
  report?: "exact" | "fat";
  /** With fat boxes, what they have around the body's own, in units of length. 0 by default. */
  margin?: number;
  /** With fat boxes, how many displacements they reach ahead. 0 by default. */
  prediction?: number;
}

/** What an update found; see {@link BroadPhase.update}. */
export interface Changes {
  /** The pairs that overlap now and did not at the last update: `a0, b0, a1, b1, ...`. */
  begun: Float64Array;
  /** The pairs that overlapped at the last update and do not now; some ids may be stale. */
  ended: Float64Array;
}

/** Arrays to write to; see {@link BroadPhase.buffers}. */
export interface Buffers {
  /** Room for ids. */
  ids: Float64Array;
  /** Room for as many boxes. */
  boxes: Float32Array | Float64Array;
}

/** A body that a ray or a moving box hits. */
export interface Hit {
  /** The body. */
  id: ProxyId;
  /** How many directions from the start; 0 if they overlap there. */
  at: number;
}

/** A body near a point. */
export interface Neighbour {
  /** The body. */
  id: ProxyId;
  /** The distance from the point to its box; 0 if the point is in it. */
  distance: number;
}

/** Ids, or the coordinates of a point, a direction or a box. */
export type Numbers = readonly number[] | Float32Array | Float64Array;

/**
 * A world of boxes that tells which overlaps began and which ended.
 *
 * ```js
 * using world = new BroadPhase({ dimensions: 2 });
 * const hero = world.insert(0, 0, 1, 2);
 * world.set(hero, 3.5, 0, 4.5, 2);
 * const { begun, ended } = world.update();
 * ```
 *
 * Arrays that it returns are views, valid until the next call of anything in this package; copy
 * them (`begun.slice()`) to keep them. Same calls, same results, on every machine. A refused call
 * changes nothing, except that a world which ran out of memory is freed.
 */
export class BroadPhase {
  /** How many dimensions the boxes have. */
  readonly dimensions: Dimensions;
  /** The precision of the coordinates. */
  readonly precision: "single" | "double";
  readonly #memory: WorldMemory;
  readonly #changes: Changes = { begun: new Float64Array(0), ended: new Float64Array(0) };

  /**
   * An empty world.
   *
   * @throws {@link NotInitializedError} before `init()` is done.
   * @throws `RangeError` for dimensions other than 1, 2 and 3, or a margin or prediction that is
   *   negative, infinite or NaN.
   */
  constructor(options: BroadPhaseOptions) {
    const { precision = "single", report = "exact", margin = 0, prediction = 0 } = options ?? {};
    this.dimensions = checkDimensions(options?.dimensions);
    if (precision !== "single" && precision !== "double") {
      throw new RangeError(`precision must be "single" or "double", not ${String(precision)}`);
    }
    if (report !== "exact" && report !== "fat") {
      throw new RangeError(`report must be "exact" or "fat", not ${String(report)}`);
    }
    this.precision = precision;
    this.#memory = new WorldMemory({ dimensions: this.dimensions, precision, report, margin, prediction });
  }

  /**
   * The world of a {@link BroadPhase.snapshot}: for the same calls it gives the same ids, events
   * and results. Precision, margins and what is reported are in the bytes.
   *
   * @throws {@link SnapshotError} if they are not those of a world of so many dimensions.
   */
  static fromSnapshot(bytes: Uint8Array, options: { dimensions: Dimensions }): BroadPhase {
    if (!(ArrayBuffer.isView(bytes) && bytes[Symbol.toStringTag] === "Uint8Array")) {
      throw new TypeError("a snapshot must be a Uint8Array");
    }
    const scalarBytes = bytes[6];
    const world = new BroadPhase({ ...options, precision: scalarBytes === 8 ? "double" : "single" });
    try {
      world.#restore(bytes);
      return world;
    } catch (error) {
      world.free();
      throw error;
    }
  }

  #restore(bytes: Uint8Array): void {
    checkFits(bytes.length);
    this.#memory.call((exports, world) => {
      const at = exports.world_bytes(world, bytes.length) >>> 0;
      if (at === 0) throw new OutOfMemoryError();
      new Uint8Array(exports.memory.buffer, at, bytes.length).set(bytes);
      return exports.world_restore(world);
    });
  }

  /** How many bodies there are. */
  get size(): number {
    return this.#memory.ask((exports, world) => exports.world_len(world)) >>> 0;
  }

  /** The ids of all bodies, sorted by slot. */
  ids(): Float64Array {
    return this.#memory.answer((exports, world) => exports.world_ids(world));
  }

  /** Whether an id names a body that was inserted here and not removed. */
  has(id: ProxyId): boolean {
    return this.#memory.ask((exports, world) => exports.world_has(world, id)) !== 0;
  }

  /**
   * Adds a body: its least corner and then its greatest. Its filter is the default one, until
   * {@link BroadPhase.setFilter}.
   *
   * @throws {@link InvalidBoxError} if the box is inverted or NaN, as a coordinate left out is.
   */
  insert(a: number, b: number, c?: number, d?: number, e?: number, f?: number): ProxyId {
    this.#memory.writeBox(0, a, b, c, d, e, f);
    this.#memory.call((exports, world) => exports.world_insert(world));
    return this.#memory.numbers()[0]!;
  }

  /**
   * Adds bodies with one filter. Their ids are in the order of their boxes.
   *
   * @throws {@link InvalidBoxError} with the index of the first bad box; then none was added.
   */
  insertMany(boxes: Boxes, filter: Partial<Filter> = defaultFilter): Float64Array {
    const words = filterWords(filter, defaultFilter);
    const count = this.#memory.writeRows(boxes);
    return this.#memory.answer((exports, world) => exports.world_insert_many(world, count, ...words));
  }

  /**
   * Gives a body its new box.
   *
   * @throws {@link StaleProxyError}, {@link InvalidBoxError}.
   */
  set(id: ProxyId, a: number, b: number, c?: number, d?: number, e?: number, f?: number): void {
    this.#memory.writeBox(0, a, b, c, d, e, f);
    this.#memory.call((exports, world) => exports.world_set(world, id));
  }

  /**
   * Gives each of many bodies its new box; of an id that comes twice the last box counts. Where
   * ids and boxes are those of {@link BroadPhase.buffers} nothing is copied.
   *
   * @throws {@link StaleProxyError} or {@link InvalidBoxError} with the index of the first that is
   *   bad, `RangeError` if there are more of one than of the other. Then no box has changed.
   */
  setMany(ids: Numbers, boxes: Boxes): void {
    const rows = checkBoxes(boxes, this.dimensions);
    const names = checkNumbers(ids, "ids");
    if (names.length * 2 * this.dimensions !== rows.length) {
      throw new RangeError(`${names.length} ids do not go with ${rows.length / (2 * this.dimensions)} boxes`);
    }
    // Views of memory are left empty when it grows, which writing the others may let it.
    const kept = this.#memory.keepIds(names);
    this.#memory.writeRows(rows);
    this.#memory.writeIds(kept);
    this.#memory.call((exports, world) => exports.world_set_many(world, kept.length));
  }

  /**
   * Arrays to write many ids and boxes to, which {@link BroadPhase.setMany} then need not copy:
   * views of memory, valid until the next call. Where the boxes are stored in another form
   * (lines; doubles in the plane) they are ordinary arrays.
   */
  buffers(count: number): Buffers {
    this.#memory.exports(); // throws if it was freed
    if (!(Number.isInteger(count) && count >= 0)) throw new RangeError(`count must be a whole number, not ${count}`);
    const width = 2 * this.dimensions;
    if (this.#memory.stored !== this.dimensions) {
      const boxes = this.precision === "double" ? new Float64Array(width * count) : new Float32Array(width * count);
      return { ids: new Float64Array(count), boxes };
    }
    this.#memory.rowsFor(count);
    const ids = this.#memory.idsFor(count);
    return { ids, boxes: this.#memory.rowsFor(count) };
  }

  /**
   * Moves a fast body all the way from one box to another: until the next update its box is the
   * smallest that holds both, and from then on `to`. So it pairs with what it would have jumped
   * over (and, on a diagonal way, with what lies beside it).
   *
   * @throws {@link StaleProxyError}; {@link InvalidBoxError} with index 0 for `from`, 1 for `to`.
   */
  setSwept(id: ProxyId, from: Numbers, to: Numbers): void {
    this.#memory.writeNumbers(0, from, 2, "from");
    this.#memory.writeNumbers(2 * this.#memory.stored, to, 2, "to");
    this.#memory.call((exports, world) => exports.world_set_swept(world, id));
  }

  /**
   * The box of a body as last given: least corner, greatest corner. An array of your own.
   *
   * @throws {@link StaleProxyError}.
   */
  box(id: ProxyId): number[] {
    this.#memory.call((exports, world) => exports.world_box(world, id));
    const [numbers, stored] = [this.#memory.numbers(), this.#memory.stored];
    return [
      ...numbers.subarray(0, this.dimensions),
      ...numbers.subarray(stored, stored + this.dimensions),
    ];
  }

  /**
   * Removes a body. Its id is stale from now on; the next update reports its ended pairs.
   *
   * @throws {@link StaleProxyError}.
   */
  remove(id: ProxyId): void {
    this.#memory.writeIds([id]);
    this.#memory.call((exports, world) => exports.world_remove_many(world, 1));
  }

  /**
   * Removes many bodies.
   *
   * @throws {@link StaleProxyError} with the index of the first id that is stale or came before.
   *   Then none was removed.
   */
  removeMany(ids: Numbers): void {
    const names = checkNumbers(ids, "ids");
    const count = names.length;
    this.#memory.writeIds(names);
    this.#memory.call((exports, world) => exports.world_remove_many(world, count));
  }

  /**
   * The filter of a body.
   *
   * @throws {@link StaleProxyError}.
   */
  filter(id: ProxyId): Filter {
    this.#memory.call((exports, world) => exports.world_filter(world, id));
    const [category = 0, mask = 0, group = 0, isStatic = 0] = this.#memory.numbers();
    return { category, mask, group, isStatic: isStatic !== 0 };
  }

  /**
   * Changes which others a body may pair with; what is left out is that of the default filter.
   * Pairs begin or end by it at the next update.
   *
   * @throws {@link StaleProxyError}; `RangeError` if a part is not a whole number of 32 bits.
   */
  setFilter(id: ProxyId, filter: Partial<Filter>): void {
    const words = filterWords(filter, defaultFilter);
    this.#memory.call((exports, world) => exports.world_set_filter(world, id, ...words));
  }

  /**
   * The pairs that began and ended since the last update, each with its smaller id first, sorted.
   * Time in proportion to the bodies that changed and their neighbours. It returns the same object
   * each time, with views that are valid until the next call.
   */
  update(): Changes {
    this.#memory.call((exports, world) => exports.world_update(world));
    this.#memory.changes(this.#changes);
    return this.#changes;
  }

  /** The pairs that overlapped at the last update: `a0, b0, a1, b1, ...`, sorted. */
  pairs(): Float64Array {
    return this.#memory.answer((exports, world) => exports.world_pairs(world));
  }

  /**
   * The bodies that overlapped this one at the last update, sorted.
   *
   * @throws {@link StaleProxyError}.
   */
  pairsOf(id: ProxyId): Float64Array {
    return this.#memory.answer((exports, world) => exports.world_pairs_of(world, id));
  }

  /**
   * The bodies whose boxes, as last given, overlap a box: least corner, greatest corner. Sorted.
   *
   * Here as in all queries, `filter` is that of a body which asks; without it all are found.
   *
   * @throws {@link InvalidBoxError}.
   */
  overlapping(box: Numbers, filter?: Partial<Filter>): Float64Array {
    this.#memory.writeNumbers(0, box, 2, "box");
    return this.#ask(Query.Overlapping, 0, filter);
  }

  /**
   * The bodies whose boxes hold a point, sorted.
   *
   * @throws `RangeError` for a NaN.
   */
  containing(point: Numbers, filter?: Partial<Filter>): Float64Array {
    this.#memory.writeNumbers(0, point, 1, "point");
    return this.#ask(Query.Containing, 0, filter);
  }

  /**
   * The bodies whose boxes are at most `radius` away from `centre`, sorted.
   *
   * @throws `RangeError` if the centre is not finite, or the radius negative or NaN.
   */
  within(centre: Numbers, radius: number, filter?: Partial<Filter>): Float64Array {
    this.#memory.writeNumbers(0, centre, 1, "centre");
    this.#memory.numbers()[this.#memory.stored] = radius;
    return this.#ask(Query.Within, 0, filter);
  }

  /**
   * The body that a ray hits first, `limit` directions far at most; of several at once the least
   * id. `direction` may be of any length.
   *
   * @throws `RangeError` if the origin or the direction is not finite, or the limit negative.
   */
  rayCast(origin: Numbers, direction: Numbers, limit: number = Infinity, filter?: Partial<Filter>): Hit | undefined {
    this.#writeRay(origin, direction, limit);
    return hits(this.#ask(Query.Cast, 0, filter))[0];
  }

  /**
   * All that a ray hits, nearest first.
   *
   * @throws As {@link BroadPhase.rayCast}.
   */
  rayCastAll(origin: Numbers, direction: Numbers, limit: number = Infinity, filter?: Partial<Filter>): Hit[] {
    this.#writeRay(origin, direction, limit);
    return hits(this.#ask(Query.CastAll, 0, filter));
  }

  /**
   * The body that a moving box hits first.
   *
   * @throws As {@link BroadPhase.rayCast}, also if the box is inverted.
   */
  boxCast(box: Numbers, direction: Numbers, limit: number = Infinity, filter?: Partial<Filter>): Hit | undefined {
    this.#writeCast(box, direction, limit);
    return hits(this.#ask(Query.Cast, 0, filter))[0];
  }

  /**
   * All that a moving box hits, nearest first.
   *
   * @throws As {@link BroadPhase.boxCast}.
   */
  boxCastAll(box: Numbers, direction: Numbers, limit: number = Infinity, filter?: Partial<Filter>): Hit[] {
    this.#writeCast(box, direction, limit);
    return hits(this.#ask(Query.CastAll, 0, filter));
  }

  /**
   * The `k` bodies nearest to a point, or all if there are fewer, by distance and then by id.
   *
   * @throws `RangeError` if the point is not finite, or `k` not a whole number.
   */
  nearest(point: Numbers, k: number = 1, filter?: Partial<Filter>): Neighbour[] {
    if (!(Number.isInteger(k) && k >= 0 && k < 2 ** 32)) throw new RangeError(`k must be a whole number, not ${k}`);
    this.#memory.writeNumbers(0, point, 1, "point");
    const found = this.#ask(Query.Nearest, k, filter);
    return Array.from({ length: found.length / 2 }, (_, i) => ({
      id: found[2 * i]!,
      distance: Math.sqrt(found[2 * i + 1]!),
    }));
  }

  /**
   * The whole state as bytes of your own, for rollback, replay and saved games. Equal states give
   * equal bytes.
   */
  snapshot(): Uint8Array<ArrayBuffer> {
    this.#memory.call((exports, world) => exports.world_snapshot(world));
    return this.#memory.bytes();
  }

  /** A 64-bit hash of the whole state, equal for equal states on every machine. */
  hash(): bigint {
    this.#memory.call((exports, world) => exports.world_hash(world));
    return this.#memory.bits();
  }

  /** Gives the memory back. The world cannot be used any more; to free it twice is no error. */
  free(): void {
    this.#memory.free();
  }

  /** As {@link BroadPhase.free}, for `using`. */
  [Symbol.dispose](): void {
    this.free();
  }

  #ask(query: Query, k: number, filter: Partial<Filter> | undefined): Float64Array {
    const words = filterWords(filter ?? everything, defaultFilter);
    return this.#memory.answer((exports, world) => exports.world_query(world, query, k, ...words));
  }

  #writeRay(origin: Numbers, direction: Numbers, limit: number): void {
    this.#memory.writeNumbers(0, origin, 1, "origin");
    this.#memory.writeNumbers(this.#memory.stored, origin, 1, "origin");
    this.#writeWay(direction, limit);
  }

  #writeCast(box: Numbers, direction: Numbers, limit: number): void {
    this.#memory.writeNumbers(0, box, 2, "box");
    this.#writeWay(direction, limit);
  }

  #writeWay(direction: Numbers, limit: number): void {
    this.#memory.writeNumbers(2 * this.#memory.stored, direction, 1, "direction");
    this.#memory.numbers()[3 * this.#memory.stored] = limit;
  }
}

function hits(found: Float64Array): Hit[] {
  return Array.from({ length: found.length / 2 }, (_, i) => ({ id: found[2 * i]!, at: found[2 * i + 1]! }));
}
