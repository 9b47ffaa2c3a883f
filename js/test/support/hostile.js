// Calls whose arguments run code while they are read: they throw, free the object, change it, call it, or recurse until
// the stack overflows. The calls are compared with a model in plain JavaScript. One number in the arguments decides all.
import assert from "node:assert/strict";
import { boxesAmong, oracle, random, sorted } from "./boxes.js";

/** @typedef {{ category: number, mask: number, group: number, isStatic: boolean }} Filter */
/** @typedef {{ row: number[], filter: Filter }} Body */

const among = [-Infinity, -2, -1, -0, 0, 1, 1.5, 2, 3, Infinity];
const finite = among.filter(Number.isFinite);
const named = /^(TypeError|RangeError|InvalidBoxError|OutOfMemoryError|StaleProxyError)$/;
/** Messages of the engine, where our code did not check, and of a core that fell over. */
const foreign = /Cannot read|is not a function|unreachable|internal error|out of bounds|signature|ended halfway|detached ArrayBuffer/;

/** @param {unknown} error */
export function isOverflow(error) {
  return error instanceof RangeError && /call stack/.test(error.message);
}

/** What both fuzzers have: random choices, and arguments that act while they are read. */
class Hostile {
  calls = 0;
  /** What an action threw: the call must throw it, too. */
  marker = new Error("an action threw");
  hasThrown = false;
  hasOverflowed = false;
  /** Whether calls were made where the stack overflowed: one may have ended halfway, and its object says so. */
  hasDived = false;
  isWrong = false;
  /** The action takes place at this read, counted down. */
  #reads = 0;

  constructor(/** @type {number} */ seed) {
    this.next = random(seed);
  }

  below(/** @type {number} */ bound) {
    return Math.floor(this.next() * bound);
  }

  /**
   * @template T
   * @param {readonly T[]} list
   * @returns {T}
   */
  pick(list) {
    return /** @type {T} */ (list[this.below(list.length)]);
  }

  /** Before each call: whether and when its arguments act. */
  arm() {
    this.calls++;
    this.hasThrown = this.hasOverflowed = this.hasDived = this.isWrong = false;
    this.#reads = this.below(2) === 0 ? 1 + this.below(8) : 0;
  }

  disarm() {
    this.#reads = 0;
  }

