// In development mode a view that is used after its time throws, whatever it then holds.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { findPairs, init, PairFinder } from "sweep-and-prune";
import { BroadPhase, init as initWorlds } from "sweep-and-prune/broad-phase";

before(() => Promise.all([init({ development: true }), initWorlds({ development: true })]));

test("a view of pairs works until the next call, and then throws", () => {
  const finder = new PairFinder({ dimensions: 1, views: true });
  const pairs = finder.find([0, 1, 1, 2]);
  assert.deepEqual([...pairs], [0, 1]);
  assert.equal(pairs.length, 2);
  assert.deepEqual(pairs.slice(), new Uint32Array([0, 1]));
  assert.deepEqual(new Uint32Array(pairs), new Uint32Array([0, 1]));
  const into = new Uint32Array(2);
  into.set(pairs);
  assert.deepEqual([...into], [0, 1]);
  new PairFinder({ dimensions: 1 }).count([0, 1]);
  for (const use of [() => pairs.length, () => pairs[0], () => [...pairs], () => pairs.slice(), () => (pairs[0] = 1)]) {
    assert.throws(use, /^TypeError: this view is stale/);
  }
  assert.deepEqual([...findPairs([0, 1, 1, 2], { dimensions: 1 })], [0, 1]);
});

test("so do the views of a world", () => {
  const world = new BroadPhase({ dimensions: 1, views: true });
  const [a, b] = [world.insert(0, 1), world.insert(1, 2)];
  const { begun, ended } = world.update();
  assert.deepEqual([...begun], [a, b]);
  assert.equal(ended.length, 0);
  world.set(a, 5, 6);
  assert.throws(() => begun[0], /stale/);
  assert.deepEqual([...world.update().ended], [a, b]);
  const ids = world.ids();
  assert.equal(ids.length, 2);
  world.remove(a);
  assert.throws(() => ids.length, /stale/);
  const left = world.ids();
  world.free();
  assert.throws(() => left.length, /stale/);
});

test("so do arrays to write to, and what they overwrite", () => {
  const world = new BroadPhase({ dimensions: 2, views: true });
  const ids = world.insertMany([0, 0, 1, 1, 0, 0, 2, 2]).slice();
  const { begun } = world.update();
  const into = world.buffers(2);
  assert.throws(() => begun.length, /stale/, "the memory may have grown");
  into.ids.set(ids);
  into.boxes.set([0, 0, 1, 1, 7, 7, 9, 9]);
  into.boxes[4] = 8;
  world.setMany(into.ids, into.boxes);
  assert.deepEqual(world.box(Number(ids[1])), [8, 7, 9, 9]);
  assert.throws(() => (into.boxes[0] = 1), /stale/);
  const old = world.buffers(2);
  world.insertMany([5, 5, 6, 6, 6, 6, 7, 7]);
  assert.throws(() => world.setMany(old.ids, old.boxes), /stale/);
  world.free();
});
