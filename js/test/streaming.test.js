// Pairs between two sets, counted, and streamed to a callback that may stop, throw or call back in.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import {
  countPairs,
  findPairs,
  findPairsBetween,
  forEachPair,
  init,
  InvalidBoxError,
  PairFinder,
} from "sweep-and-prune";
import { boxesAmong, boxesSpread, oracle, random, sorted } from "./support/boxes.js";

before(() => init());

const every = /** @type {const} */ ([1, 2, 3]);

/**
 * Pairs between two sets, by brute force over both as one.
 *
 * @param {ArrayLike<number>} a
 * @param {ArrayLike<number>} b
 * @param {1 | 2 | 3} dimensions
 */
function oracleBetween(a, b, dimensions) {
  const count = a.length / (2 * dimensions);
  return oracle([...Array.from(a), ...Array.from(b)], dimensions)
    .filter(([i, j]) => i < count && j >= count)
    .map(([i, j]) => /** @type {[number, number]} */ ([i, j - count]));
}

for (const dimensions of every) {
  for (const Rows of [Float32Array, Float64Array]) {
    test(`between two sets equals brute force in ${dimensions}D, ${Rows.name}`, () => {
      const next = random(dimensions + 10);
      const finder = new PairFinder({ dimensions });
      for (let round = 0; round < 200; round++) {
        const a = Rows.from(boxesAmong(next, Math.floor(next() * 30), dimensions));
        const b = Rows.from(boxesAmong(next, Math.floor(next() * 90), dimensions));
        const expected = oracleBetween(a, b, dimensions);
        assert.deepEqual(sorted(findPairsBetween(a, b, { dimensions })), expected);
        assert.deepEqual(sorted(finder.findBetween(a, b)), expected);
        assert.equal(finder.countBetween(a, b), expected.length);
        assert.equal(finder.count(b), oracle(b, dimensions).length);
      }
      const [a, b] = [Rows.from(boxesSpread(next, 700, dimensions)), Rows.from(boxesSpread(next, 900, dimensions))];
      assert.deepEqual(sorted(finder.findBetween(a, b)), oracleBetween(a, b, dimensions));
      finder.free();
    });
  }
}

test("of two precisions the double one counts", () => {
  const above = 1 + Number.EPSILON; // rounds to 1 in single precision
  const finder = new PairFinder({ dimensions: 1 });
  assert.equal(finder.countBetween(new Float32Array([0, 1]), [above, 2]), 0);
  assert.equal(finder.countBetween([above, 2], new Float32Array([0, 1])), 0);
  assert.equal(finder.countBetween(new Float32Array([0, 1]), new Float32Array([above, 2])), 1);
});

test("a bad box of the second set is named by its set and its index there", () => {
  const [good, bad] = [
    [0, 1, 0, 1],
    [0, 1, 2, 1],
  ];
  assert.throws(
    () => findPairsBetween(good, bad, { dimensions: 1 }),
    (error) => error instanceof InvalidBoxError && error.index === 1 && error.axis === 0 && error.argument === "b",
  );
  assert.throws(() => findPairsBetween(good, [1], { dimensions: 1 }), /^RangeError: b holds 1 numbers/);
  assert.throws(() => findPairsBetween(good, /** @type {any} */ (undefined), { dimensions: 1 }), TypeError);
});

test("streaming gives the pairs of findPairs in its order", () => {
  for (const dimensions of every) {
    const boxes = boxesSpread(random(20), 9000, dimensions);
    /** @type {number[]} */
    const streamed = [];
    assert.equal(forEachPair(boxes, { dimensions }, (a, b) => void streamed.push(a, b)), true);
    const found = findPairs(boxes, { dimensions });
    assert.deepEqual(streamed, [...found]);
    assert.ok(streamed.length > 2 * 4096, "it takes more than one buffer");
    assert.equal(countPairs(boxes, { dimensions }), found.length / 2);
  }
});