  /** Each read of an argument. */
  read() {
    if (this.#reads > 0 && --this.#reads === 0) this.act();
  }

  /** @returns {void} */
  act() {
    throw new Error("not implemented");
  }

  throwMarker() {
    this.hasThrown = true;
    throw this.marker;
  }

  /** Makes calls ever deeper on the stack until it overflows. */
  overflow(/** @type {() => void} */ call) {
    this.hasDived = true;
    const dive = () => {
      this.calls++;
      call();
      dive();
    };
    try {
      dive();
    } catch (error) {
      if (!isOverflow(error)) throw error;
    }
    if (this.below(2) === 0) return;
    this.hasOverflowed = true;
    const again = () => {
      again();
    };
    again();
  }

  /** An array of these numbers in any form that the package accepts, which acts when it is read. */
  array(/** @type {readonly number[]} */ values) {
    const read = () => this.read();
    switch (this.below(7)) {
      case 0:
        return [...values];
      case 1:
        return new Proxy([...values], { get: (target, key) => (this.read(), Reflect.get(target, key)), has: (target, key) => (this.read(), Reflect.has(target, key)) });
      case 2: {
        const array = [...values];
        values.forEach((value, at) => Object.defineProperty(array, at, { get: () => (this.read(), value) }));
        return array;
      }
      case 3: {
        // What is not its own cannot be believed.
        const array = Float64Array.from(values);
        for (const key of ["length", "buffer", "byteOffset", "byteLength", "constructor", "subarray", "slice", "set", "indexOf", Symbol.toStringTag, Symbol.iterator]) {
          Object.defineProperty(array, key, { get: () => (this.read(), key === "length" ? 2 ** 20 : undefined) });
        }
        return array;
      }
      case 4: {
        const array = [...values];
        return Object.defineProperty(array, Symbol.iterator, {
          *value() {
            read();
            yield* new Array(100).fill(7);
          },
        });
      }
      case 5: {
        const array = new Float64Array(new SharedArrayBuffer(8 * values.length));
        array.set(values);
        return array;
      }
      default:
        return Float64Array.from(values);
    }
  }

  /** A box, as an array or as an object in any form. */
  box(/** @type {readonly number[]} */ row) {
    const half = row.length / 2;
    const letters = ["X", "Y", "Z"].slice(0, half);
    if (this.below(2) === 0) return this.array(row);
    /** @param {Record<string, unknown>} fields */
    const object = (fields) => {
      const made = {};
      for (const [key, value] of Object.entries(fields)) Object.defineProperty(made, key, { enumerable: true, get: () => (this.read(), value) });
      return made;
    };
    const corner = (/** @type {number} */ from) => object(Object.fromEntries(letters.map((letter, axis) => [letter.toLowerCase(), row[from + axis]])));
    if (this.below(2) === 0) return object({ min: corner(0), max: corner(half) });
    return object(Object.fromEntries(letters.flatMap((letter, axis) => [[`min${letter}`, row[axis]], [`max${letter}`, row[half + axis]]])));
  }

  /** Boxes, as one array or an array of objects. */
  boxes(/** @type {readonly (readonly number[])[]} */ rows) {
    if (this.below(2) === 0) return this.array(rows.flat());
    const boxes = rows.map((row) => this.box(row));
    return this.below(2) === 0 ? boxes : new Proxy(boxes, { get: (target, key) => (this.read(), Reflect.get(target, key)) });
  }

  /** A value that is no box, point or list of them. */
  wrong(/** @type {number} */ width) {
    this.isWrong = true;
    const valueOf = () => (this.read(), 1);
    const odd = [new Number(0), Object(Symbol("s")), { valueOf }, "1", 1n, true, null];
    const row = new Array(width).fill(0);
    return this.pick([
      ...[null, "x", 5n, Symbol("s"), true, { valueOf }, new Proxy(Float64Array.from(row), {}), new DataView(new ArrayBuffer(8 * width))],
      ...[row.with(this.below(width), this.pick(odd)), [...row, 0], new Float64Array(width + 1), new Proxy(row, { get: (target, key) => (key === "length" ? this.pick([-1, 0.5, "4", null, 2 ** 60]) : Reflect.get(target, key)) })],
    ]);
  }

  /** Throws unless an error is what the arguments deserve. */
  judge(/** @type {string} */ call, /** @type {any} */ error, /** @type {boolean} */ isFreed) {
    if (this.hasThrown && error === this.marker) return;
    if (this.hasOverflowed && isOverflow(error)) return;
    if (this.hasDived && error?.name === "InterruptedError") return;
    assert.ok(named.test(error?.name), `${call} throws ${error?.stack}`);
    assert.doesNotMatch(error.message, foreign, call);
    assert.ok(this.isWrong || isFreed, `${call} throws ${error.stack}`);
    if (!this.isWrong) assert.match(error.message, /was freed/, `${call} throws ${error.stack}`);
  }
}

/** A persistent broad phase. */
export class HostileWorld extends Hostile {
  /** @type {Map<number, Body>} */
  bodies = new Map();
  /** The pairs by the events so far. */
  live = new Set();
  isFreed = true;
  /** @type {any} */
  world;
  /** @type {1 | 2 | 3} */
  dimensions = 2;
  deep = 0;

  /**
   * @param {number} seed
   * @param {any} BroadPhase
   */
  constructor(seed, BroadPhase, overflowEvery = 20_000) {
    super(seed);
    this.BroadPhase = BroadPhase;
    this.overflowEvery = overflowEvery;
  }

  restart() {
    this.dimensions = this.pick(/** @type {const} */ ([1, 2, 3]));
    this.world = new this.BroadPhase({ dimensions: this.dimensions, precision: "double", views: this.below(2) === 0 });
    this.bodies.clear();
    this.live.clear();
    this.isFreed = false;
  }

  row() {
    return boxesAmong(this.next, 1, this.dimensions, among);
  }

  point() {
    return Array.from({ length: this.dimensions }, () => this.pick(finite));
  }

  id() {
    const ids = [...this.bodies.keys()];
    return ids.length > 0 && this.below(10) > 0 ? this.pick(ids) : this.pick([0, 1, NaN, -1, 2 ** 53, 0.5, 2 ** 26 + 1]);
  }

  newFilter() {
    return { category: this.pick([1, 2, 3]), mask: this.pick([1, 2, 3, 0xffff_ffff]), group: this.pick([0, 0, 1, -1]), isStatic: this.below(4) === 0 };
  }

  /**
   * What an argument does while it is read.
   *
   * @override
   */
  act() {
    this.calls++;
    if (this.below(this.overflowEvery) === 0) {
      this.deep++;
      return this.overflow(this.pick([() => this.insert(), () => this.update(), () => this.ask(), () => this.change()]));
    }
    switch (this.below(8)) {
      case 0:
        return this.throwMarker();
      case 1:
        this.world.free();
        this.isFreed = true;
        return;
      case 2:
        return this.isFreed ? undefined : this.insert();
      case 3:
        return this.isFreed ? undefined : this.remove();
      case 4:
        return this.isFreed ? undefined : this.change();
      case 5:
        return this.isFreed ? undefined : this.update();
      default:
        return this.isFreed ? undefined : this.ask();
    }
  }

