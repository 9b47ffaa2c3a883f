/// <reference lib="esnext.disposable" preserve="true" />
import { describe } from "../wasm/describe.js";
import { type Boxes, checkDimensions, type Dimensions } from "../boxes/boxes.js";
import { defaultFilter, type Filter, type FilterWords, filterWords } from "./filter.js";
import { checkOptionNames } from "../wasm/options.js";
import { lengthOf } from "../wasm/typed.js";
import { allocate, checkViews, guard } from "../wasm/views.js";
import { checkId, checkIds, checkRule, readCorners, readPoint } from "./arguments.js";
import type { WorldMemory } from "./memory.js";
import type { Box, BroadPhaseOptions, Buffers, Changes, Corners, Numbers, Point, ProxyId } from "./types.js";

/** Bodies with boxes: which overlaps began and which ended. What every entry point with a `BroadPhase` has. */
export abstract class Bodies<D extends Dimensions = Dimensions> {
  /** @internal */
  protected memory: WorldMemory;
  readonly #changes: Changes = { begun: none, ended: none };

  /** @internal */
  protected constructor(memory: WorldMemory) {
    this.memory = memory;
  }

  /** How many dimensions the boxes have. */
  get dimensions(): D {
    return this.memory.dimensions as D;
  }

  /** The precision of the coordinates. */
  get precision(): "single" | "double" {
    return this.memory.isDouble ? "double" : "single";
  }

  /** How many bodies there are. */
  get size(): number {
    return this.memory.ask((exports, world) => exports.world_len(world)) >>> 0;
  }

  /** The ids of all bodies, sorted by slot. */
  ids(): Float64Array {
    return this.memory.answer((exports, world) => exports.world_ids(world));
  }

  /** Whether the body of an id is here: it was inserted here and not removed. */
  contains(id: ProxyId): boolean {
    const isId = typeof id === "number"; // the `valueOf` of an object could free the memory
    return this.memory.ask((exports, world) => (isId ? exports.world_contains(world, id) : 0)) !== 0;
  }

  /**
   * Adds a body with this box: an object, an array, or separate numbers, the min corner and then the
   * max corner. Its filter is the default one, until {@link Bodies.setFilter}.
   *
   * @throws {@link InvalidBoxError} if the box is inverted or NaN; `TypeError` if the arguments are
   *   not as many numbers as a box has; `RangeError` if an array does not have as many.
   */
  insert(box: Box<D>): ProxyId;
  insert(...corners: Corners<D>): ProxyId;
  insert(a?: unknown, b?: unknown, c?: unknown, d?: unknown, e?: unknown, f?: unknown, more?: unknown): ProxyId {
    this.memory.writeBox(a, b, c, d, e, f, more);
    this.memory.call((exports, world) => exports.world_insert(world), oneBox);
    return this.memory.numbers()[0]!;
  }

  /**
   * Adds bodies with one filter, or each with its own: an array of as many filters as boxes. Their ids are in the order
   * of their boxes.
   *
   * @throws {@link InvalidBoxError} with the index of the first bad box; then none was added. `RangeError` if there are
   *   not as many filters as boxes.
   */
  insertMany(boxes: Boxes<D>, filter: Partial<Filter> | readonly Partial<Filter>[] = defaultFilter): Float64Array {
    if (Array.isArray(filter)) return this.#insertEach(boxes, filter.map((one: Partial<Filter>) => filterWords(one, defaultFilter)));
    const words = filterWords(filter as Partial<Filter>, defaultFilter);
    const count = this.memory.writeRows(boxes);
    return this.memory.answer((exports, world) => exports.world_insert_many(world, count, ...words));
  }

