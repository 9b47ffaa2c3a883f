// What is a pair: against brute force, and by hand at the edges.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { findPairs, init, PairFinder } from "sweep-and-prune";
import { boxesAmong, boxesSpread, oracle, random, sorted } from "./support/boxes.js";

before(() => init());

const inf = Infinity;
const every = /** @type {const} */ ([1, 2, 3]);

for (const dimensions of every) {
  for (const Rows of [Float32Array, Float64Array]) {
    test(`equals brute force in ${dimensions}D, ${Rows.name}`, () => {
      const next = random(dimensions);
      const finder = new PairFinder({ dimensions });
      for (let round = 0; round < 300; round++) {
        const rows = Rows.from(boxesAmong(next, Math.floor(next() * 40), dimensions));
        const expected = oracle(rows, dimensions);
        assert.deepEqual(sorted(findPairs(rows, { dimensions })), expected);
        assert.deepEqual(sorted(finder.find(rows)), expected);
      }
      for (const count of [100, 1000, 3000]) {
        const rows = Rows.from(boxesSpread(next, count, dimensions));
        const expected = oracle(rows, dimensions);
        assert.ok(expected.length > count / 4, "a scene with hardly a pair proves nothing");
        assert.deepEqual(sorted(findPairs(rows, { dimensions })), expected);
      }
      finder.free();
    });
  }
}

/**
 * @param {number[]} rows
 * @param {1 | 2 | 3} dimensions
 * @param {[number, number][]} expected
 */
function expectPairs(rows, dimensions, expected) {
  for (const boxes of [rows, Float32Array.from(rows), Float64Array.from(rows)]) {
    assert.deepEqual(sorted(findPairs(boxes, { dimensions })), expected);
  }
}

test("touching boxes overlap, by an edge and by a corner", () => {
  expectPairs([0, 1, 1, 2], 1, [[0, 1]]);
  expectPairs([0, 0, 1, 1, 1, 1, 2, 2], 2, [[0, 1]]);
  expectPairs([0, 0, 0, 1, 1, 1, 1, 1, 1, 2, 2, 2], 3, [[0, 1]]);
  expectPairs([0, 0, 1, 1, 1, 1.0001, 2, 2], 2, []);
});

test("single precision is compared as single, double as double", () => {
  const above = 1 + Number.EPSILON; // rounds to 1 in single precision
  assert.equal(findPairs(new Float64Array([0, 1, above, 2]), { dimensions: 1 }).length, 0);
  assert.equal(findPairs([0, 1, above, 2], { dimensions: 1 }).length, 0);
  assert.equal(findPairs(new Float32Array([0, 1, above, 2]), { dimensions: 1 }).length, 2);
});

test("-0 is 0", () => {
  expectPairs([-1, -0, 0, 1], 1, [[0, 1]]);
  expectPairs([-1, 0, -0, 1], 1, [[0, 1]]);
  expectPairs([0, -0, -0, 0], 1, [[0, 1]]);
});

test("points, flat and infinite boxes are boxes", () => {
  expectPairs([3, 4, 3, 4, 3, 4, 3, 4, 0, 4, 9, 4], 2, [
    [0, 1],
    [0, 2],
    [1, 2],
  ]);
  expectPairs([-inf, -inf, inf, 0, 2, 0, 3, 1, 2, 0.5, 3, 1], 2, [
    [0, 1],
    [1, 2],
  ]);
  expectPairs([inf, inf, -inf, -inf, -inf, inf, 0, 1], 1, [
    [0, 2],
    [1, 2],
    [2, 3],
  ]);
});

test("no box, one box, and all boxes equal", () => {
  for (const dimensions of every) {
    expectPairs([], dimensions, []);
    expectPairs(new Array(2 * dimensions).fill(7), dimensions, []);
    const equal = new Array(2 * dimensions * 50).fill(7);
    const pairs = findPairs(equal, { dimensions });
    assert.equal(pairs.length, 2 * ((50 * 49) / 2));
    assert.deepEqual(sorted(pairs), oracle(equal, dimensions));
  }
});

test("the smaller index stands first", () => {
  const pairs = findPairs(boxesSpread(random(5), 2000, 2), { dimensions: 2 });
  for (let i = 0; i < pairs.length; i += 2) {
    assert.ok(/** @type {number} */ (pairs[i]) < /** @type {number} */ (pairs[i + 1]));
  }
});

test("a view that begins in the middle of its buffer, and a shared buffer", () => {
  const part = new Float32Array([9, 0, 1, 1, 2, 9]).subarray(1, 5);
  assert.deepEqual([...findPairs(part, { dimensions: 1 })], [0, 1]);
  const shared = new Float64Array(new SharedArrayBuffer(32));
  shared.set([0, 1, 1, 2]);
  assert.deepEqual([...findPairs(shared, { dimensions: 1 })], [0, 1]);
});

test("the boxes are not touched", () => {
  const boxes = boxesSpread(random(6), 100, 3);
  const before = boxes.slice();
  findPairs(boxes, { dimensions: 3 });
  assert.deepEqual(boxes, before);
});
