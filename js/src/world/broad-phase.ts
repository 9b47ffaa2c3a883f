import { describe } from "../wasm/describe.js";
import { checkOptions, oneBox } from "./bodies.js";
import { type Boxes, checkBoxes, checkDimensions, type Dimensions } from "../boxes/boxes.js";
import { checkFits, Code } from "../wasm/engine.js";
import { OutOfMemoryError } from "../wasm/errors.js";
import { checkSorted } from "./query-arguments.js";
import { SnapshotError } from "./snapshot-error.js";
import { checkId, checkIds } from "./arguments.js";
import { worldCore } from "./core.js";
import { checkOptionNames } from "../wasm/options.js";
import { lengthOf, tagOf } from "../wasm/typed.js";
import { allocate, checkViews } from "../wasm/views.js";
import { defaultFilter, type Filter, filterNames, type FilterWords, filterWords } from "./filter.js";
import { StaleProxyError } from "./stale-proxy-error.js";
import { Batches } from "./batches.js";
import { newWorld, WorldMemory } from "./memory.js";
import { type Box, type BroadPhaseOptions, type Changes, type Corners, type InsertOptions, type Numbers, type PairsByBody, type ProxyId, slotOf, type SortOptions } from "./types.js";

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
 * exception: a `BroadPhase` that runs out of memory is freed, unless it was the pairs of an update or the answer to queries
 * that did not fit.
 */
export class BroadPhase<D extends Dimensions = Dimensions, Data = unknown> extends Batches<D> {
  /** What was given with the bodies, by id. */
  #data = new Map<ProxyId, Data>();
  /** The removed bodies whose data is still here: those that the next update reports, and those that the last one did. */
  #leaving: ProxyId[] = [];
  #left: ProxyId[] = [];

  /**
   * An empty broad phase.
   *
   * @throws {@link NotInitializedError} before `init()` is done.
   * @throws `RangeError` for dimensions other than 1, 2 and 3, or a margin or prediction that is
   *   negative, infinite or NaN; `TypeError` if `views` is not a boolean.
   */
  constructor(options: BroadPhaseOptions<D>) {
    const given: unknown = options;
    super(given instanceof WorldMemory ? given : WorldMemory.create(worldCore, checkOptions(options)));
  }

  /**
   * Restores a {@link BroadPhase.snapshot}: for the same calls it gives the same ids, events and
   * results. The other options are in the bytes.
   *
   * @throws {@link SnapshotError} if the bytes are not a snapshot of boxes with these dimensions.
   */
  static fromSnapshot<D extends Dimensions, Data = unknown>(bytes: Uint8Array, options: { dimensions: D; views?: boolean }): BroadPhase<D, Data> {
    checkBytes(bytes);
    checkOptionNames(options, ["dimensions", "views"]);
    const memory: unknown = restored(bytes, checkDimensions(options.dimensions), checkViews(options.views));
    return new BroadPhase(memory as BroadPhaseOptions<D>);
  }

  /**
   * Adds a body with this box: an object or an array, and what it is to have beside: a filter, and data of yours; or
   * separate numbers, the min corner and then the max corner.
   *
   * @throws {@link InvalidBoxError} if the box is inverted or NaN; `TypeError` if the arguments are
   *   not as many numbers as a box has; `RangeError` if an array does not have as many; what {@link Bodies.setFilter}
   *   throws for a filter.
   *
   * @example
   * ```js
   * const id = world.insert(sprite.getBounds(), { category: 2, mask: 1, data: sprite });
   * world.data(id).visible = false;
   * ```
   */
  override insert(box: Box<D>, options?: InsertOptions<Data>): ProxyId;
  override insert(...corners: Corners<D>): ProxyId;
  override insert(a?: unknown, b?: unknown, c?: unknown, d?: unknown, e?: unknown, f?: unknown, more?: unknown): ProxyId {
    const held = this.#data; // first: a proxy of a world has none, and throws
    const hasOptions = typeof a === "object" && a !== null && typeof b === "object" && b !== null;
    const options = hasOptions ? readInsertOptions<Data>(b) : undefined;
    this.memory.writeBox(a, options ? undefined : b, c, d, e, f, more);
    this.memory.call((exports, world) => exports.world_insert(world), oneBox);
    const id = this.memory.numbers()[0]!;
    if (options?.words) this.memory.call((exports, world) => exports.world_set_filter(world, id, ...options.words!));
    keep(held, id, options);
    return id;
  }

