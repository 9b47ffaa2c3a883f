// Boxes in the forms of other libraries give the same pairs as rows of numbers.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { countPairs, findPairs, findPairsBetween, forEachPair, init, InvalidBoxError, PairFinder } from "sweep-and-prune";
import { BroadPhase, init as initWorlds } from "sweep-and-prune/broad-phase";
import { boxesAmong, random } from "./support/boxes.js";

before(() => Promise.all([init(), initWorlds()]));

/** @typedef {1 | 2 | 3} Dimensions */

/** Each form that is taken, made of a row.
 *
 * @type {Record<string, (row: number[], dimensions: Dimensions) => any>}
 */
const forms = {
  rbush: (row, d) => Object.fromEntries(row.map((at, i) => [(i < d ? "min" : "max") + "XYZ"[i % d], at])),
  three: (row, d) => ({ min: corner(row.slice(0, d)), max: corner(row.slice(d)) }),
  cannon: (row, d) => ({ lowerBound: corner(row.slice(0, d)), upperBound: corner(row.slice(d)) }),
  "box-intersect": (row) => row,
  "a typed array": (row) => Float64Array.from(row),
  sides: (row, d) => ({ left: row[0], right: row[d], ...(d === 2 && { top: row[1], bottom: row[3] }) }),
  // From Infinity to -Infinity are bounds of nothing.
  "sides, flipped": (row, d) => {
    const sides = (/** @type {number | undefined} */ low, /** @type {number | undefined} */ high) => (low === -Infinity && high === Infinity ? [low, high] : [high, low]);
    const [[left, right], [top, bottom]] = [sides(row[0], row[d]), sides(row[1], row[3])];
    return { left, right, ...(d === 2 && { top, bottom }) };
  },
  // Sums of these coordinates are exact, apart from infinite ones.
  ...Object.fromEntries([["width", "height", "depth"], ["w", "h", "d"]].flatMap((names) => [false, true].map((isFlipped) => [names.join(isFlipped ? ", flipped, " : ", "), sized(names, isFlipped)]))),
  DOMRect: (row, d) => ({
    ...corner(row.slice(0, d)),
    ...Object.fromEntries(row.slice(d).map((at, axis) => [["width", "height", "depth"][axis], at === row[axis] ? 0 : at - (row[axis] ?? 0)])),
  }),
};

/**
 * A box by a corner and its size, from the min corner or from the max corner.
 *
 * @param {string[]} names
 * @param {boolean} isFlipped
 * @returns {(row: number[], d: Dimensions) => any}
 */
function sized(names, isFlipped) {
  return (row, d) => {
    const [from, to] = isFlipped ? [row.slice(d), row.slice(0, d)] : [row.slice(0, d), row.slice(d)];
    return { ...corner(from), ...Object.fromEntries(to.map((at, axis) => [names[axis], at === from[axis] ? 0 : at - (from[axis] ?? 0)])) };
  };
}

/** @param {number[]} at */
function corner(at) {
  return Object.fromEntries(at.map((value, axis) => ["xyz"[axis], value]));
}

/** Forms that have no third axis. */
const hasDimensions = (/** @type {string} */ name, /** @type {Dimensions} */ dimensions) => dimensions < 3 || !name.startsWith("sides");

for (const [name, make] of Object.entries(forms)) {
  for (const dimensions of /** @type {const} */ ([1, 2, 3])) {
    if (!hasDimensions(name, dimensions)) continue;
    test(`${name} in ${dimensions}D equals rows, with and without options`, () => {
      const next = random(dimensions);
      for (let round = 0; round < 50; round++) {
        const rows = boxesAmong(next, 1 + Math.floor(next() * 60), dimensions, /DOMRect|, /.test(name) && !name.startsWith("sides") ? [-2, -1.5, -1, -0, 0, 0.5, 1, 1.5, 2, 3] : undefined);
        const width = 2 * dimensions;
        const boxes = Array.from({ length: rows.length / width }, (_, i) => make(rows.slice(i * width, (i + 1) * width), dimensions));
        const expected = findPairs(Float64Array.from(rows), { dimensions });
        // Without options, pairs of the items themselves, in the same order.
        const items = findPairs(boxes);
        assert.equal(items.length, expected.length / 2);
        assert.ok(items.every(([a, b], pair) => a === boxes[expected[2 * pair] ?? NaN] && b === boxes[expected[2 * pair + 1] ?? NaN]));
        /** @type {unknown[]} */
        const streamed = [];
        assert.equal(forEachPair(boxes, (a, b) => void streamed.push([a, b])), true);
        assert.deepEqual(streamed, items);
        assert.deepEqual(findPairs(boxes, { dimensions }), expected);
        assert.equal(countPairs(boxes), expected.length / 2);
        const between = findPairsBetween(rows, rows.slice(0, width), { dimensions });
        assert.deepEqual(findPairsBetween(boxes, [boxes[0]], { dimensions }), between);
        assert.deepEqual(findPairsBetween(boxes, [boxes[0]]).flat(), [...between].map((index) => boxes[index]));
      }
    });
  }
}

