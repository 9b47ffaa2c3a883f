import { describe } from "../wasm/describe.js";
import { Bodies, checkOptions, oneBox } from "./bodies.js";
import { checkDimensions, type Dimensions } from "../boxes/boxes.js";
import { checkFits, Code } from "../wasm/engine.js";
import { OutOfMemoryError } from "../wasm/errors.js";
import { defaultFilter, filterWords, type FilterWords } from "./filter.js";
import { checkCount, checkLength, checkRule, checkSorted, type QueryChoices, readChoices, readPoint } from "./query-arguments.js";
import { SnapshotError } from "./snapshot-error.js";
import { checkId, readCorners } from "./arguments.js";
import { Query, worldCore } from "./core.js";
import { checkOptionNames } from "../wasm/options.js";
import { lengthOf, tagOf } from "../wasm/typed.js";
import { checkViews } from "../wasm/views.js";
import { newWorld, WorldMemory } from "./memory.js";
import type { Box, BroadPhaseOptions, CastOptions, ExcludeOptions, Hit, Neighbor, Point, ProxyId, QueryFilter, QueryOptions, SortOptions } from "./types.js";

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
export class BroadPhase extends Bodies {
  /**
   * An empty broad phase.
   *
   * @throws {@link NotInitializedError} before `init()` is done.
   * @throws `RangeError` for dimensions other than 1, 2 and 3, or a margin or prediction that is
   *   negative, infinite or NaN; `TypeError` if `views` is not a boolean.
   */
  constructor(options: BroadPhaseOptions) {
    const given: unknown = options;
    super(given instanceof WorldMemory ? given : WorldMemory.create(worldCore, checkOptions(options)));
  }

  /**
   * Restores a {@link BroadPhase.snapshot}: for the same calls it gives the same ids, events and
   * results. The other options are in the bytes.
   *
   * @throws {@link SnapshotError} if the bytes are not a snapshot of boxes with these dimensions.
   */
  static fromSnapshot(bytes: Uint8Array, options: { dimensions: Dimensions; views?: boolean }): BroadPhase {
    if (tagOf(bytes) !== "Uint8Array") throw new TypeError(`\`bytes\` must be a Uint8Array, not ${describe(bytes)}`);
    checkOptionNames(options, ["dimensions", "views"]);
    const memory: unknown = restore(bytes, checkDimensions(options.dimensions), checkViews(options.views));
    return new BroadPhase(memory as BroadPhaseOptions);
  }

  /**
   * The pairs that overlapped at the last update: `a0, b0, a1, b1, ...`, sorted by slot. With
   * `{ sorted: false }` they are in no particular order, which takes less time.
   */
  pairs(options?: SortOptions): Float64Array {
    const isSorted = checkSorted(options);
    return this.memory.answer((exports, world) => exports.world_pairs(world, isSorted));
  }

  /**
   * The bodies that overlapped this one at the last update, sorted by slot.
   *
   * @throws {@link StaleProxyError}.
   */
  pairsOf(id: ProxyId): Float64Array {
    checkId(id);
    return this.memory.answer((exports, world) => exports.world_pairs_of(world, id), { ids: [id] });
  }

  /**
   * The bodies whose boxes, as last set, overlap a box, sorted by slot.
   *
   * In all queries, `filter` is the filter of an imagined body: the query finds the bodies that may
   * pair with it. Or it is a function that gets an id and returns whether the query finds that body. It
   * is called after the search, so it may call anything. Without a filter a query finds every body. With
   * `{ sorted: false }` the bodies are in no particular order: sorting takes a quarter of the time for 100 bodies, and
   * half for 10,000.
   *
   * @throws {@link InvalidBoxError}; and what `filter` throws.
   */
  overlapping(box: Box, filter?: QueryFilter, options?: QueryOptions): Float64Array {
    return this.#ask(Query.Overlapping, readCorners(box, this.dimensions, "box"), 0, filter, options);
  }

  /**
   * The bodies whose boxes contain a point, sorted by slot.
   *
   * @throws `RangeError` for a NaN.
   */
  containing(point: Point, filter?: QueryFilter, options?: QueryOptions): Float64Array {
    return this.#ask(Query.Containing, this.#readPoint(point, "point", "a number"), 0, filter, options);
  }

  /**
   * The bodies whose boxes are at most `radius` away from `center`, sorted by slot.
   *
   * @throws `RangeError` if the center is not finite, or the radius negative or NaN.
   */
  within(center: Point, radius: number, filter?: QueryFilter, options?: QueryOptions): Float64Array {
    checkLength(radius, "radius");
    return this.#ask(Query.Within, this.#readPoint(center, "center"), radius, filter, options);
  }

