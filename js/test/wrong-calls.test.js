// Calls that people write by mistake: each gives the right result, or one error that says what is wrong. None gives other
// pairs in silence. What a type can refuse, the types refuse.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { anyPair, countPairs, findPairs, findPairsBetween, forEachPair, init, InvalidBoxError, PairFinder } from "sweep-and-prune";
import { BroadPhase, init as initWorlds } from "sweep-and-prune/broad-phase";
import { boxesAmong, oracle, random } from "./support/boxes.js";

before(() => Promise.all([init(), initWorlds()]));

/** Any call, whatever its types say. */
const any = /** @type {any} */ ({ anyPair, countPairs, findPairs, findPairsBetween, forEachPair, init });

const box = { minX: 0, minY: 0, maxX: 1, maxY: 1 };
const cube = { minX: 0, minY: 0, minZ: 0, maxX: 1, maxY: 1, maxZ: 1 };
const flat = new Float32Array([0, 0, 2, 2, 5, 5, 6, 6, 2, 1, 3, 4]);

class Sprite {}

/** @type {[what: string, call: () => unknown, message: RegExp][]} */
const searches = [
  ["a typo in an edge", () => any.findPairs([{ minX: 0, miny: 0, maxX: 1, maxY: 1 }]), /^TypeError: boxes\[0\] has `maxY` but no `minY`/],
  ["the same of a later box", () => any.findPairs([box, { minX: 0, minY: 0, maxX: 1, maxy: 1 }]), /^TypeError: maxY of boxes\[1\] must be a number, not undefined/],
  ["a typo in a size", () => any.findPairs([{ x: 0, y: 0, width: 1, heigth: 1 }]), /^TypeError: boxes\[0\] has `y` but no `height`/],
  ["a size without a position", () => any.findPairs([{ x: 0, width: 1, height: 1 }]), /^TypeError: boxes\[0\] has `height` but no `y`/],
  ["a depth without a z", () => any.findPairs([{ x: 0, y: 0, width: 1, height: 1, depth: 1 }]), /^TypeError: boxes\[0\] has `depth` but no `z`/],
  ["half of a short size", () => any.findPairs([{ x: 0, y: 0, w: 1 }]), /^TypeError: boxes\[0\] has `y` but no `h`/],
  ["half of the sides", () => any.findPairs([{ left: 0, right: 1, top: 0 }]), /^TypeError: boxes\[0\] has `top` but no `bottom`/],
  ["half of a corner", () => any.findPairs([{ min: { x: 0, y: 0 }, max: { x: 1 } }]), /^TypeError: boxes\[0\] has `min.y` but no `max.y`/],
  ["no x", () => any.findPairs([{ minX: undefined, minY: 0, maxY: 1 }]), /^TypeError: boxes\[0\] has `minY` but no `minX`/],
  ["no y", () => any.findPairs([{ minX: 0, minZ: 0, maxX: 1, maxZ: 1 }]), /^TypeError: boxes\[0\] has `minZ` but no `minY`/],
  ["an edge that is undefined", () => any.findPairs([{ minX: undefined }]), /^TypeError: minX of boxes\[0\] must be a number, not undefined/],
  ["a sprite of Phaser", () => any.findPairs([{ x: 0, y: 0, width: 2, height: 2, originX: 0.5, originY: 0.5 }]), /^TypeError: boxes\[0\] does not begin at its position: pass its `getBounds\(\)`/],
  ["a sprite of Pixi", () => any.findPairs([{ x: 0, y: 0, width: 2, height: 2, anchor: { x: 0, y: 1 } }]), /^TypeError: boxes\[0\] does not begin at its position/],
  ["a container of Pixi", () => any.findPairs([{ x: 0, y: 0, width: 2, height: 2, rotation: 0, getBounds() {} }]), /^TypeError: boxes\[0\] does not begin at its position/],
  ["a later sprite", () => any.findPairs([box, Object.assign(new Sprite(), { x: 0, y: 0, width: 2, height: 2, originX: 0.5, originY: 0.5 })]), /^TypeError: boxes\[1\] does not begin at its position/],
  ["a sprite as a body", () => any.world().insert({ x: 0, y: 0, width: 2, height: 2, originX: 0, originY: 0.5 }), /^TypeError: `box` does not begin at its position/],
  ["sprites as bodies", () => any.world().insertMany([{ x: 0, y: 0, width: 2, height: 2, originX: 1, originY: 0 }]), /^TypeError: boxes\[0\] does not begin at its position/],
  ["2D and 3D", () => any.findPairs([box, cube]), /^TypeError: boxes\[1\] is in 3D and others in 2D/],
  ["3D and 2D", () => any.findPairs([cube, box]), /^TypeError: minZ of boxes\[1\] must be a number, not undefined/],
  ["2D and 3D in two sets", () => any.findPairsBetween([box], [cube]), /^TypeError: b\[0\] is in 3D and others in 2D/],
  ["rows of different lengths", () => any.findPairs([[0, 0, 1, 1], [0, 0, 0, 1, 1, 1]]), /^TypeError: boxes\[1\] is in 3D and others in 2D/],
  ["a row of five", () => any.findPairs([[0, 0, 1, 1, 2]]), /^RangeError: boxes\[0\] has 5 numbers/],
  ["objects and a typed array", () => any.findPairsBetween([box], flat), /^RangeError: `options` is missing: `b` is a flat array/],
  ["objects and flat numbers", () => any.findPairsBetween([box], [0, 0, 1, 1]), /^RangeError: `options` is missing: `b` is a flat array/],
  ["a typed array and objects", () => any.findPairsBetween(flat, [box]), /^RangeError: `options` is missing: `a` is a flat array/],
  ["an empty set and a typed array", () => any.findPairsBetween([], flat), /^RangeError: `options` is missing: `b` is a flat array/],
  ["flat numbers with a callback", () => any.forEachPair([0, 0, 1, 1], () => {}), /^RangeError: `options` is missing/],
  ["a number for the options", () => any.findPairs(flat, 2), /^TypeError: `options` must be an object with `dimensions`, `missing`, not 2/],
  ["a number for the options of a finder", () => new PairFinder(/** @type {any} */ (2)), /^TypeError: `options` must be an object with `dimensions`.* not 2/],
  ["a null for the options", () => any.findPairs(flat, null), /^TypeError: `options` must be an object/],
  ["an option that does not exist", () => any.findPairs(flat, { dimensions: 2, sorted: true }), /^TypeError: `options` has no `sorted`: there is `dimensions`/],
  ["views in a single search", () => any.findPairs(flat, { dimensions: 2, views: true }), /^TypeError: `options` has no `views`/],
  ["a second set in the place of options", () => any.findPairs(flat, flat), /^TypeError: `options` is a set of boxes: .*findPairsBetween/],
  ["the same, objects", () => any.findPairs([box], [box]), /^TypeError: `options` is a set of boxes/],
  ["the same, counted", () => any.countPairs(flat, flat, { dimensions: 2 }), /^TypeError: `options` is a set of boxes/],
  ["a second set for a finder", () => any.finder().find(flat, flat), /^TypeError: `find` takes one set of boxes; .*`findBetween`/],
  ["options for a finder", () => any.finder().count(flat, { dimensions: 2 }), /^TypeError: `count` takes one set of boxes/],
  ["one object", () => any.findPairs(box, { dimensions: 2 }), /^TypeError: `boxes` must be a typed array of numbers or a plain array, not a Object: one box is written \[box\]/],
  ["one object without options", () => any.findPairs(box), /^TypeError: `boxes` must be an array of boxes, not a Object/],
  ["no second set", () => any.findPairsBetween([box]), /^TypeError: `b` is missing/],
  ["no second set, but options", () => any.findPairsBetween(flat, { dimensions: 2 }), /^TypeError: `b` is missing/],
  ["no boxes", () => any.findPairs(), /^TypeError: `boxes` is missing/],
  ["an address for init", () => any.init("sweep-and-prune.wasm"), /^TypeError: `options` must be an object with `simd`, `wasm`, `development`, not a string/],
  ["an unknown option of init", () => any.init({ dev: true }), /^TypeError: `options` has no `dev`/],
  ["a misspelt way to treat what is missing", () => any.findPairs(flat, { dimensions: 2, missing: "ignore" }), /^RangeError: `missing` must be "raise" or "skip", not a string/],
];
any.finder = () => new PairFinder({ dimensions: 2 });
any.world = () => new BroadPhase({ dimensions: 2 });

