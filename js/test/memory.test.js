// Running out of memory is an error like any other. A file of its own: it needs gigabytes for a
// moment, and gives them back when its process ends.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { findPairs, init, OutOfMemoryError, PairFinder } from "sweep-and-prune";
import { BroadPhase } from "sweep-and-prune/broad-phase";

/** @type {WebAssembly.Global<"i32">} */
let stackPointer;

before(async () => {
  // Looks over the package's shoulder: where Rust's stack is shows nowhere else.
  const { instantiate } = WebAssembly;
  WebAssembly.instantiate = /** @type {any} */ (
    async (/** @type {WebAssembly.Module} */ module, /** @type {WebAssembly.Imports} */ imports) => {
      const instance = await instantiate(module, imports);
      stackPointer = /** @type {any} */ (instance.exports).__stack_pointer;
      return instance;
    }
  );
  await init();
  WebAssembly.instantiate = instantiate;
});

const good = new Float32Array([0, 1, 1, 2]);

test("boxes that do not fit", () => {
  // The system hands these out without touching them: they cost nothing.
  const boxes = new Float64Array(2 ** 29);
  const finder = new PairFinder({ dimensions: 1 });
  for (let i = 0; i < 3; i++) {
    assert.throws(() => findPairs(boxes, { dimensions: 1 }), OutOfMemoryError);
    assert.throws(() => finder.find(boxes), OutOfMemoryError);
    assert.deepEqual([...finder.find(good)], [0, 1]);
  }
  finder.free();
});

test("pairs that do not fit, again and again", () => {
  // All of them overlap: n(n-1)/2 pairs of 8 bytes are over 2 GiB.
  const boxes = new Float32Array(2 * 24_000);
  const finders = Array.from({ length: 4 }, () => new PairFinder({ dimensions: 1, views: true }));
  const stackTop = stackPointer.value;
  for (const finder of finders) {
    assert.throws(() => finder.find(boxes), OutOfMemoryError);
    assert.equal(stackPointer.value, stackTop, "the stack would run out after many errors");
    assert.deepEqual([...finder.find(good)], [0, 1]);
  }
  // Each had over a gigabyte when it failed. It is there again for another.
  const another = new PairFinder({ dimensions: 1, views: true });
  assert.equal(another.find(boxes.subarray(0, 2 * 12_000)).length, 12_000 * 11_999);
  for (const finder of [...finders, another]) finder.free();
  assert.equal(findPairs(boxes.subarray(0, 2 * 1000), { dimensions: 1 }).length, 1000 * 999);
});

test("a call nested in a callback that runs out of memory leaves the outer one whole", () => {
  const stackTop = stackPointer.value;
  const finder = new PairFinder({ dimensions: 2 });
  const boxes = new Float32Array(4 * 300); // all overlap: more pairs than one buffer holds
  const expected = findPairs(boxes, { dimensions: 2 });
  const tooMany = new Float32Array(2 * 24_000);
  const inner = new PairFinder({ dimensions: 1, views: true }); // whose pairs must fit in WebAssembly's memory
  let calls = 0;
  /** @type {number[]} */
  const streamed = [];
  finder.forEach(boxes, (a, b) => {
    streamed.push(a, b);
    if (++calls !== 100) return;
    const stack = stackPointer.value;
    assert.throws(() => inner.find(tooMany), OutOfMemoryError);
    assert.equal(stackPointer.value, stack, "what is called next would overwrite the frames of the outer call");
  });
  assert.deepEqual(streamed, [...expected]);
  assert.throws(() => inner.find(tooMany), OutOfMemoryError);
  assert.equal(stackPointer.value, stackTop, "not that of the callback any more");
  for (const one of [finder, inner]) one.free();
});

test("a crowd whose pairs do not fit leaves the world as it was", () => {
  const world = new BroadPhase({ dimensions: 1 });
  const far = world.insertMany([[90, 91], [90, 92]]);
  world.update();
  const ids = world.insertMany(new Float32Array(2 * 24_000));
  const hash = world.stateHash();
  for (let i = 0; i < 2; i++) assert.throws(() => world.update(), OutOfMemoryError);
  assert.equal(world.stateHash(), hash);
  assert.deepEqual([...world.pairs()], [...far]);
  world.removeMany(ids.subarray(1000));
  assert.equal(world.update().begun.length, 1000 * 999);
  assert.equal(world.pairs().length, 1000 * 999 + 2);
  world.free();
});

test("answers to queries that do not fit leave the world as it was", () => {
  const world = new BroadPhase({ dimensions: 1 });
  const ids = world.insertMany(new Float32Array(2 * 24_000));
  const hash = world.stateHash();
  const points = new Float32Array(24_000); // 576 million answers: 4.6 GB
  for (const ask of [
    () => world.overlappingMany(new Float32Array(2 * 24_000)),
    () => world.containingMany(points),
    () => world.withinMany(points, 1),
    () => world.nearestMany(points, 24_000),
  ]) {
    assert.throws(ask, OutOfMemoryError);
    assert.equal(world.stateHash(), hash);
    assert.deepEqual(world.containing([0]), [...ids]);
  }
  world.free();
});

test("changes for which JavaScript has no memory come with the next update", () => {
  const world = new BroadPhase({ dimensions: 1 });
  const still = world.insert(0, 1);
  const moving = world.insert(0, 1);
  const { constructor } = Float64Array.prototype;
  const fail = () => {
    throw new RangeError("Array buffer allocation failed");
  };
  Object.defineProperty(Float64Array.prototype, "constructor", { get: fail, configurable: true });
  try {
    assert.throws(() => world.update(), OutOfMemoryError);
  } finally {
    Object.defineProperty(Float64Array.prototype, "constructor", { value: constructor, writable: true, configurable: true });
  }
  world.set(moving, 5, 6);
  assert.deepEqual([...world.update().begun], [still, moving]);
  assert.deepEqual([...world.update().ended], [still, moving]);
  // A restored world has none that could come.
  const saved = world.snapshot();
  world.set(moving, 0, 1);
  world.restore(saved);
  world.set(moving, 0, 1);
  assert.deepEqual([...world.update().begun], [still, moving]);
  world.free();
});