  /**
   * The first body that a ray hits, with `t` of the hit, which is at `origin + t * direction`. The
   * ray ends at `t = limit`. `direction` may have any length: if its length is 1, `t` is a distance.
   * Of several bodies hit at once it is the one with the smallest slot.
   *
   * The ray is tested against boxes. To find the first hit of what is inside the boxes, pass a function
   * as `filter`, which is called nearest first until it returns true, or test the results of
   * {@link BroadPhase.rayCastAll}. With a function all hits are searched first; to leave out single bodies, pass
   * `{ exclude }`, which takes no longer than without. `{ ignoreTouching: true }` passes what the ray only touches.
   *
   * @throws `RangeError` if the origin or the direction is not finite, or the limit negative or NaN.
   */
  rayCast(origin: Point, direction: Point, limit: number = Infinity, filter?: QueryFilter, options?: CastOptions): Hit | undefined {
    return this.#firstHit(this.#readRay(origin, direction, limit), filter, options);
  }

  /**
   * All bodies that a ray hits, nearest first.
   *
   * @throws As {@link BroadPhase.rayCast}.
   */
  rayCastAll(origin: Point, direction: Point, limit: number = Infinity, filter?: QueryFilter, options?: CastOptions): Hit[] {
    return this.#allHits(this.#readRay(origin, direction, limit), filter, options);
  }

  /**
   * The first body that a moving box hits.
   *
   * @throws As {@link BroadPhase.rayCast}, also if the box is inverted.
   */
  boxCast(box: Box, direction: Point, limit: number = Infinity, filter?: QueryFilter, options?: CastOptions): Hit | undefined {
    return this.#firstHit(this.#readCast(box, direction, limit), filter, options);
  }

  /**
   * All bodies that a moving box hits, nearest first.
   *
   * @throws As {@link BroadPhase.boxCast}.
   */
  boxCastAll(box: Box, direction: Point, limit: number = Infinity, filter?: QueryFilter, options?: CastOptions): Hit[] {
    return this.#allHits(this.#readCast(box, direction, limit), filter, options);
  }

  /**
   * The `k` bodies nearest to a point, or all if there are fewer, sorted by distance and then by slot.
   * None is farther away than `maxDistance`: no farther parts of the world are searched, so a small one saves time. A
   * function as `filter` is called nearest first, until it
   * has returned true `k` times.
   *
   * @throws `RangeError` if the point is not finite, `k` not a whole number, or the distance negative or NaN.
   */
  nearest(point: Point, k: number = 1, maxDistance: number = Infinity, filter?: QueryFilter, options?: ExcludeOptions): Neighbor[] {
    checkCount(k, "k");
    checkLength(maxDistance, "maxDistance");
    const from = this.#readPoint(point, "point");
    const words = wordsOf(filter);
    const choices = readChoices(options, "nearest");
    const search = (wanted: number): Neighbor[] => {
      const found = this.#found(Query.Nearest, () => this.#writeSphere(from, maxDistance), words, choices, Math.min(wanted, 2 ** 32 - 1));
      // The search compares squares, and finds a little more.
      return found.map(({ id, t }) => ({ id, distance: Math.sqrt(t) })).filter(({ distance }) => distance <= maxDistance);
    };
    if (typeof filter !== "function") return search(k);
    // Twice as many each time, since only the search knows which is next. The function may change the world, too.
    const accepted: Neighbor[] = [];
    const asked = new Set<ProxyId>();
    const most = this.size;
    for (let wanted = 2 * k; accepted.length < k; wanted *= 2) {
      for (const neighbor of search(wanted)) {
        if (accepted.length === k) break;
        if (asked.has(neighbor.id)) continue;
        asked.add(neighbor.id);
        if (filter(neighbor.id)) accepted.push(neighbor);
      }
      if (wanted >= most) break;
    }
    return accepted;
  }

  /**
   * A copy of the whole state as bytes, for rollback, replay and saved games. Equal states give equal
   * bytes.
   */
  snapshot(): Uint8Array<ArrayBuffer> {
    this.memory.call((exports, world) => exports.world_snapshot(world));
    const { engine } = this.memory;
    return new Uint8Array(engine.exports.memory.buffer, engine.detail(0), engine.detail(1)).slice();
  }

  /** A 64-bit hash of the whole state, equal for equal states on every machine. */
  stateHash(): bigint {
    this.memory.call((exports, world) => exports.world_state_hash(world));
    const { engine } = this.memory;
    return (BigInt(engine.detail(1)) << 32n) | BigInt(engine.detail(0));
  }