for (const [what, call, message] of searches) test(`search: ${what}`, () => assert.throws(call, message));

/** @type {[what: string, call: (world: any, id: number) => unknown, message: RegExp][]} */
const calls = [
  ["x, y, width, height as numbers", (world) => world.insert(100, 100, 20, 20), /^InvalidBoxError: box 0 of `box` is inverted on axis 0 \(x\): its min is 100 and its max 20\..*`{ x, y, width, height }`/],
  ["the same of a body", (world, id) => world.set(id, 1, 5, 2, 3), /^InvalidBoxError: box 0 of `box` is inverted on axis 1 \(y\): its min is 5 and its max 3/],
  ["the same in rows", (world) => world.insertMany([0, 0, 1, 1, 9, 9, 2, 2]), /^InvalidBoxError: box 1 of `boxes` is inverted on axis 0 \(x\): its min is 9 and its max 2/],
  ["bounds of nothing", (world) => world.insert({ minX: Infinity, minY: Infinity, maxX: -Infinity, maxY: -Infinity }), /^InvalidBoxError: box 0 of `box` is empty on axis 0 \(x\): its min is Infinity and its max -Infinity, as bounds of nothing are; leave it out/],
  ["a NaN", (world) => world.insert({ x: 0, y: NaN, width: 1, height: 1 }), /^InvalidBoxError: box 0 of `box` has a NaN on axis 1 \(y\)/],
  ["the end of a path", (world, id) => world.setSwept(id, [0, 0, 1, 1], [3, 0, 2, 1]), /^InvalidBoxError: box 0 of `to` is inverted on axis 0 \(x\): its min is 3 and its max 2/],
  ["options in the place of a filter", (world) => world.overlapping(box, { sorted: false }), /^TypeError: `filter` has no `sorted`: there is `category`, `mask`, `group`, `isStatic`/],
  ["a group that would become negative", (world) => world.insert(box, { group: 2 ** 31 }), /^RangeError: `group` of the filter is 2147483648; it must be a whole number below 2147483648/],
  ["an inverted box for which memory grows", (world, id) => world.setMany(new Float64Array(500_000).fill(id), new Float32Array(2_000_000).fill(5, 0, 1)), /^InvalidBoxError: box 0 of `boxes` is inverted on axis 0 \(x\): its min is 5 and its max 0/],
  ["a filter key that does not exist", (world, id) => world.setFilter(id, { layer: 2 }), /^TypeError: `filter` has no `layer`/],
  ["the same of many", (world) => world.insertMany([0, 0, 1, 1], { isstatic: true }), /^TypeError: `filter` has no `isstatic`/],
  ["a filter in the place of options", (world) => world.overlapping(box, undefined, { mask: 2 }), /^TypeError: `options` has no `mask`: there is `sorted`, `exclude`/],
  ["an order that is no boolean", (world) => world.pairs({ sorted: 0 }), /^TypeError: `sorted` must be true or false, not 0/],
  ["false for the options", (world) => world.pairs(false), /^TypeError: `options` must be an object with `sorted`, not false/],
  ["filters that are not as many as boxes", (world) => world.insertMany([0, 0, 1, 1], [{}, {}]), /^RangeError: `filter` has 2 filters and `boxes` 1 boxes/],
  ["one of many filters", (world) => world.insertMany([0, 0, 1, 1, 0, 0, 1, 1], [{}, { layer: 1 }]), /^TypeError: `filter` has no `layer`/],
  ["one box for insertMany", (world) => world.insertMany(box), /^TypeError: `boxes` must be .*: one box is written \[box\]/],
  ["a box and a filter that does not exist", (world) => world.insert(box, { layer: 1 }), /^TypeError: `options` has no `layer`: there is `data`, `category`/],
  ["separate numbers and options", (world) => world.insert(0, 0, 1, 1, { data: 1 }), /^TypeError: there are more arguments than maxY/],
  ["a box and another", (world) => world.insert(box, box), /^TypeError: `options` (has no|must be)/],
  ["data for other boxes", (world) => world.insertMany([box, box], {}, [1]), /^RangeError: `data` has 1 and `boxes` 2 boxes/],
  ["data that is no array", (world) => world.insertMany([box], {}, "x"), /^TypeError: `data` must be an array, not a string/],
  ["data in the place of a filter", (world) => world.insertMany([box], { data: [1] }), /^TypeError: `filter` has no `data`/],
  ["data of a body that is not here", (world) => world.setData(5, "x"), /^StaleProxyError: the id at index 0 \(5\)/],
  ["boxes of a body that is not here", (world, id) => world.boxes([id, 5]), /^StaleProxyError: the id at index 1 \(5\)/],
  ["a snapshot that is none", (world) => world.restore(new Uint8Array(9)), /^SnapshotError/],
  ["a snapshot of other dimensions", (world) => world.restore(new BroadPhase({ dimensions: 3 }).snapshot()), /^SnapshotError: .* pass `dimensions: 3`/],
  ["a snapshot of another precision", (world) => world.restore(new BroadPhase({ dimensions: 2, precision: "double" }).snapshot()), /^RangeError: the snapshot is of double precision/],
  ["two ids for remove", (world, id) => world.remove(id, id), /^TypeError: `remove` takes one id; `removeMany`/],
  ["ids in single precision", (world, id) => world.removeMany(new Float32Array([id])), /^TypeError: `ids` must not be a Float32Array, which rounds ids/],
  ["a filter in the place of a limit", (world) => world.rayCast([0, 0], [1, 0], { mask: 1 }), /^TypeError: `limit` must be a number, not a Object/],
  ["separate numbers for a query", (world) => world.overlapping(0, 0, 1, 1), /^TypeError: `box` must be .* not 0/],
  ["a point in 3D for a world in 2D", (world) => world.containing([0, 0, 0]), /^RangeError: `point` has 3 numbers; in 2D it must have 2/],
];