  #insertEach(boxes: Boxes<D>, filters: readonly FilterWords[]): Float64Array {
    const count = this.memory.writeRows(boxes);
    if (filters.length !== count) throw new RangeError(`\`filter\` has ${filters.length} filters and \`boxes\` ${count} boxes; there must be as many`);
    const words = filterWords(defaultFilter, defaultFilter);
    // Copied: what follows may let the memory grow.
    const ids = Float64Array.from(this.memory.answer((exports, world) => exports.world_insert_many(world, count, ...words)));
    filters.forEach((own, at) => this.memory.call((exports, world) => exports.world_set_filter(world, ids[at]!, ...own)));
    return ids;
  }

  /**
   * Gives a body its new box.
   *
   * @throws {@link StaleProxyError}; otherwise as {@link Bodies.insert}.
   */
  set(id: ProxyId, box: Box<D>): void;
  set(id: ProxyId, ...corners: Corners<D>): void;
  set(id: ProxyId, a?: unknown, b?: unknown, c?: unknown, d?: unknown, e?: unknown, f?: unknown, more?: unknown): void {
    checkId(id);
    this.memory.writeBox(a, b, c, d, e, f, more);
    this.memory.call((exports, world) => exports.world_set(world, id, 0), { ids: [id], boxes: oneBox.boxes });
  }

  /**
   * Gives a body a new box to which it did not move: it was respawned, or went through a portal. With the option
   * `report: "fat"` its fat AABB does not reach ahead, and displacements count from here; otherwise the same as
   * {@link Bodies.set}.
   *
   * @throws As {@link Bodies.set}.
   */
  teleport(id: ProxyId, box: Box<D>): void;
  teleport(id: ProxyId, ...corners: Corners<D>): void;
  teleport(id: ProxyId, a?: unknown, b?: unknown, c?: unknown, d?: unknown, e?: unknown, f?: unknown, more?: unknown): void {
    checkId(id);
    this.memory.writeBox(a, b, c, d, e, f, more);
    this.memory.call((exports, world) => exports.world_set(world, id, 1), { ids: [id], boxes: oneBox.boxes });
  }

  /**
   * Adds an offset, given like a point, to the boxes of all bodies: for worlds whose origin follows the player.
   * The next {@link Bodies.update} reports no event because of it, except where rounding makes boxes touch, and takes
   * the time of finding all pairs.
   *
   * @throws `RangeError` if it does not have a finite number for each axis, `TypeError` if it has anything but numbers.
   */
  shift(offset: Point<D>): void {
    const numbers = readPoint(offset, this.dimensions, "offset");
    const rounded = this.memory.isDouble ? numbers : numbers.map(Math.fround);
    this.memory.write(0, checkRule(rounded, "offset", "finite"));
    this.memory.call((exports, world) => exports.world_shift(world));
  }

  /**
   * Gives each of many bodies its new box. If an id is given twice, its last box counts.
   *
   * @throws {@link StaleProxyError} or {@link InvalidBoxError} with the index of the first bad one,
   *   `RangeError` if there are not as many ids as boxes. Then no box has changed.
   */
  setMany(ids: Numbers, boxes: Boxes<D>): void {
    // Writing the boxes may let the memory grow, which leaves views of it empty.
    const kept = this.memory.keepIds(checkIds(ids));
    const count = this.memory.writeRows(boxes);
    const idCount = lengthOf(kept);
    if (idCount !== count) throw new RangeError(`\`ids\` has ${idCount} ids and \`boxes\` ${count} boxes; there must be as many`);
    this.memory.writeIds(kept);
    this.memory.call((exports, world) => exports.world_set_many(world, count), { ids: kept });
  }

  /**
   * Arrays to write many ids and boxes to. With the option `views` they are views of memory, valid until
   * the next call, and {@link Bodies.setMany} does not copy them. Without it, and for 1D boxes and 2D
   * boxes in double precision, which are stored in another form, they are ordinary arrays.
   *
   * @throws `RangeError` if `count` is not a whole number, {@link OutOfMemoryError}.
   */
  buffers(count: number): Buffers {
    this.memory.checkUsable();
    if (!(Number.isInteger(count) && count >= 0)) throw new RangeError(`\`count\` is ${describe(count)}; it must be a whole number, 0 or more`);
    const width = 2 * this.dimensions;
    if (!this.memory.isView || this.memory.stored !== this.dimensions) {
      const Floats = this.memory.isDouble ? Float64Array : Float32Array;
      return allocate(() => ({ ids: new Float64Array(count), boxes: new Floats(width * count) }));
    }
    const { memory } = this;
    memory.rowsFor(count);
    const ids = memory.idsFor(count); // may let the memory grow
    const boxes = memory.rowsFor(count);
    memory.engine.calls++;
    return { ids: guard(memory.engine, ids), boxes: guard(memory.engine, boxes) };
  }

  /**
   * Moves a fast body from one box to another: until the next update its box is the union of both,
   * and from then on `to`. So it pairs with bodies that it would have jumped over (and, if it moves
   * diagonally, with bodies beside its path).
   *
   * @throws {@link StaleProxyError}; {@link InvalidBoxError} for `from` or `to`.
   */
  setSwept(id: ProxyId, from: Box<D>, to: Box<D>): void {
    checkId(id);
    const [begin, end] = [readCorners(from, this.dimensions, "from"), readCorners(to, this.dimensions, "to")];
    this.memory.write(0, begin);
    this.memory.write(2 * this.memory.stored, end);
    this.memory.call((exports, world) => exports.world_set_swept(world, id), { ids: [id], boxes: [["from", 1], ["to", 1]] });
  }

  /**
   * The box of a body as last set: its min corner, its max corner. The array is a copy.
   *
   * @throws {@link StaleProxyError}.
   */
  box(id: ProxyId): number[] {
    return this.#box(id, 0);
  }

  /**
   * The box of a body whose overlaps are reported, as an array like that of {@link Bodies.box}: with the option
   * `report: "fat"` its fat AABB.
   *
   * @throws {@link StaleProxyError}.
   */
  reportedBox(id: ProxyId): number[] {
    return this.#box(id, 1);
  }

  #box(id: ProxyId, reported: number): number[] {
    checkId(id);
    this.memory.call((exports, world) => exports.world_box(world, id, reported), { ids: [id] });
    const [numbers, stored] = [this.memory.numbers(), this.memory.stored];
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
  remove(id: ProxyId): void;
  remove(id: ProxyId, more?: unknown): void {
    checkId(id);
    if (typeof more === "number") throw new TypeError("`remove` takes one id; `removeMany` takes an array of ids");
    this.memory.idsFor(1)[0] = id;
    this.memory.call((exports, world) => exports.world_remove_many(world, 1), { ids: [id] });
  }

  /**
   * Removes bodies.
   *
   * @throws {@link StaleProxyError} with the index of the first bad one, also of one that is given
   *   twice. Then no body was removed.
   */
  removeMany(ids: Numbers): void {
    const kept = this.memory.keepIds(checkIds(ids));
    this.memory.writeIds(kept);
    this.memory.call((exports, world) => exports.world_remove_many(world, lengthOf(kept)), { ids: kept });
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
    this.memory.call((exports, world) => exports.world_filter(world, id), { ids: [id] });
    const [category = 0, mask = 0, group = 0, isStatic = 0] = this.memory.numbers();
    return { category, mask, group, isStatic: isStatic !== 0 };
  }

  /**
   * Changes which other bodies a body may pair with. What is left out stays as it is.
   * The next update reports the pairs that begin and end because of it.
   *
   * @throws {@link StaleProxyError}; `RangeError` if `category`, `mask` or `group` is not a whole
   *   number of 32 bits.
   */
  setFilter(id: ProxyId, filter: Partial<Filter>): void {
    const words = filterWords(filter, this.filter(id));
    this.memory.call((exports, world) => exports.world_set_filter(world, id, ...words), { ids: [id] });
  }

  /**
   * Disables a body with `false`, or enables it again with `true`. While it is disabled it pairs with no other, and queries
   * do not find it; its box and its filter can be set. Its pairs end or begin at the next update.
   *
   * @throws {@link StaleProxyError}; `TypeError` if `enabled` is not a boolean.
   */
  setEnabled(id: ProxyId, enabled: boolean): void {
    checkId(id);
    if (typeof enabled !== "boolean") throw new TypeError(`\`enabled\` must be true or false, not ${describe(enabled)}`);
    this.memory.call((exports, world) => exports.world_set_enabled(world, id, +enabled), { ids: [id] });
  }

  /**
   * Whether a body is enabled, as it is until {@link Bodies.setEnabled} says otherwise.
   *
   * @throws {@link StaleProxyError}.
   */
  isEnabled(id: ProxyId): boolean {
    this.filter(id);
    return this.memory.numbers()[4] === 1;
  }

  /**
   * The pairs that began and ended since the last update. They are sorted by slot (see
   * {@link slotOf}), and the body with the smaller slot is first in its pair. The time depends on how
   * many bodies changed and how many neighbors they have. If most bodies move far, it can exceed the
   * time of finding all pairs (see the benchmark).
   *
   * With the option `views` it returns the same object each time, whose arrays are valid until the next
   * call.
   *
   * If the pairs of a crowd do not fit into memory, it throws an `OutOfMemoryError`, and the world is as before. Once the
   * crowd is apart, removed or filtered, the next call reports what changed. If they were found, but JavaScript had no memory
   * for the arrays, the next call returns them instead of updating.
   */
  update(): Changes {
    const changes = this.memory.isView ? this.#changes : { begun: none, ended: none };
    this.memory.update(changes);
    return changes;
  }

  /** Frees the memory. The object cannot be used any more. Freeing it twice is not an error. */
  free(): void {
    this.memory.free();
  }

  /** As {@link BroadPhase.free}, for `using`. */
  [Symbol.dispose](): void {
    this.free();
  }
}