test("it stops where the callback returns false", () => {
  const all = new Float32Array(2 * 1000); // all overlap
  const finder = new PairFinder({ dimensions: 1 });
  for (const stop of [1, 2, 4095, 4096, 4097, 10_000]) {
    let calls = 0;
    assert.equal(finder.forEach(all, () => ++calls < stop), false);
    assert.equal(calls, stop);
  }
  let last = 0;
  assert.equal(finder.forEachBetween(all, all, () => ++last < 1000 * 1000), false);
  assert.equal(finder.forEachBetween(all, all, () => undefined), true);
  finder.free();
});

test("counting more pairs than fit in memory", () => {
  const n = 100_000;
  assert.equal(countPairs(new Float32Array(2 * n), { dimensions: 1 }), (n * (n - 1)) / 2);
});

test("what the callback throws comes out, and the finder goes on", () => {
  const finder = new PairFinder({ dimensions: 1 });
  for (let round = 0; round < 3; round++) {
    const error = new Error("enough");
    assert.throws(
      () =>
        finder.forEach([0, 1, 1, 2], () => {
          throw error;
        }),
      (thrown) => thrown === error,
    );
    assert.deepEqual([...finder.find([0, 1, 1, 2])], [0, 1]);
  }
  // Few pairs are handed over after the search, but within the same call.
  finder.forEach([0, 1, 1, 2], () => {
    for (const use of [() => finder.find([0, 1]), () => finder.free()]) assert.throws(use, /^TypeError: this PairFinder is in use/);
  });
  assert.throws(() => finder.forEach([0, 1], /** @type {any} */ (undefined)), TypeError);
  finder.free();
});

test("within a callback other finders work, and this one refuses", () => {
  const finder = new PairFinder({ dimensions: 2 });
  const boxes = boxesSpread(random(21), 3000, 2);
  const expected = findPairs(boxes, { dimensions: 2 });
  const inner = Float32Array.from(boxesSpread(random(22), 100, 3));
  const innerExpected = findPairs(inner, { dimensions: 3 });
  /** @type {number[]} */
  const streamed = [];
  finder.forEach(boxes, (a, b) => {
    streamed.push(a, b);
    if (streamed.length % 500 !== 0) return;
    assert.deepEqual(findPairs(inner, { dimensions: 3 }), innerExpected);
    let calls = 0;
    forEachPair(inner, { dimensions: 3 }, () => ++calls < 3);
    assert.equal(calls, 3);
    assert.throws(() => finder.find(boxes), /in use/);
    assert.throws(() => finder.forEach(boxes, () => 0), /in use/);
    assert.throws(() => finder.free(), /in use/);
    assert.throws(() => findPairs([1, 0], { dimensions: 1 }), InvalidBoxError);
  });
  assert.deepEqual(streamed, [...expected]);
  finder.free();
});

test("after a nested call that streams, the outer one goes on, chunk after chunk", () => {
  const finder = new PairFinder({ dimensions: 1 });
  const all = new Float32Array(2 * 300); // all overlap: eleven chunks of pairs
  const expected = findPairs(all, { dimensions: 1 });
  /** @type {number[]} */
  const streamed = [];
  let nested = 0;
  const isComplete = finder.forEach(all, (a, b) => {
    streamed.push(a, b);
    if (streamed.length % 9000 !== 2) return;
    assert.equal(forEachPair(all, { dimensions: 1 }, () => ++nested % 5000 !== 0), false);
    assert.throws(() => forEachPair(all, { dimensions: 1 }, () => { throw new Error("from within"); }), /from within/);
  });
  assert.deepEqual([isComplete, nested], [true, 50_000]);
  assert.deepEqual(streamed, [...expected]);
  finder.free();
});

test("a nested call that lets the memory grow leaves the outer one whole", () => {
  const finder = new PairFinder({ dimensions: 1 });
  const boxes = new Float32Array(2 * 300); // all overlap
  const expected = findPairs(boxes, { dimensions: 1 });
  /** @type {number[]} */
  const streamed = [];
  finder.forEach(boxes, (a, b) => {
    streamed.push(a, b);
    if (streamed.length === 200) findPairs(new Float32Array(2 * 9000), { dimensions: 1 });
  });
  assert.deepEqual(streamed, [...expected]);
  finder.free();
});
