// A finder keeps its memory, gives it back, and its views say what they hold.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { setTimeout } from "node:timers/promises";
import { setFlagsFromString } from "node:v8";
import vm from "node:vm";
import { anyPair, findPairs, init, PairFinder } from "sweep-and-prune";
import { boxesAmong, boxesSpread, oracle, random, sorted } from "./support/boxes.js";

/** How often the core handed pairs to JavaScript, and how many pairs. */
const handed = { calls: 0, pairs: 0 };

before(async () => {
  // Looks over the package's shoulder, to count.
  const { instantiate } = WebAssembly;
  WebAssembly.instantiate = /** @type {any} */ (
    (/** @type {WebAssembly.Module} */ module, /** @type {Record<string, any>} */ imports) => {
      const each = (/** @type {number} */ at, /** @type {number} */ count) => {
        handed.calls++;
        handed.pairs += count;
        return imports["sweep_and_prune"].each(at, count);
      };
      // Node.js has modules of its own.
      return instantiate(module, imports["sweep_and_prune"] ? { sweep_and_prune: { ...imports["sweep_and_prune"], each } } : imports);
    }
  );
  await init();
  WebAssembly.instantiate = instantiate;
});

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

test("many pairs are handed over in chunks: findPairs keeps nothing, a finder little", () => {
  const before = memory();
  const finder = new PairFinder({ dimensions: 1 });
  const all = new Float32Array(2 * 3000); // all overlap: 4,498,500 pairs, 36 MB
  const expected = 3000 * 2999;
  assert.equal(findPairs(all, { dimensions: 1 }).length, expected);
  assert.equal(finder.findBetween(all, all).length, 2 * 3000 * 3000);
  assert.ok(memory() - before < 25 * 2 ** 20, `${memory() - before} bytes more`);
  // Across chunks, in the order of streaming.
  const pairs = finder.find(all);
  let at = 0;
  finder.forEach(all, (a, b) => {
    if (pairs[at] !== a || pairs[at + 1] !== b) assert.fail(`pair ${at / 2}`);
    at += 2;
  });
  assert.equal(at, expected);
  finder.free();
});

test("pairs are written to the caller's array, shared or not, as many as fit", () => {
  const finder = new PairFinder({ dimensions: 1 });
  const all = new Float32Array(2 * 1700); // more pairs than a chunk holds
  const expected = finder.find(all);
  const total = expected.length / 2;
  assert.ok(total > 2 ** 20);
  for (const length of [expected.length, expected.length + 3, 2 ** 21, 2 ** 21 + 1, 7, 0]) {
    for (const into of [new Uint32Array(length), new Int32Array(new SharedArrayBuffer(4 * length))]) {
      assert.equal(finder.findInto(all, into), total);
      assert.deepEqual(Uint32Array.from(into.subarray(0, expected.length)), expected.subarray(0, Math.min(length, expected.length)));
      assert.ok(into.subarray(expected.length).every((word) => word === 0));
    }
  }
  const into = new Uint32Array(4).subarray(1);
  assert.equal(finder.findBetweenInto([0, 1], [5, 6, 1, 2], into), 1);
  assert.deepEqual([...into], [0, 1, 0]);
  for (const odd of [undefined, [], new Float32Array(2), new Uint16Array(2), {}]) {
    assert.throws(() => finder.findInto(all, /** @type {any} */ (odd)), /^TypeError: `into` must be a Uint32Array or an Int32Array, not/);
  }
  finder.free();
});

test("any stops at the first pair", () => {
  const finder = new PairFinder({ dimensions: 2 });
  const next = random(7);
  for (let round = 0; round < 200; round++) {
    const dimensions = /** @type {const} */ ([1, 2, 3])[round % 3] ?? 1;
    const [a, b] = [1, 2].map(() => boxesAmong(next, Math.floor(next() * 5), dimensions));
    assert.equal(anyPair(a ?? [], { dimensions }), oracle(a ?? [], dimensions).length > 0);
    if (dimensions !== 2) continue;
    assert.equal(finder.any(a ?? []), oracle(a ?? [], 2).length > 0);
    assert.equal(finder.anyBetween(a ?? [], b ?? []), finder.findBetween(a ?? [], b ?? []).length > 0);
  }
  assert.equal(anyPair([{ minX: 0, maxX: 1 }, { minX: 1, maxX: 2 }]), true);
  // All overlap: 20 billion pairs, of which the core finds the first few.
  Object.assign(handed, { calls: 0, pairs: 0 });
  assert.equal(finder.any(new Float32Array(4 * 200_000)), true);
  assert.equal(handed.calls, 1);
  assert.ok(handed.pairs < 100_000, `${handed.pairs} pairs were found`);
  finder.free();
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