test("fewer dimensions than the objects have: the others are not looked at", () => {
  const boxes = [
    { minX: 0, minY: 0, maxX: 1, maxY: 1, name: "a" },
    { minX: 1, minY: 5, maxX: 2, maxY: 6, name: "b" },
  ];
  assert.deepEqual(findPairs(boxes), []);
  assert.deepEqual([...findPairs(boxes, { dimensions: 1 })], [0, 1]);
  // A sprite's z is its place in the drawing order: without a depth it is no coordinate.
  const sprites = [{ x: 0, y: 0, z: 1, width: 2, height: 2 }, { x: 2, y: 2, z: 9, width: 1, height: 1 }];
  assert.deepEqual(findPairs(sprites), [sprites]);
});

test("typed arrays of whole numbers are taken, each number as it is", () => {
  const wide = [2 ** 24, 2 ** 24, 2 ** 24 + 1, 2 ** 24 + 1]; // single precision has no 2^24 + 1
  for (const Type of [Int8Array, Uint8Array, Uint8ClampedArray, Int16Array, Uint16Array, Int32Array, Uint32Array]) {
    assert.deepEqual([...findPairs(new Type([0, 2, 5, 6, 2, 3]), { dimensions: 1 })], [0, 2], Type.name);
  }
  for (const Type of [Int32Array, Uint32Array]) assert.equal(countPairs(new Type(wide), { dimensions: 1 }), 0);
  const world = new BroadPhase({ dimensions: 1 });
  const [id = NaN] = world.insertMany(new Uint8Array([1, 2]));
  world.set(id, new Int16Array([3, 4]));
  assert.deepEqual(world.box(id), [3, 4]);
  world.removeMany(new Uint32Array([id]));
  assert.equal(world.size, 0);
  assert.throws(() => findPairs(/** @type {any} */ (new BigInt64Array(2)), { dimensions: 1 }), /^TypeError: `boxes` must be a typed array of numbers/);
});

test("sides that also have a size, as bounds of engines do", () => {
  class Bounds {
    left = 1; top = 2; right = 4; bottom = 6;
    get width() { return this.right - this.left; }
    get height() { return this.bottom - this.top; }
  }
  const boxes = [new Bounds(), { x: 4, y: 6, width: 1, height: 1, left: 9 }];
  assert.deepEqual(findPairs(boxes), [boxes]);
});

test("no boxes need no options", () => {
  assert.deepEqual(findPairs([]), []);
  assert.deepEqual(findPairsBetween([], [{ minX: 0, maxX: 1 }]), []);
  assert.deepEqual(findPairsBetween([], [[0, 0, 1, 1]]), []);
  assert.throws(() => forEachPair(/** @type {any} */ ([0, 1]), () => {}), /^RangeError: `options` is missing/);
});

