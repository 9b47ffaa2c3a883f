// A world's memory: it runs out as an error, and comes back, freed or forgotten. A file of its own:
// it needs gigabytes for a moment.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { setTimeout } from "node:timers/promises";
import { setFlagsFromString } from "node:v8";
import vm from "node:vm";
import { BroadPhase, init, OutOfMemoryError } from "sweep-and-prune/broad-phase";
import { boxesSpread, random } from "./support/boxes.js";

before(() => init());

const rows = boxesSpread(random(4), 5_000, 2);

/** How much memory there is now, in bytes. */
function memory() {
  const world = new BroadPhase({ dimensions: 2, views: true });
  world.insert(0, 0, 1, 1);
  const { byteLength } = world.ids().buffer;
  world[Symbol.dispose]();
  return byteLength;
}

// Before those that leave gigabytes to spare.
test("worlds that are never freed are freed once they are garbage", async () => {
  setFlagsFromString("--expose-gc");
  const collect = vm.runInNewContext("gc");
  const before = memory();
  for (let i = 0; i < 50; i++) {
    for (let j = 0; j < 4; j++) {
      const world = new BroadPhase({ dimensions: 2 });
      world.insertMany(rows);
      world.update();
    }
    collect();
    await setTimeout(1); // finalizers run between tasks
  }
  const grown = memory() - before;
  assert.ok(grown < 50 * 2 ** 20, `200 worlds of more than a megabyte each left ${grown} bytes`);
});

test("what no memory could hold is refused, and the world goes on", () => {
  const world = new BroadPhase({ dimensions: 2, views: true });
  const ids = world.insertMany([0, 0, 1, 1, 1, 1, 2, 2]).slice();
  // The system hands these out without touching them: they cost nothing.
  assert.throws(() => world.insertMany(new Float64Array(2 ** 29)), OutOfMemoryError);
  assert.throws(() => world.removeMany(new Float64Array(2 ** 29)), OutOfMemoryError);
  for (const count of [2 ** 28, 2 ** 30, 2 ** 32, 2 ** 32 + 2, 2 ** 53]) {
    assert.throws(() => world.buffers(count), OutOfMemoryError, String(count));
  }
  assert.throws(() => BroadPhase.fromSnapshot(new Uint8Array(2 ** 32), { dimensions: 2 }), OutOfMemoryError);
  assert.deepEqual([...world.update().begun], [...ids]);
  world.free();
});

test("pairs that do not fit: the world is as before, and others go on in the memory", () => {
  const rows = new Float32Array(4 * 40_000); // all overlap: 800 million pairs
  const other = new BroadPhase({ dimensions: 2 });
  other.insertMany([0, 0, 1, 1, 1, 1, 2, 2]);
  const worlds = [0, 1].map(() => {
    const world = new BroadPhase({ dimensions: 2 });
    const ids = world.insertMany(rows);
    assert.throws(() => world.update(), OutOfMemoryError);
    assert.equal(world.size, 40_000);
    return { world, ids };
  });
  assert.equal(other.update().begun.length, 2);
  for (const { world, ids } of worlds) {
    world.removeMany(ids.subarray(100));
    assert.equal(world.update().begun.length, 100 * 99);
    world.free();
  }
  other.free();
});