  // Plain calls, whose model changes if they return.

  insert() {
    const row = this.row();
    const id = this.world.insert(...row);
    this.bodies.set(id, { row, filter: { category: 1, mask: 0xffff_ffff, group: 0, isStatic: false } });
  }

  remove() {
    const [id] = this.bodies.keys();
    if (id === undefined) return;
    this.world.remove(id);
    this.bodies.delete(id);
  }

  change() {
    const [[id, body] = []] = this.bodies;
    if (id === undefined || body === undefined) return;
    const row = this.row();
    this.world.set(id, row);
    body.row = row;
  }

  update() {
    const { begun, ended } = this.world.update();
    for (let at = 0; at < ended.length; at += 2) assert.ok(this.live.delete(`${ended[at]}-${ended[at + 1]}`), "a pair ended that had not begun");
    for (let at = 0; at < begun.length; at += 2) {
      const pair = `${begun[at]}-${begun[at + 1]}`;
      assert.ok(!this.live.has(pair), "a pair began that had not ended");
      this.live.add(pair);
    }
  }

  ask() {
    const row = this.row();
    assert.deepEqual([...this.world.overlapping(row)], this.found(row));
  }

  /** The bodies whose boxes overlap a box, as the model sees it. */
  found(/** @type {number[]} */ row, /** @type {Filter | undefined} */ filter = undefined, /** @type {number[]} */ excluded = []) {
    return [...this.bodies].filter(([id, body]) => !excluded.includes(id) && overlap(body.row, row) && (!filter || mayPair(body.filter, filter))).map(([id]) => id).sort(bySlot);
  }

  /** A filter as an argument. */
  filterArgument(/** @type {Filter} */ filter) {
    if (this.below(2) === 0) return new Proxy({ ...filter }, { get: (target, key) => (this.read(), Reflect.get(target, key)) });
    const made = {};
    for (const [key, value] of Object.entries(filter)) Object.defineProperty(made, key, { get: () => (this.read(), value) });
    return made;
  }

  wrongFilter() {
    this.isWrong = true;
    const valueOf = () => (this.read(), 1);
    return this.pick([
      ...[2, 1, 0, "true", 1n, null, {}, new Boolean(true), { valueOf }].map((isStatic) => ({ isStatic })),
      ...[new Number(1), "1", 1.5, NaN, { valueOf }, 2 ** 32, 1n].flatMap((bits) => [{ category: bits }, { mask: bits }, { group: bits }]),
      ...["x", 1, Symbol("s")],
    ]);
  }

  /**
   * Options of a query, and the ids that they leave out: `names` are the flags that it knows, by their values.
   *
   * @param {Record<string, boolean>} names
   */
  options(names) {
    const excluded = Array.from({ length: this.below(3) }, () => this.id());
    const form = this.below(2) === 0 && excluded.length === 1 ? excluded[0] : this.array(excluded);
    const options = {};
    for (const [key, value] of /** @type {[string, unknown][]} */ (Object.entries({ exclude: form, ...names }))) {
      if (this.below(4) > 0 || value === true) Object.defineProperty(options, key, { enumerable: true, get: () => (this.read(), value) });
      else if (key === "exclude") excluded.length = 0;
    }
    if (this.below(10) > 0) return { options, excluded };
    this.isWrong = true;
    const valueOf = () => (this.read(), 1);
    const wrong = [null, 1, "x", [1], { sort: true }, { exclude: "1" }, { exclude: ["1"] }, { exclude: { valueOf } }, { exclude: new Float32Array(1) }, { [this.pick(Object.keys(names).concat("exclud"))]: 1 }];
    return { options: this.pick(wrong), excluded };
  }

  /** One call with hostile arguments. */
  step() {
    if (this.isFreed || this.bodies.size > 12) {
      if (!this.isFreed) this.world.free();
      this.restart();
    }
    this.arm();
    const call = this.pick(/** @type {const} */ (["insert", "insert", "insertMany", "set", "teleport", "shift", "setMany", "setSwept", "setFilter", "toggle", "removeMany", "overlapping", "overlapping", "containing", "many", "cast", "within", "nearest", "ids", "callback", "this", "update"]));
    try {
      this[`$${call}`]();
    } catch (error) {
      if (error instanceof assert.AssertionError) throw error;
      this.judge(call, error, this.isFreed);
    }
    this.disarm();
    if (this.hasDived) this.settle();
    else if (this.hasOverflowed || this.below(16) === 0) this.compare();
  }