for (const [what, call, message] of calls) {
  test(`broad phase: ${what}`, () => {
    const world = new BroadPhase({ dimensions: 2 });
    const id = world.insert(box);
    world.insert(box);
    const before = world.stateHash();
    assert.throws(() => call(world, id), message);
    assert.equal(world.stateHash(), before, "something has changed");
    world.free();
  });
}

test("options of a broad phase that do not exist", () => {
  const New = /** @type {any} */ (BroadPhase);
  assert.throws(() => new New({ dimensions: 2, margn: 1 }), /^TypeError: `options` has no `margn`: there is `dimensions`, `precision`, `report`, `margin`/);
  assert.throws(() => new New(2), /^TypeError: `options` must be an object with `dimensions`.* not 2/);
  assert.throws(() => New.fromSnapshot(new Uint8Array(1), { dimensions: 2, precision: "double" }), /^TypeError: `options` has no `precision`/);
  assert.throws(() => New.fromSnapshot(new Uint8Array(1), 2), /^TypeError: `options` must be an object/);
});

test("the error of an invalid box has its values, in every way to pass it and every precision", () => {
  for (const dimensions of /** @type {const} */ ([1, 2, 3])) {
    for (const Rows of [Float32Array, Float64Array, Array]) {
      const rows = Array.from({ length: 6 * dimensions }, (_, at) => (at % (2 * dimensions) < dimensions ? 0 : 1));
      rows.splice(5 * dimensions - 1, 1, /** @type {any} */ (5)); // the min of the last axis of the third box
      const expected = { index: 2, axis: dimensions - 1, min: 5, max: 1 };
      const boxes = /** @type {any} */ (Rows).from(rows);
      const good = boxes.slice(0, 2 * dimensions);
      for (const precision of /** @type {const} */ (["single", "double"])) {
        const world = new BroadPhase({ dimensions, precision });
        const ids = world.insertMany([...good, ...good, ...good]);
        for (const call of [() => world.insertMany(boxes), () => world.setMany(ids, boxes)]) assert.throws(call, { ...expected, argument: "boxes" });
        const last = /** @type {any} */ ([...boxes.slice(4 * dimensions)]);
        for (const call of [() => world.insert(last), () => /** @type {any} */ (world).insert(...last)]) assert.throws(call, { ...expected, index: 0, argument: "box" });
        assert.throws(() => world.setSwept(/** @type {number} */ (ids[0]), last, [...good]), { ...expected, index: 0, argument: "from" });
        assert.throws(() => world.overlapping(last), { ...expected, index: 0, argument: "box" });
        world.free();
      }
      assert.throws(() => findPairs(boxes, { dimensions }), { ...expected, argument: "boxes" });
      assert.throws(() => findPairsBetween(good, boxes, { dimensions }), { ...expected, argument: "b" });
      assert.throws(() => findPairsBetween(boxes, good, { dimensions }), { ...expected, argument: "a" });
    }
  }
  const error = new InvalidBoxError(1, 0);
  assert.deepEqual([error.min, error.max], [NaN, NaN]);
});

