// Each misuse has its error, and changes nothing.
import assert from "node:assert/strict";
import { test } from "node:test";
import vm from "node:vm";
import { findPairs, findPairsBetween, init, InvalidBoxError, NotInitializedError, PairFinder, SweepAndPruneError } from "sweep-and-prune";

// Before `init`, and so before everything else in this file.
test("a call before init throws and names the entry", async () => {
  assert.throws(() => findPairs([0, 1], { dimensions: 1 }), (error) => error instanceof NotInitializedError && error.message.includes('"sweep-and-prune" is not initialized'));
  assert.throws(() => new PairFinder({ dimensions: 1 }), NotInitializedError);
  const starting = init();
  assert.throws(() => findPairs([0, 1], { dimensions: 1 }), NotInitializedError);
  await starting;
  assert.equal(findPairs([0, 1], { dimensions: 1 }).length, 0);
});

/**
 * @param {number[]} rows
 * @param {1 | 2 | 3} dimensions
 * @param {{ index: number, axis: number }} expected
 */
function expectInvalid(rows, dimensions, expected) {
  for (const boxes of [rows, Float32Array.from(rows), Float64Array.from(rows)]) {
    assert.throws(
      () => findPairs(boxes, { dimensions }),
      (error) => {
        assert.ok(error instanceof InvalidBoxError && error instanceof SweepAndPruneError);
        assert.equal(error.name, "InvalidBoxError");
        assert.match(error.message, new RegExp(`^box ${expected.index} of \`boxes\` .* axis ${expected.axis} \\(${"xyz"[expected.axis]}\\)`));
        assert.deepEqual({ index: error.index, axis: error.axis }, expected);
        return true;
      },
    );
  }
}

test("an inverted box and a NaN name the first box and axis at fault", () => {
  expectInvalid([1, 0], 1, { index: 0, axis: 0 });
  expectInvalid([0, 1, 0, 1, NaN, 1], 1, { index: 2, axis: 0 });
  expectInvalid([0, 1, 0, NaN], 1, { index: 1, axis: 0 });
  expectInvalid([0, 0, 1, 1, 0, 2, 1, 1, NaN, 0, 1, 1], 2, { index: 1, axis: 1 });
  expectInvalid([0, 0, 0, 1, 1, 1, 0, 0, 2, 1, 1, 1], 3, { index: 1, axis: 2 });
  expectInvalid([Infinity, -Infinity], 1, { index: 0, axis: 0 });
  expectInvalid([0, 0, 0, NaN], 2, { index: 0, axis: 1 });
});

test("of two sets, the error names the one that is at fault, and the box within it", () => {
  const good = [0, 1, 2, 3];
  const bad = [0, 1, 3, 2];
  /** @type {[() => unknown, string][]} */
  const cases = [
    [() => findPairsBetween(bad, good, { dimensions: 1 }), "a"],
    [() => findPairsBetween(good, bad, { dimensions: 1 }), "b"],
    [() => new PairFinder({ dimensions: 1 }).forEachBetween(good, bad, () => {}), "b"],
  ];
  for (const [call, argument] of cases) {
    assert.throws(call, (error) => error instanceof InvalidBoxError && error.index === 1 && error.argument === argument && error.message.includes(`box 1 of \`${argument}\``));
  }
});

test("objects that are no boxes are named by what they hold", () => {
  const boxes = /** @type {any} */ ([{ x: 0, y: 0, radius: 1 }]);
  const message = /^TypeError: boxes\[0\] must be { minX, .. }.*, not an object with x, y, radius/;
  assert.throws(() => findPairs(boxes), message);
  assert.throws(() => findPairs(boxes, { dimensions: 2 }), message);
});

test("a number of coordinates that is not a whole number of boxes is refused", () => {
  for (const boxes of [[1, 2, 3], new Float32Array(5), new Float64Array(6)]) {
    assert.throws(() => findPairs(boxes, { dimensions: 2 }), RangeError);
  }
  assert.throws(() => findPairs(new Float32Array(6), { dimensions: 2 }), /6 numbers.*multiple of 4.*2D/);
});

test("dimensions other than 1, 2 and 3 are refused", () => {
  for (const dimensions of [0, 4, -1, 2.5, NaN, "2", null, undefined, 2n, Symbol("2"), {}]) {
    assert.throws(() => findPairs([0, 1], { dimensions: /** @type {any} */ (dimensions) }), RangeError);
    assert.throws(() => new PairFinder({ dimensions: /** @type {any} */ (dimensions) }), RangeError);
  }
  assert.throws(() => findPairs([0, 1], /** @type {any} */ (undefined)), /^RangeError: `options` is missing: .*{ dimensions: 1 }/);
});

test("boxes of another type are refused", () => {
  const others = [
    undefined,
    null,
    12,
    "0 1",
    {},
    { length: 2, 0: 0, 1: 1 },
    new BigInt64Array(4),
    new BigUint64Array(4),
    new DataView(new ArrayBuffer(16)),
    new ArrayBuffer(16),
    new Set([0, 1]),
    Symbol("boxes"),
    Object.create(null),
  ];
  for (const boxes of others) {
    assert.throws(() => findPairs(/** @type {any} */ (boxes), { dimensions: 1 }), TypeError);
  }
  for (const numbers of [["0", 1], [0, null], [0, undefined], new Array(2), [0n, 1n]]) {
    assert.throws(() => findPairs(/** @type {any} */ (numbers), { dimensions: 1 }), /^TypeError: boxes\[\d\] must be a number/);
  }
});

test("a detached buffer is refused, and a view that its buffer no longer holds", () => {
  const boxes = new Float32Array([0, 1, 1, 2]);
  structuredClone(boxes.buffer, { transfer: [boxes.buffer] });
  assert.throws(() => findPairs(boxes, { dimensions: 1 }), /^TypeError: the buffer of boxes is detached/);

  const buffer = new /** @type {any} */ (ArrayBuffer)(32, { maxByteLength: 64 });
  const view = new Float64Array(buffer, 0, 4);
  buffer.resize(8);
  assert.throws(() => findPairs(view, { dimensions: 1 }), TypeError);
});

test("typed arrays of another realm are accepted", () => {
  const boxes = vm.runInNewContext("new Float32Array([0, 1, 1, 2])");
  assert.equal(boxes instanceof Float32Array, false);
  assert.deepEqual([...findPairs(boxes, { dimensions: 1 })], [0, 1]);
  assert.deepEqual([...findPairs(vm.runInNewContext("[0, 1, 1, 2]"), { dimensions: 1 })], [0, 1]);
});

test("after an error a finder works as before", () => {
  const finder = new PairFinder({ dimensions: 1 });
  const good = new Float64Array([0, 1, 1, 2, 2, 3]);
  const expected = [...finder.find(good)];
  for (const bad of [new Float64Array([0, NaN]), new Float64Array([2, 1]), new Float64Array(3), [0, 1, 2]]) {
    assert.throws(() => finder.find(bad));
    assert.deepEqual([...finder.find(good)], expected);
  }
  finder.free();
  assert.throws(() => finder.find(good), /^TypeError: this PairFinder was freed/);
});