  /**
   * Adds bodies with one filter, or each with its own, and with data of yours, one for each box. Their ids are in the order
   * of their boxes.
   *
   * @throws {@link InvalidBoxError} with the index of the first bad box; then none was added. `RangeError` if there are
   *   not as many filters, or data, as boxes.
   */
  override insertMany(boxes: Boxes<D>, filter: Partial<Filter> | readonly Partial<Filter>[] = defaultFilter, data?: readonly Data[]): Float64Array {
    const held = this.#data;
    if (data === undefined && held.size === 0) return super.insertMany(boxes, filter);
    if (data !== undefined && !Array.isArray(data)) throw new TypeError(`\`data\` must be an array, not ${describe(data)}`);
    const given = data && [...data];
    const rows = checkBoxes(boxes, this.dimensions);
    const count = lengthOf(rows) / (2 * this.dimensions);
    if (given && given.length !== count) throw new RangeError(`\`data\` has ${given.length} and \`boxes\` ${count} boxes; there must be as many`);
    const ids = super.insertMany(rows, filter);
    ids.forEach((id, at) => keep(held, id, given && { data: given[at]! }));
    return ids;
  }

  /**
   * The data of a body, or `undefined` if it has none. That of a removed body stays until the update after the one that
   * reports the end of its pairs.
   */
  data(id: ProxyId): Data | undefined {
    return this.#data.get(id);
  }

  /**
   * Gives a body other data.
   *
   * @throws {@link StaleProxyError}.
   */
  setData(id: ProxyId, data: Data): void {
    if (!this.contains(checkId(id))) throw new StaleProxyError(0, id);
    this.#data.set(id, data);
  }