test("one filter for each of many boxes: as if each was set", () => {
  for (const views of [false, true]) {
    const filters = [{ category: 2, mask: 4 }, {}, { category: 4, mask: 2 }, { isStatic: true }, { group: -1 }];
    const rows = filters.flatMap(() => [0, 0, 1, 1]);
    const [a, b] = [new BroadPhase({ dimensions: 2, views }), new BroadPhase({ dimensions: 2 })];
    const ids = a.insertMany(rows, filters);
    const others = b.insertMany(rows);
    filters.forEach((filter, at) => b.setFilter(/** @type {number} */ (others[at]), filter));
    assert.deepEqual([...ids], [...others]);
    assert.deepEqual([...a.update().begun], [...b.update().begun]);
    assert.equal(a.stateHash(), b.stateHash());
    assert.deepEqual(a.filter(/** @type {number} */ (ids[0])), { category: 2, mask: 4, group: 0, isStatic: false });
    // So many that the memory grows meanwhile.
    const many = Array.from({ length: 30_000 }, (_, at) => ({ category: at % 2 ? 1 : 2 }));
    const all = a.insertMany(new Float32Array(4 * many.length), many);
    assert.equal(all.length, many.length);
    assert.equal(a.filter(/** @type {number} */ (all.at(-1))).category, 1);
    assert.equal(a.filter(/** @type {number} */ (all.at(-2))).category, 2);
    a.free();
    b.free();
  }
});