test("what is missing or of another kind is named", () => {
  const box = { minX: 0, minY: 0, maxX: 1, maxY: 1 };
  /** @type {[unknown, RegExp][]} */
  const wrong = [
    [[box, { ...box, maxY: undefined }], /maxY of boxes\[1\] must be a number, not undefined/],
    [[box, { ...box, minX: "0" }], /minX of boxes\[1\] must be a number, not a string/],
    [[box, 12], /boxes\[1\] must be \{ minX/],
    [[box, null], /boxes\[1\] must be .* not null/],
    [[box, undefined], /boxes\[1\] must be .* not undefined/],
    [[box, {}], /boxes\[1\] must be .* not an object with no properties/],
    [[{ min: null, max: {} }], /min\.x of boxes\[0\]/],
    [[{ ...box, minX: 0n }], /minX of boxes\[0\]/],
    [[null, box], /boxes\[0\] must be .* not null/],
  ];
  for (const [boxes, message] of wrong) {
    assert.throws(() => findPairs(/** @type {any} */ (boxes), { dimensions: 2 }), { name: "TypeError", message });
  }
  assert.throws(() => findPairs([box], { dimensions: 3 }), /minZ of boxes\[0\] must be a number, not undefined/);
  assert.throws(() => findPairs([[0, 0, 1]]), RangeError);
  assert.throws(() => findPairs([[0, 0, 1, 1], [0, 1]]), /^TypeError: boxes\[1\] is in 1D and others in 2D/);
  assert.throws(() => findPairs([[0, 0, 1, 1], [0, 1]], { dimensions: 2 }), /^RangeError: boxes\[1\] must hold 4 numbers, not 2/);
  assert.throws(() => findPairs(/** @type {any} */ ([{}])), /^TypeError: boxes\[0\] must be .* an object with no properties/);
  assert.throws(
    () => findPairs([box, { ...box, minX: NaN }]),
    (error) => error instanceof InvalidBoxError && error.index === 1 && error.axis === 0,
  );
});

test("a getter may do anything to the finder that reads it", () => {
  const finder = new PairFinder({ dimensions: 1 });
  const nested = { maxX: 1, get minX() { return finder.find([0, 1, 1, 2]).length - 2; } };
  assert.deepEqual([...finder.find([nested, { minX: 1, maxX: 2 }])], [0, 1]);
  const freeing = { maxX: 1, get minX() { finder.free(); return 0; } };
  assert.throws(() => finder.find([freeing]), /^TypeError: this PairFinder was freed/);
});

test("shared memory is read as any other", () => {
  const rows = new Float32Array(new SharedArrayBuffer(16));
  rows.set([0, 1, 1, 2]);
  assert.deepEqual([...findPairs(rows, { dimensions: 1 })], [0, 1]);
});

test("a world takes them too", () => {
  const world = new BroadPhase({ dimensions: 2 });
  const ids = world.insertMany([{ minX: 0, minY: 0, maxX: 1, maxY: 1 }, { minX: 1, minY: 1, maxX: 2, maxY: 2 }]);
  assert.deepEqual([...world.update().begun], [...ids]);
  world.setMany(ids, [{ min: { x: 5, y: 5 }, max: { x: 6, y: 6 } }, { min: { x: 0, y: 0 }, max: { x: 1, y: 1 } }]);
  assert.deepEqual(world.box(ids[0] ?? NaN), [5, 5, 6, 6]);
  world.free();
});

test("a world takes one box and a point in each form", () => {
  for (const dimensions of /** @type {const} */ ([1, 2, 3])) {
    for (const precision of /** @type {const} */ (["single", "double"])) {
      const world = new BroadPhase({ dimensions, precision });
      const next = random(dimensions);
      const among = [-2, -1.5, -1, 0, 0.5, 1, 2, 3];
      for (const [name, make] of Object.entries(forms)) {
        if (!hasDimensions(name, dimensions)) continue;
        const [a, b] = [boxesAmong(next, 1, dimensions, among), boxesAmong(next, 1, dimensions, among)];
        const id = world.insert(make(a, dimensions));
        assert.deepEqual(world.box(id), a);
        world.set(id, make(b, dimensions));
        assert.deepEqual(world.box(id), b);
        world.setSwept(id, make(a, dimensions), make(b, dimensions));
        world.update();
        assert.deepEqual(world.overlapping(make(b, dimensions)), world.overlapping(b));
        const [point, direction] = [a.slice(0, dimensions), b.slice(0, dimensions)];
        const [p, d] = [corner(point), corner(direction)];
        assert.deepEqual(world.containing(/** @type {any} */ (p)), world.containing(point));
        assert.deepEqual(world.within(/** @type {any} */ (p), 1), world.within(point, 1));
        assert.deepEqual(world.nearest(/** @type {any} */ (p), 2), world.nearest(point, 2));
        assert.deepEqual(world.rayCastAll(/** @type {any} */ (p), /** @type {any} */ (d)), world.rayCastAll(point, direction));
        assert.deepEqual(world.boxCastAll(make(a, dimensions), /** @type {any} */ (d)), world.boxCastAll(a, direction));
      }
      world.free();
    }
  }
  const world = /** @type {any} */ (new BroadPhase({ dimensions: 2 }));
  const id = world.insert({ x: 0, y: 0, width: 1, height: 1 });
  const before = world.stateHash();
  /** @type {[() => unknown, RegExp][]} */
  const wrong = [
    [() => world.insert({ x: 0, y: 0, width: 1 }), /^TypeError: height of `box` must be a number, not undefined/],
    [() => world.insert({}), /^TypeError: `box` must be { minX, .. }.* not an object with no properties/],
    [() => world.insert([0, 0, 1]), /^RangeError: `box` has 3 numbers; in 2D it must have 4/],
    [() => world.insert([0, 0, 1, 1], 2), /^TypeError: there are more arguments than `box`/],
    [() => world.set(id, { minX: 0, minY: 0, maxX: "1", maxY: 1 }), /^TypeError: maxX of `box` must be a number, not a string/],
    [() => world.containing({ x: 0 }), /^TypeError: `point.y` must be a number, not undefined/],
    [() => world.rayCast({ x: 0, y: 0 }, { x: 0, y: Infinity }), /^RangeError: `direction\[1\]` is Infinity/],
  ];
  for (const [call, message] of wrong) assert.throws(call, message);
  assert.equal(world.stateHash(), before);
  world.free();
});

test("a world's own views can be handed back to it, though its memory grows meanwhile", () => {
  const world = new BroadPhase({ dimensions: 2, views: true });
  world.insertMany(new Float32Array(4 * 1500)); // all overlap: over two million ids in the pairs
  world.update();
  const pairs = world.pairs();
  const last = pairs.at(-1) ?? NaN;
  const rows = Float32Array.from({ length: 4 * pairs.length }, (_, i) => i >> 2);
  world.setMany(pairs, rows);
  assert.equal(pairs.length, 0, "memory did not grow: this proves nothing");
  const at = rows.length / 4 - 1;
  assert.deepEqual(world.box(last), [at, at, at, at]);
  world.update();
  const ids = world.ids();
  world.removeMany(ids);
  assert.equal(world.size, 0);
  world.free();
});
