/// <reference lib="esnext.disposable" preserve="true" />
import { describe } from "./describe.js";
import { type Boxes, checkBoxes, checkDimensions, checkNumbers, type Dimensions } from "./boxes.js";
import { OutOfMemoryError } from "./errors.js";
import { defaultFilter, type Filter, filterWords, type FilterWords, noFilter } from "./filter.js";
import { checkCount, checkId, checkLength } from "./world-arguments.js";
import { Query } from "./world-core.js";
import { checkViews } from "./views.js";
import { WorldMemory } from "./world-memory.js";
import type {
  Box,
  BroadPhaseOptions,
  Buffers,
  Changes,
  Hit,
  Neighbor,
  Numbers,
  Point,
  ProxyId,
  QueryFilter,
} from "./world-types.js";

/**
 * A persistent broad phase: it keeps bodies with boxes, and reports which overlaps began and which
 * ended.
 *
 * ```js
 * using world = new BroadPhase({ dimensions: 2 });
 * const hero = world.insert(0, 0, 1, 2);
 * world.set(hero, 3.5, 0, 4.5, 2);
 * const { begun } = world.update();
 * for (let i = 0; i < begun.length; i += 2) console.log(begun[i], "touches", begun[i + 1]);
 * ```
 *
 * The same calls give the same results on every machine. A call that throws changes nothing, with one
 * exception: a `BroadPhase` that runs out of memory is freed.
 */
export class BroadPhase {
  /** How many dimensions the boxes have. */
  readonly dimensions: Dimensions;
  /** The precision of the coordinates. */
  readonly precision: "single" | "double";
  readonly #memory: WorldMemory;
  readonly #changes: Changes = { begun: none, ended: none };

  /**
   * An empty broad phase.
   *
   * @throws {@link NotInitializedError} before `init()` is done.
   * @throws `RangeError` for dimensions other than 1, 2 and 3, or a margin or prediction that is
   *   negative, infinite or NaN; `TypeError` if `views` is not a boolean.
   */
  constructor(options: BroadPhaseOptions) {
    const given: unknown = options;
    this.#memory = given instanceof WorldMemory ? given : WorldMemory.create(checkOptions(options));
    this.dimensions = this.#memory.dimensions;
    this.precision = this.#memory.isDouble ? "double" : "single";
  }

  /**
   * Restores a {@link BroadPhase.snapshot}: for the same calls it gives the same ids, events and
   * results. The other options are in the bytes.
   *
   * @throws {@link SnapshotError} if the bytes are not a snapshot of boxes with these dimensions.
   */
  static fromSnapshot(bytes: Uint8Array, options: { dimensions: Dimensions; views?: boolean }): BroadPhase {
    if (!(ArrayBuffer.isView(bytes) && bytes[Symbol.toStringTag] === "Uint8Array")) {
      throw new TypeError(`\`bytes\` must be a Uint8Array, not ${describe(bytes)}`);
    }
    const memory: unknown = WorldMemory.restore(bytes, checkDimensions(options?.dimensions), checkViews(options.views));
    return new BroadPhase(memory as BroadPhaseOptions);
  }

  /** How many bodies there are. */
  get size(): number {
    return this.#memory.ask((exports, world) => exports.world_len(world)) >>> 0;
  }

  /** The ids of all bodies, sorted by slot. */
  ids(): Float64Array {
    return this.#memory.answer((exports, world) => exports.world_ids(world));
  }

  /** Whether the body of an id is here: it was inserted here and not removed. */
  contains(id: ProxyId): boolean {
    const isId = typeof id === "number"; // the `valueOf` of an object could free the memory
    return this.#memory.ask((exports, world) => (isId ? exports.world_contains(world, id) : 0)) !== 0;
  }

