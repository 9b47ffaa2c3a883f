// A finder keeps its memory, gives it back, and its views say what they hold.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { setTimeout } from "node:timers/promises";
import { setFlagsFromString } from "node:v8";
import vm from "node:vm";
import { findPairs, init, PairFinder } from "sweep-and-prune";
import { boxesSpread, oracle, random, sorted } from "./support/boxes.js";

before(() => init());

test("a large input, then small ones, then large again", () => {
  const finder = new PairFinder({ dimensions: 2, views: true });
  const large = boxesSpread(random(1), 200_000, 2);
  const small = boxesSpread(random(2), 300, 2);
  const expected = findPairs(large, { dimensions: 2 });
  assert.ok(expected.length > 100_000);
  const memory = finder.find(large).buffer;
  for (const rows of [small, new Float64Array(0), small, large, small]) {
    const pairs = finder.find(rows);
    if (rows === large) assert.deepEqual(pairs, expected);
    else assert.deepEqual(sorted(pairs), oracle(rows, 2));
    assert.ok(pairs.buffer === memory, "no more memory than the largest input took");
  }
  finder.free();
});

test("65,536 boxes, whose square has 33 bits, are found as any others are", () => {
  for (const count of [2 ** 16 - 1, 2 ** 16, 2 ** 17]) {
    // From right to left, each touching the next: a sweep tells the last box's pair first, brute
    // force the first box's.
    const rows = Float64Array.from({ length: 2 * count }, (_, i) => (i & 1) - (i >> 1));
    const pairs = findPairs(rows, { dimensions: 1 });
    assert.equal(pairs.length, 2 * (count - 1));
    assert.deepEqual([...pairs.subarray(0, 2)], [count - 2, count - 1]);
  }
});

test("single and double precision take turns", () => {
  const finder = new PairFinder({ dimensions: 3 });
  const double = boxesSpread(random(3), 500, 3);
  const single = Float32Array.from(double);
  for (const rows of [double, single, double, single]) {
    assert.deepEqual(sorted(finder.find(rows)), oracle(rows, 3));
  }
  finder.free();
});

test("finders do not share their results", () => {
  const [a, b] = [new PairFinder({ dimensions: 1 }), new PairFinder({ dimensions: 1 })];
  for (const finder of [a, b]) finder.find([0, 1, 1, 2]); // takes what memory it needs
  const pairs = a.find([0, 1, 1, 2]);
  b.find([0, 1, 2, 3, 0, 3]);
  assert.deepEqual([...pairs], [0, 1]);
  a.free();
  b.free();
});

test("free twice, or by Symbol.dispose", () => {
  const finder = new PairFinder({ dimensions: 1 });
  finder.find([0, 1]);
  finder.find(new Float32Array([0, 1]));
  finder[Symbol.dispose]();
  finder.free();
  assert.throws(() => finder.find([0, 1]), TypeError);
});

/** How much memory there is now, in bytes. */
function memory() {
  const finder = new PairFinder({ dimensions: 1, views: true });
  try {
    return finder.find([0, 1]).buffer.byteLength;
  } finally {
    finder.free();
  }
}

const rows = boxesSpread(random(4), 20_000, 2); // over a megabyte for a finder that holds them

test("what is freed is used again", () => {
  findPairs(rows, { dimensions: 2 });
  const before = memory();
  for (let i = 0; i < 200; i++) findPairs(rows, { dimensions: 2 });
  assert.equal(memory(), before);
});

test("finders that are never freed are freed once they are garbage", async () => {
  setFlagsFromString("--expose-gc");
  const collect = vm.runInNewContext("gc");
  const before = memory();
  for (let i = 0; i < 50; i++) {
    for (let j = 0; j < 4; j++) new PairFinder({ dimensions: 2 }).find(rows);
    collect();
    await setTimeout(1); // finalizers run between tasks
  }
  const grown = memory() - before;
  assert.ok(grown < 50 * 2 ** 20, `200 finders of more than a megabyte each left ${grown} bytes`);
});