const none: Float64Array = new Float64Array(0);

/** @internal The box of a call that has only one. */
export const oneBox: { readonly boxes: readonly [readonly ["box", 1]] } = { boxes: [["box", 1]] } as const;

const optionNames = ["dimensions", "precision", "report", "margin", "prediction", "views"];

/** @internal The options with their defaults. */
export function checkOptions(options: BroadPhaseOptions): Required<BroadPhaseOptions> {
  checkOptionNames(options, optionNames);
  const dimensions = checkDimensions(options.dimensions);
  const { precision = "single", report = "exact", margin = 0, prediction = 0 } = options;
  const views = checkViews(options.views);
  if (precision !== "single" && precision !== "double") {
    throw new RangeError(`\`precision\` must be "single" or "double", not ${describe(precision)}`);
  }
  if (report !== "exact" && report !== "fat") {
    throw new RangeError(`\`report\` must be "exact" or "fat", not ${describe(report)}`);
  }
  for (const [name, value] of [["margin", margin], ["prediction", prediction]] as const) {
    if (value !== 0 && report === "exact") throw new RangeError(`\`${name}\` is ${describe(value)}, which has no effect without the option \`report: "fat"\``);
    if (!(Number.isFinite(value) && value >= 0)) throw new RangeError(`\`${name}\` is ${describe(value)}; it must be finite, and 0 or more`);
  }
  return { dimensions, precision, report, margin, prediction, views };
}