  /**
   * Adds a body with this box: an object, an array, or separate numbers, the min corner and then the
   * max corner. Its filter is the default one, until {@link BroadPhase.setFilter}.
   *
   * @throws {@link InvalidBoxError} if the box is inverted or NaN; `TypeError` if the arguments are
   *   not as many numbers as a box has; `RangeError` if an array does not have as many.
   */
  insert(box: Box): ProxyId;
  insert(minX: number, maxX: number): ProxyId;
  insert(minX: number, minY: number, maxX: number, maxY: number): ProxyId;
  insert(minX: number, minY: number, minZ: number, maxX: number, maxY: number, maxZ: number): ProxyId;
  insert(a: number | Box, b?: number, c?: number, d?: number, e?: number, f?: number, more?: never): ProxyId {
    this.#memory.writeBox(a, b, c, d, e, f, more);
    this.#memory.call((exports, world) => exports.world_insert(world), oneBox);
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
   * @throws {@link StaleProxyError}; otherwise as {@link BroadPhase.insert}.
   */
  set(id: ProxyId, box: Box): void;
  set(id: ProxyId, minX: number, maxX: number): void;
  set(id: ProxyId, minX: number, minY: number, maxX: number, maxY: number): void;
  set(id: ProxyId, minX: number, minY: number, minZ: number, maxX: number, maxY: number, maxZ: number): void;
  set(id: ProxyId, a: number | Box, b?: number, c?: number, d?: number, e?: number, f?: number, more?: never): void {
    checkId(id);
    this.#memory.writeBox(a, b, c, d, e, f, more);
    this.#memory.call((exports, world) => exports.world_set(world, id), { ids: [id], boxes: oneBox.boxes });
  }

  /**
   * Gives each of many bodies its new box. If an id is given twice, its last box counts.
   *
   * @throws {@link StaleProxyError} or {@link InvalidBoxError} with the index of the first bad one,
   *   `RangeError` if there are not as many ids as boxes. Then no box has changed.
   */
  setMany(ids: Numbers, boxes: Boxes): void {
    const rows = checkBoxes(boxes, this.dimensions);
    const names = checkNumbers(ids, "ids");
    if (names.length * 2 * this.dimensions !== rows.length) {
      throw new RangeError(`\`ids\` has ${names.length} ids and \`boxes\` ${rows.length / (2 * this.dimensions)} boxes; there must be as many`);
    }
    // Writing the boxes may let the memory grow, which leaves views of it empty.
    const kept = this.#memory.keepIds(names);
    this.#memory.writeRows(rows);
    this.#memory.writeIds(kept);
    const passed = { ids: kept };
    this.#memory.call((exports, world) => exports.world_set_many(world, kept.length), passed);
  }

  /**
   * Arrays to write many ids and boxes to. With the option `views` they are views of memory, valid until
   * the next call, and {@link BroadPhase.setMany} does not copy them. Without it, and for 1D boxes and 2D
   * boxes in double precision, which are stored in another form, they are ordinary arrays.
   *
   * @throws `RangeError` if `count` is not a whole number, {@link OutOfMemoryError}.
   */
  buffers(count: number): Buffers {
    this.#memory.exports(); // throws if it was freed
    if (!(Number.isInteger(count) && count >= 0)) throw new RangeError(`\`count\` is ${describe(count)}; it must be a whole number, 0 or more`);
    const width = 2 * this.dimensions;
    if (!this.#memory.isView || this.#memory.stored !== this.dimensions) {
      try {
        const boxes = this.precision === "double" ? new Float64Array(width * count) : new Float32Array(width * count);
        return { ids: new Float64Array(count), boxes };
      } catch {
        throw new OutOfMemoryError();
      }
    }
    this.#memory.rowsFor(count);
    const ids = this.#memory.idsFor(count);
    return { ids, boxes: this.#memory.rowsFor(count) };
  }

  /**
   * Moves a fast body from one box to another: until the next update its box is the union of both,
   * and from then on `to`. So it pairs with bodies that it would have jumped over (and, if it moves
   * diagonally, with bodies beside its path).
   *
   * @throws {@link StaleProxyError}; {@link InvalidBoxError} for `from` or `to`.
   */
  setSwept(id: ProxyId, from: Box, to: Box): void {
    checkId(id);
    this.#memory.writeCorners(0, from, 2, "from");
    this.#memory.writeCorners(2 * this.#memory.stored, to, 2, "to");
    const passed = { ids: [id], boxes: [["from", 1], ["to", 1]] } as const;
    this.#memory.call((exports, world) => exports.world_set_swept(world, id), passed);
  }

  /**
   * The box of a body as last set: its min corner, its max corner. The array is a copy.
   *
   * @throws {@link StaleProxyError}.
   */
  box(id: ProxyId): number[] {
    checkId(id);
    this.#memory.call((exports, world) => exports.world_box(world, id), { ids: [id] });
    const [numbers, stored] = [this.#memory.numbers(), this.#memory.stored];
    return [
      ...numbers.subarray(0, this.dimensions),
      ...numbers.subarray(stored, stored + this.dimensions),
    ];
  }

  /**
   * Removes a body. Its id is stale from now on. The next update reports that its pairs ended.
   *
   * @throws {@link StaleProxyError}.
   */
  remove(id: ProxyId): void {
    const ids = [checkId(id)];
    this.#memory.writeIds(ids);
    this.#memory.call((exports, world) => exports.world_remove_many(world, 1), { ids });
  }

  /**
   * Removes many bodies.
   *
   * @throws {@link StaleProxyError} with the index of the first id that is stale, or that is given
   *   twice. Then no body was removed.
   */
  removeMany(ids: Numbers): void {
    const kept = this.#memory.keepIds(checkNumbers(ids, "ids"));
    this.#memory.writeIds(kept);
    this.#memory.call((exports, world) => exports.world_remove_many(world, kept.length), { ids: kept });
  }

  /** Removes all bodies. Their ids are stale from now on. The next update reports that their pairs ended. */
  clear(): void {
    this.removeMany(this.ids());
  }

  /**
   * The filter of a body.
   *
   * @throws {@link StaleProxyError}.
   */
  filter(id: ProxyId): Filter {
    checkId(id);
    this.#memory.call((exports, world) => exports.world_filter(world, id), { ids: [id] });
    const [category = 0, mask = 0, group = 0, isStatic = 0] = this.#memory.numbers();
    return { category, mask, group, isStatic: isStatic !== 0 };
  }

  /**
   * Changes which other bodies a body may pair with. What is left out is as in the default filter.
   * The next update reports the pairs that begin and end because of it.
   *
   * @throws {@link StaleProxyError}; `RangeError` if `category`, `mask` or `group` is not a whole
   *   number of 32 bits.
   */
  setFilter(id: ProxyId, filter: Partial<Filter>): void {
    checkId(id);
    const words = filterWords(filter, defaultFilter);
    this.#memory.call((exports, world) => exports.world_set_filter(world, id, ...words), { ids: [id] });
  }

  /**
   * The pairs that began and ended since the last update. They are sorted by slot (see
   * {@link slotOf}), and the body with the smaller slot is first in its pair. The time depends on how
   * many bodies changed and how many neighbors they have. If most bodies move far, it can exceed the
   * time of finding all pairs (see the benchmark).
   *
   * With the option `views` it returns the same object each time, whose arrays are valid until the next
   * call.
   */
  update(): Changes {
    const changes = this.#memory.isView ? this.#changes : { begun: none, ended: none };
    this.#memory.update(changes);
    return changes;
  }

  /**
   * The pairs that overlapped at the last update: `a0, b0, a1, b1, ...`, sorted by slot. With
   * `{ sorted: false }` they are in no particular order, which takes less time.
   */
  pairs(options?: { sorted?: boolean }): Float64Array {
    const isSorted = options?.sorted !== false;
    return this.#memory.answer((exports, world) => exports.world_pairs(world, Number(isSorted)));
  }

  /**
   * The bodies that overlapped this one at the last update, sorted by slot.
   *
   * @throws {@link StaleProxyError}.
   */
  pairsOf(id: ProxyId): Float64Array {
    checkId(id);
    return this.#memory.answer((exports, world) => exports.world_pairs_of(world, id), { ids: [id] });
  }

  /**
   * The bodies whose boxes, as last set, overlap a box, sorted by slot.
   *
   * In all queries, `filter` is the filter of an imagined body: the query finds the bodies that may
   * pair with it. Or it is a function that gets an id and returns whether the query finds that body. It
   * is called after the search, so it may call anything. Without a filter a query finds every body.
   *
   * @throws {@link InvalidBoxError}; and what `filter` throws.
   */
  overlapping(box: Box, filter?: QueryFilter): Float64Array {
    this.#memory.writeCorners(0, box, 2, "box");
    return this.#ask(Query.Overlapping, filter);
  }

  /**
   * The bodies whose boxes contain a point, sorted by slot.
   *
   * @throws `RangeError` for a NaN.
   */
  containing(point: Point, filter?: QueryFilter): Float64Array {
    this.#memory.writeCorners(0, point, 1, "point", "a number");
    return this.#ask(Query.Containing, filter);
  }

  /**
   * The bodies whose boxes are at most `radius` away from `center`, sorted by slot.
   *
   * @throws `RangeError` if the center is not finite, or the radius negative or NaN.
   */
  within(center: Point, radius: number, filter?: QueryFilter): Float64Array {
    checkLength(radius, "radius");
    this.#memory.writeCorners(0, center, 1, "center", "finite");
    this.#memory.numbers()[this.#memory.stored] = radius;
    return this.#ask(Query.Within, filter);
  }

  /**
   * The first body that a ray hits, with `t` of the hit, which is at `origin + t * direction`. The
   * ray ends at `t = limit`. `direction` may have any length: if its length is 1, `t` is a distance.
   * Of several bodies hit at once it is the one with the smallest slot.
   *
   * The ray is tested against boxes. To find the first hit of what is inside the boxes, pass a function
   * as `filter`, which is called nearest first until it returns true, or test the results of
   * {@link BroadPhase.rayCastAll}. With a function all hits are searched first.
   *
   * @throws `RangeError` if the origin or the direction is not finite, or the limit negative or NaN.
   */
  rayCast(origin: Point, direction: Point, limit: number = Infinity, filter?: QueryFilter): Hit | undefined {
    this.#writeRay(origin, direction, limit);
    return this.#firstHit(filter);
  }

  /**
   * All bodies that a ray hits, nearest first.
   *
   * @throws As {@link BroadPhase.rayCast}.
   */
  rayCastAll(origin: Point, direction: Point, limit: number = Infinity, filter?: QueryFilter): Hit[] {
    this.#writeRay(origin, direction, limit);
    return this.#hits(Query.CastAll, filter);
  }

  /**
   * The first body that a moving box hits.
   *
   * @throws As {@link BroadPhase.rayCast}, also if the box is inverted.
   */
  boxCast(box: Box, direction: Point, limit: number = Infinity, filter?: QueryFilter): Hit | undefined {
    this.#writeCast(box, direction, limit);
    return this.#firstHit(filter);
  }

  /**
   * All bodies that a moving box hits, nearest first.
   *
   * @throws As {@link BroadPhase.boxCast}.
   */
  boxCastAll(box: Box, direction: Point, limit: number = Infinity, filter?: QueryFilter): Hit[] {
    this.#writeCast(box, direction, limit);
    return this.#hits(Query.CastAll, filter);
  }

  /**
   * The `k` bodies nearest to a point, or all if there are fewer, sorted by distance and then by slot.
   * None is farther away than `maxDistance`. A function as `filter` is called nearest first, until it
   * has returned true `k` times.
   *
   * @throws `RangeError` if the point is not finite, `k` not a whole number, or the distance negative or NaN.
   */
  nearest(point: Point, k: number = 1, maxDistance: number = Infinity, filter?: QueryFilter): Neighbor[] {
    checkCount(k, "k");
    checkLength(maxDistance, "maxDistance");
    this.#memory.writeCorners(0, point, 1, "point", "finite");
    const near = (hits: Hit[]) => hits.map(({ id, t }) => ({ id, distance: Math.sqrt(t) })).filter(({ distance }) => distance <= maxDistance);
    if (typeof filter !== "function") return near(this.#hits(Query.Nearest, filter, k));
    // Twice as many each time, since only the search knows who is next.
    const accepted: Neighbor[] = [];
    for (let asked = 2 * k, seen = 0; accepted.length < k; asked *= 2) {
      this.#memory.writeCorners(0, point, 1, "point", "finite");
      const found = near(this.#hits(Query.Nearest, undefined, Math.min(asked, 2 ** 32 - 1)));
      for (; seen < found.length && accepted.length < k; seen++) {
        if (filter(found[seen]!.id)) accepted.push(found[seen]!);
      }
      if (found.length < asked) break;
    }
    return accepted;
  }

  /**
   * A copy of the whole state as bytes, for rollback, replay and saved games. Equal states give equal
   * bytes.
   */
  snapshot(): Uint8Array<ArrayBuffer> {
    this.#memory.call((exports, world) => exports.world_snapshot(world));
    return this.#memory.bytes();
  }

  /** A 64-bit hash of the whole state, equal for equal states on every machine. */
  stateHash(): bigint {
    this.#memory.call((exports, world) => exports.world_state_hash(world));
    return this.#memory.bits();
  }

  /** Frees the memory. The object cannot be used any more. Freeing it twice is not an error. */
  free(): void {
    this.#memory.free();
  }

  /** As {@link BroadPhase.free}, for `using`. */
  [Symbol.dispose](): void {
    this.free();
  }

  #ask(query: Query, filter: QueryFilter | undefined): Float64Array {
    const ids = this.#memory.answer((exports, world) => exports.world_query(world, query, 0, ...wordsOf(filter)), oneBox);
    // With the option `views`, the function could let them become stale.
    return typeof filter === "function" ? Float64Array.from(ids).filter((id) => filter(id)) : ids;
  }

  #hits(query: Query, filter: QueryFilter | undefined, k = 0): Hit[] {
    const hits = this.#memory.hits((exports, world) => exports.world_query(world, query, k, ...wordsOf(filter)));
    return typeof filter === "function" ? hits.filter(({ id }) => filter(id)) : hits;
  }

  #firstHit(filter: QueryFilter | undefined): Hit | undefined {
    if (typeof filter !== "function") return this.#hits(Query.Cast, filter)[0];
    return this.#hits(Query.CastAll, undefined).find(({ id }) => filter(id));
  }

  #writeRay(origin: Point, direction: Point, limit: number): void {
    this.#memory.writeCorners(0, origin, 1, "origin", "finite");
    this.#memory.writeCorners(this.#memory.stored, origin, 1, "origin", "finite");
    this.#writePath(direction, limit);
  }

  #writeCast(box: Box, direction: Point, limit: number): void {
    this.#memory.writeCorners(0, box, 2, "box", "finite");
    this.#writePath(direction, limit);
  }

