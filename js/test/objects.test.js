// Boxes in the forms of other libraries give the same pairs as rows of numbers.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { countPairs, findPairs, findPairsBetween, init, InvalidBoxError, PairFinder } from "sweep-and-prune";
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
};

/** @param {number[]} at */
function corner(at) {
  return Object.fromEntries(at.map((value, axis) => ["xyz"[axis], value]));
}

for (const [name, make] of Object.entries(forms)) {
  for (const dimensions of /** @type {const} */ ([1, 2, 3])) {
    test(`${name} in ${dimensions}D equals rows, with and without options`, () => {
      const next = random(dimensions);
      for (let round = 0; round < 50; round++) {
        const rows = boxesAmong(next, 1 + Math.floor(next() * 60), dimensions);
        const width = 2 * dimensions;
        const boxes = Array.from({ length: rows.length / width }, (_, i) => make(rows.slice(i * width, (i + 1) * width), dimensions));
        const expected = findPairs(Float64Array.from(rows), { dimensions });
        assert.deepEqual(findPairs(boxes), expected);
        assert.deepEqual(findPairs(boxes, { dimensions }), expected);
        assert.equal(countPairs(boxes), expected.length / 2);
        assert.deepEqual(findPairsBetween(boxes, [boxes[0]]), findPairsBetween(rows, rows.slice(0, width), { dimensions }));
      }
    });
  }
}

test("fewer dimensions than the objects have: the others are not looked at", () => {
  const boxes = [
    { minX: 0, minY: 0, maxX: 1, maxY: 1, name: "a" },
    { minX: 1, minY: 5, maxX: 2, maxY: 6, name: "b" },
  ];
  assert.deepEqual([...findPairs(boxes)], []);
  assert.deepEqual([...findPairs(boxes, { dimensions: 1 })], [0, 1]);
});

test("no boxes need no options", () => {
  assert.deepEqual([...findPairs([])], []);
  assert.deepEqual([...findPairsBetween([], [{ minX: 0, maxX: 1 }])], []);
  assert.deepEqual([...findPairsBetween([], [[0, 0, 1, 1]])], []);
});

test("what is missing or of another kind is named", () => {
  const box = { minX: 0, minY: 0, maxX: 1, maxY: 1 };
  /** @type {[unknown, RegExp][]} */
  const wrong = [
    [[box, { ...box, maxY: undefined }], /the max y of boxes\[1\] must be a number, not undefined/],
    [[box, { ...box, minX: "0" }], /the min x of boxes\[1\] must be a number, not a string/],
    [[box, 12], /boxes\[1\] must be \{ minX/],
    [[box, null], /boxes\[1\] must be .* not null/],
    [[box, undefined], /boxes\[1\] must be .* not undefined/],
    [[box, {}], /boxes\[1\] must be .* not an object with no properties/],
    [[{ min: null, max: {} }], /the min x of boxes\[0\]/],
    [[{ ...box, minX: 0n }], /the min x of boxes\[0\]/],
    [[null, box], /boxes\[0\] must be .* not null/],
  ];
  for (const [boxes, message] of wrong) {
    assert.throws(() => findPairs(/** @type {any} */ (boxes), { dimensions: 2 }), { name: "TypeError", message });
  }
  assert.throws(() => findPairs([box], { dimensions: 3 }), /the min z of boxes\[0\] must be a number, not undefined/);
  assert.throws(() => findPairs([[0, 0, 1]]), RangeError);
  assert.throws(() => findPairs([[0, 0, 1, 1], [0, 1]]), /^RangeError: boxes\[1\] must hold 4 numbers, not 2/);
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