  /** After a stack overflow, which may have inserted thousands of bodies: their pairs would fill the memory. */
  settle() {
    if (this.isFreed) return;
    /** @type {number[] | undefined} */
    let ids;
    try {
      ids = [...this.world.ids()];
    } catch (/** @type {any} */ error) {
      assert.equal(error.name, "InterruptedError");
    }
    if (ids) assert.deepEqual(ids, [...this.bodies.keys()].sort(bySlot));
    this.world.free();
    this.isFreed = true;
  }

  /** The world against the model. */
  compare() {
    if (this.isFreed) return;
    this.update();
    const bodies = [...this.bodies].sort(([a], [b]) => bySlot(a, b));
    const expected = [];
    for (const [at, [a, first]] of bodies.entries()) {
      for (const [b, second] of bodies.slice(at + 1)) if (overlap(first.row, second.row) && mayPair(first.filter, second.filter)) expected.push(`${a}-${b}`);
    }
    assert.deepEqual([...this.live].sort(), expected.sort());
    assert.deepEqual([...this.world.ids()], bodies.map(([id]) => id));
    assert.equal(this.world.size, this.bodies.size);
  }

  /** One argument in ten is wrong. */
  #orWrong(/** @type {() => any} */ right, /** @type {() => any} */ wrong) {
    return this.below(10) === 0 ? wrong() : right();
  }