  #writePath(direction: Point, limit: number): void {
    checkLength(limit, "limit");
    this.#memory.writeCorners(2 * this.#memory.stored, direction, 1, "direction", "finite");
    this.#memory.numbers()[3 * this.#memory.stored] = limit;
  }
}

/** The filter of a query as the core takes it: none if it is a function, which is called afterwards. */
function wordsOf(filter: QueryFilter | undefined): FilterWords {
  return filter == null || typeof filter === "function" ? noFilter : filterWords(filter, defaultFilter);
}

const none: Float64Array = new Float64Array(0);

/** The box of a call that has only one. */
const oneBox = { boxes: [["box", 1]] } as const;

/** The options with their defaults. */
function checkOptions(options: BroadPhaseOptions): Required<BroadPhaseOptions> {
  const dimensions = checkDimensions(options?.dimensions);
  const { precision = "single", report = "exact", margin = 0, prediction = 0 } = options;
  const views = checkViews(options.views);
  if (precision !== "single" && precision !== "double") {
    throw new RangeError(`\`precision\` must be "single" or "double", not ${describe(precision)}`);
  }
  if (report !== "exact" && report !== "fat") {
    throw new RangeError(`\`report\` must be "exact" or "fat", not ${describe(report)}`);
  }
  for (const [name, value] of [["margin", margin], ["prediction", prediction]] as const) {
    if (!(Number.isFinite(value) && value >= 0)) throw new RangeError(`\`${name}\` is ${describe(value)}; it must be finite, and 0 or more`);
  }
  return { dimensions, precision, report, margin, prediction, views };
}