  /**
   * The data of bodies: of those that a query finds. A body that was inserted without has none, whatever the type says.
   *
   * @example
   * ```js
   * for (const sprite of world.dataOf(world.overlapping(marquee))) sprite.selected = true;
   * ```
   */
  dataOf(ids: Numbers): Data[] {
    return Array.from(new Float64Array(checkIds(ids)), (id) => this.#data.get(id)!);
  }

  /**
   * The data of pairs, two ids each: of those that began or ended, or that overlap. As in {@link BroadPhase.dataOf}, bodies
   * without data have none.
   *
   * @example
   * ```js
   * for (const [bullet, enemy] of world.dataPairs(world.update().begun)) enemy.hitBy(bullet);
   * ```
   */
  dataPairs(ids: Numbers): [Data, Data][] {
    const all = this.dataOf(ids);
    return Array.from({ length: all.length / 2 }, (_, at) => [all[2 * at]!, all[2 * at + 1]!]);
  }

  override remove(id: ProxyId): void;
  override remove(id: ProxyId, more?: unknown): void {
    const leaving = this.#leaving;
    (super.remove as (id: ProxyId, more?: unknown) => void).call(this, id, more);
    if (this.#data.size > 0) leaving.push(id);
  }

  override removeMany(ids: Numbers): void {
    if (this.#data.size === 0) return super.removeMany(ids);
    const given = new Float64Array(checkIds(ids));
    super.removeMany(given);
    for (const id of given) this.#leaving.push(id);
  }

  override update(): Changes {
    const isAnyGone = this.#leaving.length + this.#left.length > 0;
    const changes = super.update();
    if (isAnyGone) {
      // After a `restore`, such a body may be here again, or have been removed again.
      const again = new Set(this.#leaving);
      for (const id of this.#left) if (!again.has(id) && !this.contains(id)) this.#data.delete(id);
      this.#left = this.#leaving;
      this.#leaving = [];
    }
    return changes;
  }

  override free(): void {
    const data = this.#data;
    super.free();
    data.clear();
  }

  /**
   * The boxes of bodies as last set, as rows in the precision of the world: min corner, max corner. A copy.
   *
   * @throws {@link StaleProxyError} with the index of the first bad id.
   */
  boxes(ids: Numbers): Float32Array | Float64Array {
    const given = new Float64Array(checkIds(ids));
    const width = 2 * this.dimensions;
    const Floats = this.memory.isDouble ? Float64Array : Float32Array;
    const boxes = allocate(() => new Floats(width * given.length));
    const stale = given.findIndex((id) => !this.contains(id));
    if (stale >= 0) throw new StaleProxyError(stale, given[stale]!);
    given.forEach((id, at) => boxes.set(this.box(id), width * at));
    return boxes;
  }

  /**
   * Excludes a pair, whatever the filters of its bodies allow: those of a joint, say. It ends at the next update if it was
   * there, and does not begin until it is {@link BroadPhase.includePair | included} again. A body that is removed is
   * forgotten, and a pair of a body with itself is never there.
   *
   * @throws {@link StaleProxyError} with index 0 for `a` and 1 for `b`.
   */
  excludePair(a: ProxyId, b: ProxyId): void {
    this.#exclude(a, b, 1);
  }

  /**
   * Includes a pair that was {@link BroadPhase.excludePair | excluded}.
   *
   * @throws As {@link BroadPhase.excludePair}.
   */
  includePair(a: ProxyId, b: ProxyId): void {
    this.#exclude(a, b, 0);
  }

  /**
   * Whether a pair is {@link BroadPhase.excludePair | excluded}.
   *
   * @throws As {@link BroadPhase.excludePair}.
   */
  isExcluded(a: ProxyId, b: ProxyId): boolean {
    this.#exclude(a, b, 2);
    return this.memory.numbers()[0] === 1;
  }

  #exclude(a: ProxyId, b: ProxyId, excluded: number): void {
    const ids = [checkId(a), checkId(b)];
    this.memory.call((exports, world) => exports.world_exclude(world, a, b, excluded), { ids });
  }

  /**
   * The pairs of {@link BroadPhase.pairs} by body: the ids of the bodies that pair with that in slot `s` (see {@link slotOf})
   * are `others.subarray(starts[s], starts[s + 1])`, sorted by slot. Takes the time of listing all pairs, where asking
   * {@link BroadPhase.pairsOf} for each body takes much more.
   */
  pairsByBody(): PairsByBody {
    const countIn = (ids: Float64Array): number => ids.reduce((most, id) => Math.max(most, slotOf(id) + 1), 0);
    const ids = countIn(this.ids()); // before the pairs, which may be a view that another call overwrites
    const pairs = this.pairs();
    const count = Math.max(ids, countIn(pairs));
    const starts = allocate(() => new Uint32Array(count + 1));
    const others = allocate(() => new Float64Array(pairs.length));
    // First how many there are, then where each ends; filled from the end, what is left is where each starts.
    pairs.forEach((id) => starts[slotOf(id)]!++);
    for (let at = 1; at <= count; at++) starts[at]! += starts[at - 1]!;
    for (let at = pairs.length - 1; at >= 0; at--) others[--starts[slotOf(pairs[at]!)]!] = pairs[at ^ 1]!;
    return { starts, others };
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
  pairsOf(id: ProxyId): ProxyId[] {
    checkId(id);
    this.memory.call((exports, world) => exports.world_pairs_of(world, id), { ids: [id] });
    return this.found();
  }

  /**
   * A copy of the whole state as bytes, for rollback, replay and saved games. Equal states give equal
   * bytes.
   */
  snapshot(): Uint8Array<ArrayBuffer> {
    this.memory.call((exports, world) => exports.world_snapshot(world));
    const { engine } = this.memory;
    return new Uint8Array(engine.buffer, engine.detail(0), engine.detail(1)).slice();
  }

  /**
   * Becomes what it was at a {@link BroadPhase.snapshot}, with the ids of then. The next update reports what changed since
   * the last one before the snapshot. The bytes hold no data: bodies have that which they had last. That of a body that was
   * removed is gone after two updates: give it with {@link BroadPhase.setData}.
   *
   * @throws {@link SnapshotError} if the bytes are not a snapshot of boxes with these dimensions; `RangeError` if they are
   *   of another precision. Then nothing has changed.
   */
  restore(bytes: Uint8Array): void {
    checkBytes(bytes);
    this.memory.checkUsable();
    const memory = restored(bytes, this.dimensions, this.memory.isView);
    if (memory.isDouble !== this.memory.isDouble) {
      memory.free();
      throw new RangeError(`the snapshot is of ${memory.isDouble ? "double" : "single"} precision, and this BroadPhase is not; use \`fromSnapshot\``);
    }
    this.memory.free();
    this.memory = memory;
    for (const id of this.#data.keys()) if (!this.contains(id)) this.#leaving.push(id);
  }

  /** Another broad phase with the same bodies, ids and pairs, and the same data: what happens to one does not change the other. */
  clone(): BroadPhase<D, Data> {
    const { dimensions } = this;
    const clone = BroadPhase.fromSnapshot<D, Data>(this.snapshot(), { dimensions, views: this.memory.isView });
    clone.#data = new Map(this.#data);
    [clone.#leaving, clone.#left] = [[...this.#leaving], [...this.#left]];
    return clone;
  }

  /** A 64-bit hash of the whole state, equal for equal states on every machine. */
  stateHash(): bigint {
    this.memory.call((exports, world) => exports.world_state_hash(world));
    const { engine } = this.memory;
    return (BigInt(engine.detail(1)) << 32n) | BigInt(engine.detail(0));
  }
}

function checkBytes(bytes: Uint8Array): void {
  if (tagOf(bytes) !== "Uint8Array") throw new TypeError(`\`bytes\` must be a Uint8Array, not ${describe(bytes)}`);
}

const insertOptions = ["data", ...filterNames];

/** What a body is to have beside its box: its filter as the core takes it, if it has one of its own. */
function readInsertOptions<Data>(options: unknown): { words?: FilterWords; data?: Data } {
  checkOptionNames(options, insertOptions);
  // Each by its name, as of filters: they may be getters of a class.
  const { data, category, mask, group, isStatic } = options as { [Key in keyof InsertOptions<Data>]: InsertOptions<Data>[Key] | undefined };
  const isFiltered = category !== undefined || mask !== undefined || group !== undefined || isStatic !== undefined;
  return {
    ...(isFiltered && { words: filterWords({ category, mask, group, isStatic } as Partial<Filter>, defaultFilter) }),
    ...("data" in (options as object) && { data: data! }),
  };
}

/** Keeps the data of a new body. Without any, it has none, even if another one had its id before a {@link BroadPhase.restore}. */
function keep<Data>(held: Map<ProxyId, Data>, id: ProxyId, given: { data?: Data } | undefined): void {
  if (given && "data" in given) held.set(id, given.data!);
  else if (held.size > 0) held.delete(id);
}

/** The broad phase of a snapshot. */
function restored(bytes: Uint8Array, dimensions: Dimensions, isView: boolean): WorldMemory {
  const engine = worldCore.engine();
  const length = lengthOf(bytes);
  checkFits(length);
  const handle = newWorld(engine, dimensions, false);
  try {
    engine.calls++;
    const at = handle.call((exports, world) => exports.world_bytes(world, length)) >>> 0;
    if (at === 0) throw new OutOfMemoryError();
    new Uint8Array(engine.buffer, at, length).set(bytes);
    const code = handle.call((exports, world) => exports.world_restore(world));
    if (code === Code.InvalidSnapshot) throw new SnapshotError(engine.detail(0), engine.detail(1));
    engine.check(code);
    return new WorldMemory(dimensions, engine.detail(0) !== 0, isView, handle);
  } catch (error) {
    handle.free();
    throw error;
  }
}