test("a rectangle that was drawn to the upper left, or has its sides flipped, is what it covers", () => {
  const world = new BroadPhase({ dimensions: 2 });
  for (const one of [
    { x: 5, y: 6, width: -5, height: -6 },
    { x: 5, y: 0, w: -5, h: 6 },
    { left: 5, right: 0, top: 6, bottom: 0 },
    { left: 0, right: 5, top: 0, bottom: 6 },
  ]) {
    assert.deepEqual(world.box(world.insert(one)), [0, 0, 5, 6]);
    assert.deepEqual(findPairs([one, [0, 0, 0, 0]]).length, 1);
  }
  // Not bounds that nothing has widened.
  const nothing = { left: Infinity, top: Infinity, right: -Infinity, bottom: -Infinity };
  assert.throws(() => world.insert(nothing), /^InvalidBoxError/);
  assert.equal(findPairs([nothing, [0, 0, 1, 1]], { dimensions: 2, missing: "skip" }).length, 0);
  world.free();
});

test("`missing: \"skip\"`: boxes with a NaN and empty ones have no pairs, and the indices of the others stay", () => {
  const next = random(5);
  for (let round = 0; round < 300; round++) {
    const dimensions = /** @type {1 | 2 | 3} */ (1 + Math.floor(next() * 3));
    const width = 2 * dimensions;
    const make = () => {
      const rows = boxesAmong(next, Math.floor(next() * 40), dimensions);
      const dead = Array.from({ length: rows.length / width }, () => next() < 0.3);
      dead.forEach((isDead, at) => {
        if (!isDead) return;
        const axis = Math.floor(next() * dimensions);
        const kind = Math.floor(next() * 4);
        if (kind === 0) rows.fill(NaN, at * width, (at + 1) * width);
        else if (kind === 1) rows[at * width + axis] = NaN;
        else if (kind === 2) rows[at * width + dimensions + axis] = NaN;
        else [rows[at * width + axis], rows[at * width + dimensions + axis]] = [Infinity, -Infinity];
      });
      return { rows, dead };
    };
    const [a, b] = [make(), make()];
    const Rows = [Float32Array, Float64Array][round % 2] ?? Float32Array;
    const [rowsA, rowsB] = [Rows.from(a.rows), Rows.from(b.rows)];
    const options = /** @type {const} */ ({ dimensions, missing: "skip" });
    // The oracle compares with `<=`, which a NaN never fulfills; nor does an empty box, except with infinite edges.
    const expected = oracle(rowsA, dimensions).filter(([i, j]) => !a.dead[i] && !a.dead[j]);
    const pairsOf = (/** @type {ArrayLike<number>} */ flat) => Array.from({ length: flat.length / 2 }, (_, i) => [flat[2 * i], flat[2 * i + 1]]);
    const sorted = (/** @type {ArrayLike<number>} */ flat) => pairsOf(flat).sort((p, q) => (p[0] ?? 0) - (q[0] ?? 0) || (p[1] ?? 0) - (q[1] ?? 0));
    assert.deepEqual(sorted(findPairs(rowsA, options)), expected);
    assert.equal(countPairs(rowsA, options), expected.length);
    assert.equal(anyPair(rowsA, options), expected.length > 0);
    /** @type {number[]} */
    const streamed = [];
    forEachPair(rowsA, options, (i, j) => void streamed.push(i, j));
    assert.deepEqual(sorted(streamed), expected);
    const finder = new PairFinder({ ...options, views: true });
    assert.deepEqual(sorted(finder.find(rowsA)), expected);
    const into = new Uint32Array(2 * expected.length + 2);
    assert.equal(finder.findInto(rowsA, into), expected.length);
    assert.deepEqual(sorted(into.subarray(0, 2 * expected.length)), expected);
    // The pairs between two sets are those of both together.
    const count = a.dead.length;
    const between = oracle(Rows.from([...rowsA, ...rowsB]), dimensions)
      .filter(([i, j]) => i < count && j >= count && !a.dead[i] && !b.dead[j - count])
      .map(([i, j]) => [i, j - count]);
    assert.deepEqual(sorted(finder.findBetween(rowsA, rowsB)), between);
    finder.free();
  }
  // What is inverted but not empty is a mistake still, and named by its own index.
  assert.throws(() => findPairs([NaN, 1, 3, 2], { dimensions: 1, missing: "skip" }), { name: "InvalidBoxError", index: 1, min: 3, max: 2 });
});