  #ask(query: Query, corners: Float64Array, radius: number, filter: QueryFilter | undefined, options: QueryOptions | undefined): Float64Array {
    const [category, mask, group, isStatic] = wordsOf(filter);
    const { isSorted, excluded } = readChoices(options, "region");
    const count = this.#writeExcluded(excluded);
    if (query === Query.Within) this.#writeSphere(corners, radius);
    else this.memory.write(0, corners);
    const ids = this.memory.answer((exports, world) => exports.world_query(world, query, 0, category, mask, group, isStatic, isSorted, count), oneBox);
    // With the option `views`, the function could let them become stale.
    return typeof filter === "function" ? Float64Array.from(ids).filter((id) => filter(id)) : ids;
  }

  /** Makes a query whose numbers `write` writes; what it found, with a value for each. */
  #found(query: Query, write: () => void, [category, mask, group, isStatic]: FilterWords, { excluded }: QueryChoices, k = 0): { id: ProxyId; t: number }[] {
    const excludedCount = this.#writeExcluded(excluded);
    write();
    this.memory.call((exports, world) => exports.world_query(world, query, k, category, mask, group, isStatic, 1, excludedCount));
    const { engine } = this.memory;
    const { buffer } = engine.exports.memory;
    const count = engine.detail(1);
    const ids = new Float64Array(buffer, engine.detail(0), count);
    const values = new Float64Array(buffer, this.memory.numbers()[0]!, count);
    return Array.from(ids, (id, at) => ({ id, t: values[at]! }));
  }

  #hits(query: Query, path: Path, words: FilterWords, choices: QueryChoices): Hit[] {
    const found = this.#found(query, () => this.#writePath(path), words, choices);
    const { buffer } = this.memory.engine.exports.memory;
    const faces = new Uint8Array(buffer, this.memory.numbers()[1]!, found.length);
    return found.map(({ id, t }, at) => ({ id, t, ...this.#faceOf(faces[at]!) }));
  }

  /** The normal of a face as the core numbers it. A face on an axis that is only stored is none: there the cast starts inside. */
  #faceOf(face: number): { normal: number[]; startsInside: boolean } {
    const axis = Math.ceil(face / 2) - 1;
    const startsInside = axis < 0 || axis >= this.dimensions;
    const normal = Array.from({ length: this.dimensions }, (_, at) => (at !== axis ? 0 : face % 2 ? -1 : 1));
    return { normal, startsInside };
  }

  #allHits(path: Path, filter: QueryFilter | undefined, options: CastOptions | undefined): Hit[] {
    const words = wordsOf(filter);
    const choices = readChoices(options, "cast");
    const hits = this.#hits(choices.ignoresTouching ? Query.CastAllEntering : Query.CastAll, path, words, choices);
    return typeof filter === "function" ? hits.filter(({ id }) => filter(id)) : hits;
  }

  #firstHit(path: Path, filter: QueryFilter | undefined, options: CastOptions | undefined): Hit | undefined {
    if (typeof filter === "function") return this.#allHits(path, undefined, options).find(({ id }) => filter(id));
    const words = wordsOf(filter);
    const choices = readChoices(options, "cast");
    return this.#hits(choices.ignoresTouching ? Query.CastEntering : Query.Cast, path, words, choices)[0];
  }

  /** Writes the ids that a query does not find, and returns how many there are. */
  #writeExcluded(excluded: Float32Array | Float64Array): number {
    const count = lengthOf(excluded);
    if (count > 0) this.memory.writeIds(this.memory.keepIds(excluded));
    return count;
  }

  #readRay(origin: Point, direction: Point, limit: number): Path {
    const start = this.#readPoint(origin, "origin");
    const box = new Float64Array(2 * start.length);
    box.set(start);
    box.set(start, start.length);
    return this.#readPath(box, direction, limit);
  }

  #readCast(box: Box, direction: Point, limit: number): Path {
    return this.#readPath(checkRule(readCorners(box, this.dimensions, "box"), "box", "finite"), direction, limit);
  }

  #readPath(box: Float64Array, direction: Point, limit: number): Path {
    checkLength(limit, "limit");
    return { box, direction: this.#readPoint(direction, "direction"), limit };
  }

  #writePath({ box, direction, limit }: Path): void {
    const { stored } = this.memory;
    this.memory.write(0, box);
    this.memory.write(2 * stored, direction);
    this.memory.numbers()[3 * stored] = limit;
  }

  #readPoint(point: Point, name: string, rule: "finite" | "a number" = "finite"): Float64Array {
    return checkRule(readPoint(point, this.dimensions, name), name, rule);
  }

  #writeSphere(center: Float64Array, radius: number): void {
    this.memory.write(0, center);
    this.memory.numbers()[this.memory.stored] = radius;
  }
}

/** A moving box. */
interface Path {
  readonly box: Float64Array;
  readonly direction: Float64Array;
  readonly limit: number;
}

/** The broad phase of a snapshot. */
function restore(bytes: Uint8Array, dimensions: Dimensions, isView: boolean): WorldMemory {
  const engine = worldCore.engine();
  const length = lengthOf(bytes);
  checkFits(length);
  const handle = newWorld(engine, dimensions, false);
  try {
    engine.calls++;
    const at = handle.call((exports, world) => exports.world_bytes(world, length)) >>> 0;
    if (at === 0) throw new OutOfMemoryError();
    new Uint8Array(engine.exports.memory.buffer, at, length).set(bytes);
    const code = handle.call((exports, world) => exports.world_restore(world));
    if (code === Code.InvalidSnapshot) throw new SnapshotError(engine.detail(0), engine.detail(1));
    engine.check(code);
    return new WorldMemory(dimensions, engine.detail(0) !== 0, isView, handle);
  } catch (error) {
    handle.free();
    throw error;
  }
}

/** What the core takes for no filter: a query without one finds every body. */
const noFilter: FilterWords = [0, 0, 0, 2];

/** The filter of a query as the core takes it: none if it is a function, which is called afterwards. */
function wordsOf(filter: QueryFilter | undefined): FilterWords {
  return filter == null || typeof filter === "function" ? noFilter : filterWords(filter, defaultFilter);
}
