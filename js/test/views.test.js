// What a call returns stays valid, whatever is called next; with the option `views` it is a view of memory.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { findPairs, init, PairFinder } from "sweep-and-prune";
import { BroadPhase, init as initWorlds } from "sweep-and-prune/broad-phase";
import { boxesSpread, random } from "./support/boxes.js";

before(() => Promise.all([init(), initWorlds()]));

const rows = Float32Array.from(boxesSpread(random(1), 2000, 2));

/** Lets the memory of worlds grow, and then overwrites what was freed of it. */
function disturb() {
  for (const count of [40_000, 1000]) {
    const other = new BroadPhase({ dimensions: 2 });
    other.insertMany(boxesSpread(random(2), count, 2));
    other.update();
    other.free();
  }
}

test("a loop over the events that calls the world sees every event", () => {
  const world = new BroadPhase({ dimensions: 2 });
  world.insertMany(new Float32Array(4 * 21)); // all at the origin: 210 pairs
  const { begun, ended } = world.update();
  let seen = 0;
  for (let i = 0; i < begun.length; i += 2, seen++) {
    for (const id of [begun[i] ?? NaN, begun[i + 1] ?? NaN]) assert.ok(world.contains(id) && world.box(id).length === 4);
    world.overlapping([0, 0, 1, 1]);
    world.pairsOf(begun[i] ?? NaN);
    world.insertMany(rows.subarray(0, 400));
    if (i % 100 === 0) world.update();
  }
  assert.equal(seen, 210);
  assert.equal(ended.length, 0);
  world.free();
});

test("every array of a world stays as it was, and belongs to JavaScript", () => {
  for (const precision of /** @type {const} */ (["single", "double"])) {
    const world = new BroadPhase({ dimensions: 2, precision });
    const ids = world.insertMany(rows);
    const first = world.update();
    world.removeMany(ids.subarray(0, 50));
    const second = world.update();
    assert.notEqual(first, second);
    const arrays = [ids, first.begun, first.ended, second.begun, second.ended, world.ids(), world.pairs()];
    const lists = [world.pairsOf(ids[60] ?? NaN), world.overlapping([0, 0, 1, 1]), world.containing([0.5, 0.5]), world.within([0.5, 0.5], 0.5)];
    const results = [...arrays, ...lists];
    assert.ok(results.filter(({ length }) => length > 0).length >= 8);
    const copies = results.map((result) => [...result]);
    world.removeMany(world.ids().subarray(0, 1000));
    world.update();
    disturb();
    world.free();
    assert.deepEqual(results.map((result) => [...result]), copies);
    assert.ok(lists.every(Array.isArray));
    for (const { buffer } of arrays) structuredClone(buffer, { transfer: [buffer] }); // throws for a WebAssembly memory
  }
});

test("what a finder returns stays as it was, and belongs to JavaScript", () => {
  const finder = new PairFinder({ dimensions: 2 });
  const [pairs, between] = [finder.find(rows), finder.findBetween(rows, rows)];
  const copies = [[...pairs], [...between]];
  assert.ok(pairs.length > 1000 && between.length > 1000);
  finder.find(boxesSpread(random(3), 60_000, 2));
  finder.free();
  findPairs(boxesSpread(random(4), 20_000, 2), { dimensions: 2 });
  assert.deepEqual([[...pairs], [...between]], copies);
  for (const { buffer } of [pairs, between]) structuredClone(buffer, { transfer: [buffer] });
});

test("an empty view can be read though memory has grown since the last one", () => {
  const world = new BroadPhase({ dimensions: 2, views: true });
  world.insertMany(rows.subarray(0, 8));
  world.update();
  const { begun, ended } = world.update();
  assert.deepEqual([...begun, ...ended], []);
  for (let count = 10_000; begun.buffer.byteLength > 0; count *= 2) {
    new BroadPhase({ dimensions: 2 }).insertMany(boxesSpread(random(5), count, 2));
  }
  assert.throws(() => [...begun], TypeError); // detached
  const now = world.update();
  assert.deepEqual([...now.begun, ...now.ended], []);
});

test("arrays to write to keep what is written, though memory moves and grows", () => {
  const world = new BroadPhase({ dimensions: 2 });
  const ids = world.insertMany(rows.subarray(0, 8));
  const into = world.buffers(2);
  world.insertMany(rows);
  disturb();
  into.ids.set(ids);
  into.boxes.set([5, 5, 6, 6, 7, 7, 8, 8]);
  world.setMany(into.ids, into.boxes);
  assert.deepEqual([world.box(ids[0] ?? NaN), world.box(ids[1] ?? NaN)], [[5, 5, 6, 6], [7, 7, 8, 8]]);
  world.free();
});

test("with views: a steady state makes no new array", () => {
  const finder = new PairFinder({ dimensions: 1, views: true });
  const lines = new Float32Array([0, 1, 1, 2]);
  assert.ok(finder.find(lines) === finder.find(lines));
  finder.free();
  const world = new BroadPhase({ dimensions: 2, views: true });
  const id = world.insert(0, 0, 1, 1);
  world.insert(0, 0, 1, 1);
  world.update();
  const changes = world.update();
  const { begun } = changes;
  world.set(id, 0, 0, 1, 2);
  assert.ok(world.update() === changes && changes.begun === begun);
  const { ids, boxes } = world.buffers(1);
  ids[0] = id;
  world.setMany(ids, boxes);
  assert.ok(world.buffers(1).boxes === boxes);
  const copy = BroadPhase.fromSnapshot(world.snapshot(), { dimensions: 2, views: true });
  assert.ok(copy.ids().buffer === copy.pairs().buffer, "these are not views");
  for (const one of [world, copy]) one.free();
});

test("with views: after the memory has grown an old view is empty, never wrong", () => {
  const finder = new PairFinder({ dimensions: 1, views: true });
  const pairs = finder.find([0, 1, 1, 2]);
  const count = pairs.buffer.byteLength / 8; // as many boxes as fill all the memory there is
  finder.find(Float64Array.from({ length: 2 * count }, (_, i) => i));
  assert.equal(pairs.length, 0);
  assert.deepEqual([...finder.find([0, 1, 1, 2])], [0, 1]);
  finder.free();
});

test("the option is true or false", () => {
  const options = /** @type {any} */ ({ dimensions: 2, views: 1 });
  const snapshot = new BroadPhase({ dimensions: 2 }).snapshot();
  for (const make of [() => new PairFinder(options), () => new BroadPhase(options), () => BroadPhase.fromSnapshot(snapshot, options)]) {
    assert.throws(make, /^TypeError: `views` must be true or false, not 1/);
  }
});