test("a set with itself: each pair both ways round, and each box with itself", () => {
  assert.deepEqual([...findPairsBetween(flat, flat, { dimensions: 2 })].length, 2 * (3 + 2));
  const items = [box, { ...box }];
  assert.equal(findPairsBetween(items, items).length, 4);
});

test("the types refuse what they can", () => {
  // Never called: only its types are looked at.
  const typed = () => {
    // @ts-expect-error a typo in an edge
    findPairs([{ minX: 0, miny: 0, maxX: 1, maxY: 1 }]);
    // @ts-expect-error a typo in a size
    findPairs([{ x: 0, y: 0, width: 1, heigth: 1 }]);
    // @ts-expect-error half of a corner
    findPairs([{ min: { x: 0, y: 0 }, max: { x: 1 } }]);
    // @ts-expect-error half of the sides
    findPairs([{ left: 0, right: 1, top: 0 }]);
    // @ts-expect-error a flat array needs options
    findPairsBetween([box], flat);
    // @ts-expect-error a number for the options
    findPairs(flat, 2);
    // @ts-expect-error an option that does not exist
    findPairs(flat, { dimensions: 2, sorted: true });
    // @ts-expect-error a second set in the place of options
    findPairs(flat, flat);
    // @ts-expect-error one box
    findPairs(box);
    // @ts-expect-error no second set
    findPairsBetween([box]);
    const finder = new PairFinder({ dimensions: 2 });
    // @ts-expect-error a second set
    finder.find(flat, flat);
    const world = new BroadPhase({ dimensions: 2 });
    // @ts-expect-error options in the place of a filter
    world.overlapping(box, { sorted: false });
    // @ts-expect-error a filter key that does not exist
    world.setFilter(world.insert(box), { layer: 2 });
    // @ts-expect-error an option that does not exist
    new BroadPhase({ dimensions: 2, margn: 1 });
    // @ts-expect-error a filter key that does not exist
    world.insert(box, { layer: 1 });
    // @ts-expect-error a box in 3D for a world in 2D
    world.insert({ minX: 0, minY: 0, minZ: 0, maxX: 1, maxY: 1, maxZ: 1 });
    // @ts-expect-error separate numbers in 3D for a world in 2D
    world.insert(0, 0, 0, 1, 1, 1);
    // @ts-expect-error a point in 3D for a world in 2D
    world.containing({ x: 0, y: 0, z: 0 });
    // @ts-expect-error a function for many queries
    world.overlappingMany([box], () => true);
    // @ts-expect-error data of another type
    /** @type {BroadPhase<2, string>} */ (/** @type {unknown} */ (undefined)).insert(box, { data: 1 });
    // @ts-expect-error two ids
    world.remove(world.insert(box), world.insert(box));
    // Right calls.
    findPairs([{ x: 0, y: 0, z: 3, width: 1, height: 1 }, { x: 0, y: 0, z: 1, width: 1, height: 1 }]);
    findPairs([{ left: 0, top: 0, right: 1, bottom: 1, name: "a" }]).map(([a]) => a.name);
    findPairs([/** @type {DOMRect} */ (/** @type {unknown} */ (undefined))]);
    world.insertMany([box], [{ category: 2 }]);
  };
  assert.equal(typeof typed, "function");
});