  #box(/** @type {number[]} */ row) {
    return this.#orWrong(() => this.box(row), () => this.wrong(row.length));
  }

  #point(/** @type {number[]} */ point) {
    return this.#orWrong(() => this.array(point), () => this.wrong(point.length));
  }

  #id(/** @type {number} */ id) {
    return this.#orWrong(() => id, () => {
      this.isWrong = true;
      return this.pick([new Number(id), String(id), { valueOf: () => (this.read(), id) }, [id], null, undefined, true]);
    });
  }

  #filter(/** @type {Filter} */ filter) {
    return this.#orWrong(() => this.filterArgument(filter), () => this.wrongFilter());
  }

  /** Makes a call for bodies, some of which may be stale by the time that it is made. Returns whether it was made. */
  #for(/** @type {number[]} */ ids, /** @type {() => void} */ call) {
    try {
      call();
    } catch (/** @type {any} */ error) {
      if (error?.name !== "StaleProxyError" || this.hasThrown) throw error;
      assert.ok(this.isWrong || !(ids.every((id) => this.bodies.has(id)) && new Set(ids).size === ids.length), `${error.stack}`);
      return false;
    }
    assert.ok(!this.isWrong && !this.isFreed && ids.every((id) => this.bodies.has(id)), `a call with wrong arguments returned`);
    return true;
  }

  /** What a call returned, which must not have been made with wrong arguments. */
  #right(/** @type {any} */ result) {
    assert.ok(!this.isWrong && !this.isFreed && !this.hasThrown, "a call with wrong arguments returned");
    return result;
  }

  $insert() {
    const [row, own] = [this.row(), this.below(2) === 0 ? this.newFilter() : undefined];
    const id = this.#right(this.world.insert(this.#box(row), own && this.#filter(own)));
    assert.ok(!this.bodies.has(id));
    this.bodies.set(id, { row, filter: own ?? { category: 1, mask: 0xffff_ffff, group: 0, isStatic: false } });
    if (own) assert.deepEqual({ ...this.world.filter(id), mask: this.world.filter(id).mask >>> 0 }, own);
  }

  $insertMany() {
    const rows = Array.from({ length: this.below(4) }, () => this.row());
    const filter = this.newFilter();
    const boxes = this.#orWrong(() => this.boxes(rows), () => [[0, 0, 0, 0, 0], this.wrong(2 * this.dimensions)][1]);
    if (this.isWrong && this.dimensions === 1) return; // two boxes are a box and a half there
    const ids = [...this.#right(this.world.insertMany(boxes, this.#filter(filter)))];
    if (!this.isWrong) assert.equal(ids.length, rows.length);
    ids.forEach((id, at) => this.bodies.set(id, { row: rows[at] ?? [], filter }));
  }

  $set() {
    const [id, row] = [this.id(), this.row()];
    if (this.#for([id], () => this.world.set(this.#id(id), this.#box(row)))) this.#body(id).row = row;
  }

  $teleport() {
    const [id, row] = [this.id(), this.row()];
    if (this.#for([id], () => this.world.teleport(this.#id(id), this.#box(row)))) this.#body(id).row = row;
  }

  /** Back and forth, so that boxes stay where the others are; only -0 is then 0. */
  $shift() {
    const offset = Array.from({ length: this.dimensions }, () => this.below(5) - 2);
    if (!this.#for([], () => this.world.shift(this.#point(offset)))) return;
    this.world.shift(/** @type {any} */ (offset.map((at) => -at)));
    for (const body of this.bodies.values()) body.row = body.row.map((at) => at + 0);
  }

  $setSwept() {
    const [id, row] = [this.id(), this.row()];
    if (this.#for([id], () => this.world.setSwept(this.#id(id), this.#box(row), this.#box(row)))) this.#body(id).row = row;
  }

  $setMany() {
    const ids = [...new Set(Array.from({ length: this.below(4) }, () => this.id()))];
    const rows = ids.map(() => this.row());
    const isMade = this.#for(ids, () => {
      if (this.below(4) === 0) {
        const buffers = this.world.buffers(ids.length);
        buffers.ids.set(ids);
        buffers.boxes.set(rows.flat());
        return this.world.setMany(buffers.ids, buffers.boxes);
      }
      this.world.setMany(this.array(ids), this.boxes(rows));
    });
    if (isMade) ids.forEach((id, at) => (this.#body(id).row = rows[at] ?? []));
  }

  $setFilter() {
    const [id, filter] = [this.id(), this.newFilter()];
    if (!this.#for([id], () => this.world.setFilter(this.#id(id), this.#filter(filter)))) return;
    this.#body(id).filter = filter;
    assert.deepEqual({ ...this.world.filter(id), mask: this.world.filter(id).mask >>> 0 }, filter);
  }

  /** Disables a body, and excludes a pair; and takes both back, since the model knows neither. */
  $toggle() {
    const [a, b] = [this.id(), this.id()];
    if (!this.#for([a], () => this.world.setEnabled(this.#id(a), false))) return;
    this.world.setEnabled(a, true);
    if (!this.#for([a, b], () => this.world.excludePair(this.#id(a), this.#id(b)))) return;
    if (a !== b) assert.ok(this.world.isExcluded(b, a));
    this.world.includePair(a, b);
  }

  $removeMany() {
    const ids = [...new Set(Array.from({ length: this.below(3) }, () => this.id()))];
    const all = this.below(16) === 0;
    const given = all ? [...this.bodies.keys()] : ids;
    // With the option `views` this is a view of memory.
    if (this.#for(given, () => this.world.removeMany(all ? this.world.ids() : this.array(ids)))) given.forEach((id) => this.bodies.delete(id));
  }

  $overlapping() {
    const [row, filter, { options, excluded }] = [this.row(), this.below(2) === 0 ? this.newFilter() : undefined, this.options({ sorted: true })];
    const found = [...this.#right(this.world.overlapping(this.#box(row), filter && this.#filter(filter), options))];
    assert.deepEqual(found, this.found(row, filter, excluded));
  }

  $containing() {
    const [point, filter, { options, excluded }] = [this.point(), this.newFilter(), this.options({ sorted: true })];
    const found = [...this.#right(this.world.containing(this.#point(point), this.#filter(filter), options))];
    assert.deepEqual(found, this.found([...point, ...point], filter, excluded));
  }

  /** Many queries in one call, against the model or a call for each. */
  $many() {
    const count = this.below(4);
    const filter = this.newFilter();
    const points = Array.from({ length: count }, () => this.point());
    const directions = Array.from({ length: count }, () => this.point());
    const rows = Array.from({ length: count }, () => this.row());
    const name = this.pick(/** @type {const} */ (["overlappingMany", "containingMany", "withinMany", "nearestMany", "rayCastMany"]));
    const isCast = name === "rayCastMany";
    const ignoreTouching = isCast && this.below(2) === 0;
    const { options, excluded } = this.options(isCast ? { ignoreTouching } : name === "nearestMany" ? {} : { sorted: true });
    const [given, filtered] = [name === "overlappingMany" ? this.boxes(rows) : this.#points(points), this.#filter(filter)];
    const many = this.world[name].bind(this.world);
    const found = this.#right(
      name === "withinMany" ? many(given, this.array(points.map(() => 1)), filtered, options)
      : name === "nearestMany" ? many(given, 2, 2, filtered, options)
      : isCast ? many(given, this.#points(directions), 2, filtered, options)
      : many(given, filtered, options),
    );
    const plain = { exclude: excluded };
    if (isCast) {
      const expected = points.map((point, at) => this.world.rayCast(point, directions[at], 2, filter, { ...plain, ignoreTouching })?.id ?? -1);
      return assert.deepEqual([...found.ids], expected);
    }
    const lists = [...found.ends].map((end, at) => [...found.ids.slice(found.ends[at - 1] ?? 0, end)]);
    const expected = {
      overlappingMany: () => rows.map((row) => this.found(row, filter, excluded)),
      containingMany: () => points.map((point) => this.found([...point, ...point], filter, excluded)),
      withinMany: () => points.map((point) => [...this.world.within(point, 1, filter, plain)]),
      nearestMany: () => points.map((point) => this.world.nearest(point, 2, 2, filter, plain).map((/** @type {{ id: number }} */ { id }) => id)),
    };
    assert.deepEqual(lists, expected[name]());
  }

  /** Points, as one array or an array of points. */
  #points(/** @type {number[][]} */ points) {
    return this.below(2) === 0 ? this.array(points.flat()) : points.map((point) => this.array(point));
  }

  $within() {
    const [point, filter] = [this.point(), this.newFilter()];
    const radius = this.#orWrong(() => this.below(3), () => ((this.isWrong = true), this.pick([new Number(1), "1", NaN, -1, { valueOf: /** @returns {number} */ () => (this.read(), 1) }])));
    const { options, excluded } = this.options({ sorted: true });
    const found = [...this.#right(this.world.within(this.#point(point), radius, this.#filter(filter), options))];
    assert.deepEqual(found, [...this.world.within(point, radius, filter, { exclude: excluded })]);
    const expected = [...this.bodies].filter(([id, body]) => !excluded.includes(id) && distance(body.row, point) <= radius && mayPair(body.filter, filter));
    assert.deepEqual(found, expected.map(([id]) => id).sort(bySlot));
  }

  $nearest() {
    const [point, filter] = [this.point(), this.newFilter()];
    const { options, excluded } = this.options({});
    const found = this.#right(this.world.nearest(this.#point(point), 3, 2, this.#filter(filter), options));
    assert.deepEqual(found, this.world.nearest(point, 3, 2, filter, { exclude: excluded }));
    const expected = [...this.bodies].filter(([id, body]) => !excluded.includes(id) && distance(body.row, point) <= 2 && mayPair(body.filter, filter));
    assert.equal(found.length, Math.min(3, expected.length));
  }

  $cast() {
    const [box, direction, filter] = [[...this.point(), ...this.point()], this.point(), this.newFilter()];
    for (let axis = 0; axis < this.dimensions; axis++) box[this.dimensions + axis] = Math.max(box[axis] ?? 0, box[this.dimensions + axis] ?? 0);
    const point = box.slice(0, this.dimensions);
    const name = this.pick(["boxCast", "boxCastAll", "rayCast", "rayCastAll"]);
    const isBox = name.startsWith("box");
    const ignoreTouching = this.below(2) === 0;
    const { options, excluded } = this.options({ ignoreTouching });
    const hit = this.#right(this.world[name](isBox ? this.#box(box) : this.#point(point), this.#point(direction), 2, this.#filter(filter), options));
    assert.deepEqual(hit, this.world[name](isBox ? box : point, direction, 2, filter, { exclude: excluded, ignoreTouching }));
    if (!name.endsWith("All")) return;
    // It finds, too, what overlaps where it starts: what it only touches there, unless it ignores that.
    const found = new Set(hit.map((/** @type {{ id: number }} */ { id }) => id));
    for (const id of this.found(isBox ? box : [...point, ...point], filter, excluded)) {
      const row = this.#body(id).row;
      const isInside = direction.every((_, axis) => (box[axis] ?? 0) < (row[axis + this.dimensions] ?? 0) && (isBox ? (box[axis + this.dimensions] ?? 0) : (point[axis] ?? 0)) > (row[axis] ?? 0));
      if (isInside || !ignoreTouching) assert.ok(found.has(id), name);
    }
    for (const each of hit) assert.equal(each.normal.filter((/** @type {number} */ at) => at !== 0).length, each.startsInside ? 0 : 1);
  }

  /** A function as filter is called after the search, and may do anything. */
  $callback() {
    const row = this.row();
    const expected = this.found(row).filter((id) => id % 2 === 0);
    const found = this.world.overlapping(row, (/** @type {number} */ id) => (this.read(), id % 2 === 0));
    assert.deepEqual([...found], expected);
    if (this.isFreed) return;
    this.world.rayCast(this.point(), this.point(), 2, (/** @type {number} */ id) => (this.read(), id % 2 === 0));
    if (!this.isFreed) this.world.nearest(this.point(), 2, 9, (/** @type {number} */ id) => (this.read(), id % 2 === 0));
  }

  $ids() {
    const id = this.id();
    const odd = this.#id(id);
    assert.equal(this.world.contains(odd), !this.isWrong && this.bodies.has(id));
    this.isWrong = false;
    if (!this.bodies.has(id)) return;
    assert.deepEqual(this.world.box(id), this.#body(id).row);
    /** @type {number[]} */
    let both = [];
    if (this.#for([id], () => (both = [...this.world.boxes(this.array([id, id]))]))) assert.deepEqual(both, [...this.#body(id).row, ...this.#body(id).row]);
  }

  /** A method of another object. */
  $this() {
    this.isWrong = true;
    const { prototype } = this.BroadPhase;
    const name = this.pick(["insert", "set", "overlapping", "overlappingMany", "update", "free", "ids"]);
    const other = this.pick([{}, null, { memory: this.world }, new Proxy(this.world, {}), Object.create(prototype)]);
    try {
      prototype[name].call(other, ...this.row());
    } catch (error) {
      assert.ok(error instanceof TypeError || error?.constructor?.name === "StaleProxyError" || error instanceof RangeError, `${name}: ${error}`);
      return;
    }
    // A proxy of a world is that world.
    if (name === "free") this.isFreed = true;
    else if (name === "insert") this.world.clear(), this.bodies.clear();
    else if (name === "update") this.restart();
  }

  $update() {
    this.compare();
  }

  #body(/** @type {number} */ id) {
    const body = this.bodies.get(id);
    assert.ok(body);
    return body;
  }
}

/** A finder. */
export class HostileFinder extends Hostile {
  /** @type {any} */
  finder;
  isFreed = true;
  /** Whether its own callback runs. */
  isBusy = false;
  /** @type {1 | 2 | 3} */
  dimensions = 2;
  deep = 0;

  /**
   * @param {number} seed
   * @param {any} PairFinder
   */
  constructor(seed, PairFinder, overflowEvery = 20_000) {
    super(seed);
    this.PairFinder = PairFinder;
    this.overflowEvery = overflowEvery;
    this.other = new PairFinder({ dimensions: 2 });
  }

  /** @override */
  act() {
    this.calls++;
    if (this.below(this.overflowEvery) === 0) {
      this.deep++;
      const rows = this.rows();
      return this.overflow(this.pick([() => this.check(rows), () => this.nest(rows), () => this.other.count([0, 0, 1, 1])]));
    }
    switch (this.below(5)) {
      case 0:
        return this.throwMarker();
      case 1:
        if (this.isBusy) {
          assert.throws(() => this.finder.free(), /^TypeError: this PairFinder is in use/);
          assert.throws(() => this.finder.find([]), /^TypeError: this PairFinder is in use/);
          return;
        }
        this.finder.free();
        this.isFreed = true;
        return;
      case 2:
        return this.nest(this.rows());
      default:
        return this.check(this.rows());
    }
  }

  rows() {
    return Array.from({ length: this.below(8) }, () => boxesAmong(this.next, 1, this.dimensions, among));
  }

  /** Finds with a finder of its own, or this one if it is free. */
  check(/** @type {number[][]} */ rows) {
    const mine = this.isBusy || this.isFreed ? new this.PairFinder({ dimensions: this.dimensions }) : this.finder;
    try {
      const found = sorted(mine.find(rows.flat()));
      assert.deepEqual(found, oracle(rows.flat(), this.dimensions));
    } finally {
      if (mine !== this.finder) mine.free();
    }
  }

  /** A search within a search, with a finder of its own. */
  nest(/** @type {number[][]} */ rows) {
    const finder = new this.PairFinder({ dimensions: this.dimensions });
    try {
      let count = 0;
      finder.forEach(rows.flat(), () => {
        if (count++ === 0) this.check(rows);
      });
      assert.equal(count, oracle(rows.flat(), this.dimensions).length);
    } finally {
      finder.free();
    }
  }

  step() {
    if (this.isFreed) {
      this.dimensions = this.pick(/** @type {const} */ ([1, 2, 3]));
      this.finder = new this.PairFinder({ dimensions: this.dimensions, views: this.below(2) === 0 });
      this.isFreed = false;
    }
    this.arm();
    const call = this.pick(/** @type {const} */ (["find", "between", "each", "into", "count", "chunks"]));
    try {
      this[`$${call}`]();
    } catch (error) {
      if (error instanceof assert.AssertionError) throw error;
      this.judge(call, error, this.isFreed);
    }
    this.isBusy = false;
    this.disarm();
    if (!this.hasDived) return;
    for (const finder of this.isFreed ? [this.other] : [this.other, this.finder]) {
      try {
        finder.count([]);
      } catch (/** @type {any} */ error) {
        assert.equal(error.name, "InterruptedError");
      }
      assert.equal(finder.count([]), 0);
    }
    this.check(this.rows());
  }

  #boxes(/** @type {number[][]} */ rows) {
    if (this.below(10) > 0 || this.dimensions === 1) return this.boxes(rows);
    return this.wrong(2 * this.dimensions);
  }

  /** What a call returned, which must not have been made with wrong arguments. */
  #right(/** @type {any} */ result) {
    assert.ok(!this.isWrong && !this.isFreed && !this.hasThrown, "a call with wrong arguments returned");
    return result;
  }

  $find() {
    const rows = this.rows();
    assert.deepEqual(sorted(this.#right(this.finder.find(this.#boxes(rows)))), oracle(rows.flat(), this.dimensions));
  }

  $chunks() {
    const [rows, others] = [this.rows(), this.below(2) === 0 ? this.rows() : undefined];
    const chunks = this.finder.chunks(this.#boxes(rows), others && this.#boxes(others));
    const found = this.#right([...chunks].flatMap((chunk) => sorted(chunk)));
    const expected = others ? sorted(this.finder.findBetween(rows.flat(), others.flat())) : oracle(rows.flat(), this.dimensions);
    assert.deepEqual(found.sort((/** @type {number[]} */ [a = 0, b = 0], /** @type {number[]} */ [c = 0, d = 0]) => a - c || b - d), expected);
  }

  $count() {
    const rows = this.rows();
    assert.equal(this.#right(this.finder.count(this.#boxes(rows))), oracle(rows.flat(), this.dimensions).length);
  }

  $into() {
    const rows = this.rows();
    const into = new Uint32Array(8 * 7);
    for (const key of ["length", "buffer", "byteOffset", "set", Symbol.toStringTag, "constructor"]) Object.defineProperty(into, key, { get: () => (this.read(), undefined) });
    const count = this.#right(this.finder.findInto(this.#boxes(rows), into));
    assert.deepEqual(sorted(new Uint32Array(into).subarray(0, 2 * count)), oracle(rows.flat(), this.dimensions));
  }

  $between() {
    const [a, b] = [this.rows(), this.rows()];
    const found = sorted(this.#right(this.finder.findBetween(this.#boxes(a), this.#boxes(b))));
    const all = oracle([...a, ...b].flat(), this.dimensions).filter(([one, other]) => one < a.length && other >= a.length);
    assert.deepEqual(found, all.map(([one, other]) => [one, other - a.length]));
  }

  $each() {
    const rows = this.rows();
    /** @type {[number, number][]} */
    const pairs = [];
    const limit = this.below(4) === 0 ? this.below(3) : Infinity;
    const isComplete = this.finder.forEach(rows.flat(), (/** @type {number} */ a, /** @type {number} */ b) => {
      this.isBusy = true;
      this.read();
      pairs.push([a, b]);
      return pairs.length <= limit;
    });
    assert.ok(!this.hasThrown && !this.hasOverflowed);
    const expected = oracle(rows.flat(), this.dimensions);
    assert.equal(isComplete, expected.length <= limit);
    if (isComplete) assert.deepEqual(pairs.sort(([a, b], [c, d]) => a - c || b - d), expected);
    else assert.equal(pairs.length, limit + 1);
  }
}

/**
 * @param {readonly number[]} a
 * @param {readonly number[]} b
 */
function overlap(a, b) {
  const half = a.length / 2;
  for (let axis = 0; axis < half; axis++) {
    if (!(Number(a[axis]) <= Number(b[half + axis]) && Number(b[axis]) <= Number(a[half + axis]))) return false;
  }
  return true;
}

/**
 * @param {readonly number[]} row
 * @param {readonly number[]} point
 */
function distance(row, point) {
  const half = point.length;
  return Math.hypot(...point.map((at, axis) => Math.max(Number(row[axis]) - at, at - Number(row[half + axis]), 0)));
}

/**
 * @param {Filter} a
 * @param {Filter} b
 */
function mayPair(a, b) {
  if (a.isStatic && b.isStatic) return false;
  if (a.group === b.group && a.group !== 0) return a.group > 0;
  return (a.category & b.mask) !== 0 && (b.category & a.mask) !== 0;
}

/**
 * @param {number} a
 * @param {number} b
 */
function bySlot(a, b) {
  return (a % 2 ** 26) - (b % 2 ** 26);
}
