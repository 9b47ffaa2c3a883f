// Worlds that go back to a snapshot, worlds that are copied, and the boxes of many bodies.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { BroadPhase, init } from "sweep-and-prune/broad-phase";
import { boxesSpread, random } from "./support/boxes.js";

before(() => init());

/** Some frames of a world that moves as its generator says: what each reports. */
function run(/** @type {BroadPhase} */ world, /** @type {number} */ seed) {
  const next = random(seed);
  const reports = [];
  for (let frame = 0; frame < 10; frame++) {
    const some = [...world.ids()].filter(() => next() < 0.5);
    world.setMany(some, boxesSpread(next, some.length, world.dimensions));
    if (frame % 3 === 0) world.remove(some[0] ?? NaN);
    if (frame % 4 === 0) world.insertMany(boxesSpread(next, 3, world.dimensions), { mask: ~2 });
    const { begun, ended } = world.update();
    reports.push([...begun], [...ended]);
  }
  return [reports, world.stateHash()];
}

for (const dimensions of /** @type {const} */ ([1, 2, 3])) {
  for (const precision of /** @type {const} */ (["single", "double"])) {
    test(`${dimensions}D in ${precision} precision: goes back in place, and a clone goes its own way`, () => {
      for (const options of [{}, { views: true }, { report: /** @type {const} */ ("fat"), margin: 0.02, prediction: 1 }]) {
        const world = new BroadPhase({ dimensions, precision, ...options });
        world.insertMany(boxesSpread(random(1), 200, dimensions));
        run(world, 2);
        const [bytes, hash] = [world.snapshot(), world.stateHash()];
        const clone = world.clone();
        const first = run(world, 3);
        assert.equal(clone.stateHash(), hash);
        assert.deepEqual([clone.dimensions, clone.precision], [dimensions, precision]);
        world.restore(bytes);
        assert.equal(world.stateHash(), hash);
        assert.deepEqual(run(world, 3), first);
        assert.deepEqual(run(clone, 3), first);
        world.restore(bytes);
        world.free();
        assert.equal(clone.stateHash(), first[1]);
        clone.free();
        assert.throws(() => world.restore(bytes), /^TypeError: this BroadPhase was freed/);
      }
    });
  }
}

test("boxes of many bodies, in the precision of the world", () => {
  for (const [precision, Floats] of /** @type {const} */ ([["single", Float32Array], ["double", Float64Array]])) {
    for (const dimensions of /** @type {const} */ ([1, 2, 3])) {
      const world = new BroadPhase({ dimensions, precision });
      const rows = new Floats(boxesSpread(random(4), 50, dimensions));
      const ids = world.insertMany(rows);
      assert.deepEqual(world.boxes(ids), rows);
      const [a = NaN, , c = NaN] = ids;
      assert.deepEqual([...world.boxes([c, a])], [...world.box(c), ...world.box(a)]);
      assert.equal(world.boxes([]).length, 0);
      world.setMany(ids, world.boxes(ids));
      world.remove(a);
      assert.throws(() => world.boxes(ids), { name: "StaleProxyError", index: 0, id: a });
    }
  }
});

test("a body that is removed again after a restore still has its data when the end of its pairs is reported", () => {
  for (const updates of [true, false]) {
    /** @type {BroadPhase<1, string>} */
    const world = new BroadPhase({ dimensions: 1 });
    world.insert([0, 1], { data: "hero" });
    const bullet = world.insert([0, 1], { data: "bullet" });
    world.update();
    const bytes = world.snapshot();
    for (let round = 0; round < 3; round++) {
      if (round > 0) world.restore(bytes);
      if (!updates) world.update();
      world.remove(bullet);
      assert.deepEqual(world.dataPairs(world.update().ended), [["hero", "bullet"]]);
      if (updates) assert.equal(world.data(bullet), "bullet");
    }
    world.update();
    assert.equal(world.data(bullet), undefined);
  }
});

test("data goes with a clone, and stays over a restore for the bodies that are here", () => {
  /** @type {BroadPhase<1, string>} */
  const world = new BroadPhase({ dimensions: 1 });
  const a = world.insert([0, 1], { data: "a" });
  const bytes = world.snapshot();
  const b = world.insert([0, 1], { data: "b" });
  const clone = world.clone();
  clone.setData(a, "other");
  assert.deepEqual([world.dataOf([a, b]), clone.dataOf([a, b])], [["a", "b"], ["other", "b"]]);
  world.remove(a);
  world.restore(bytes);
  for (let round = 0; round < 3; round++) world.update();
  assert.deepEqual(world.dataOf([a, b]), ["a", undefined]);
  // The id is given again, to a body without data.
  world.restore(clone.snapshot());
  world.setData(b, "b");
  world.restore(bytes);
  assert.equal(world.insert([5, 6]), b);
  assert.equal(world.data(b), undefined);
  world.update();
  world.update();
  assert.deepEqual(world.dataOf([a, b]), ["a", undefined]);
});
