// What users keep with their bodies, and bodies with a filter from the start.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { findPairs, init, inPairs } from "sweep-and-prune";
import { BroadPhase, init as initWorlds } from "sweep-and-prune/broad-phase";

before(() => Promise.all([init(), initWorlds()]));

const unit = [0, 0, 1, 1];

/** @returns {BroadPhase<2, string>} */
const start = (views = false) => new BroadPhase({ dimensions: 2, views });

test("a body is inserted with a filter and data", () => {
  const world = start();
  const a = world.insert(unit, { data: "a", category: 2, mask: 1 });
  const b = world.insert({ minX: 0, minY: 0, maxX: 1, maxY: 1 }, { category: 2 });
  const c = world.insert(unit, { data: "c" });
  assert.deepEqual([a, b, c].map((id) => world.data(id)), ["a", undefined, "c"]);
  assert.deepEqual([a, b, c].map((id) => world.filter(id).category), [2, 2, 1]);
  const d = world.insert([5, 5, 6, 6], new (class { get mask() { return 4; } })());
  assert.equal(world.filter(d).mask, 4);
  assert.deepEqual(world.dataPairs(world.update().begun), [["a", "c"], [undefined, "c"]]);
  world.setData(b, "b");
  assert.deepEqual(world.dataOf(world.overlapping(unit)), ["a", "b", "c"]);
  assert.equal(world.data(world.rayCast([-1, 0.5], [1, 0])?.id ?? NaN), "a");
  world.free();
  assert.equal(world.data(a), undefined);
});

for (const views of [false, true]) {
  test(`many bodies with data, and the data of what ended${views ? ", with views" : ""}`, () => {
    const world = start(views);
    const ids = [...world.insertMany([unit, unit, unit], undefined, ["a", "b", "c"])];
    world.update();
    assert.deepEqual(world.dataPairs(world.pairs()), [["a", "b"], ["a", "c"], ["b", "c"]]);
    world.remove(ids[0] ?? NaN);
    world.removeMany(views ? world.overlapping(unit, undefined, { exclude: ids[2] ?? NaN }) : [ids[1] ?? NaN]);
    // Its slot has another body before the end is reported.
    const d = world.insert(unit, { data: "d" });
    assert.deepEqual(world.dataPairs(world.update().ended), [["a", "b"], ["a", "c"], ["b", "c"]]);
    assert.deepEqual(world.dataOf([...ids, d]), ["a", "b", "c", "d"]);
    world.update();
    assert.deepEqual(world.dataOf([...ids, d]), [undefined, undefined, "c", "d"]);
    world.clear();
    world.update();
    world.update();
    assert.deepEqual(world.dataOf([...ids, d]), [undefined, undefined, undefined, undefined]);
  });
}

test("after an error nothing has changed, nor has data that getters read", () => {
  const world = start();
  const a = world.insert(unit, { data: "a" });
  const fails = [
    () => world.insert([0, 0, NaN, 1], { data: "x" }),
    () => world.insert(unit, { data: "x", mask: 0.5 }),
    () => world.insertMany([unit, [2, 0, 1, 1]], {}, ["x", "y"]),
    () => world.insertMany([unit], {}, ["x", "y"]),
    () => world.removeMany([a, a]),
    () => world.remove(NaN),
  ];
  for (const fail of fails) assert.throws(fail);
  assert.deepEqual([[...world.ids()], world.dataOf(world.ids())], [[a], ["a"]]);
  world.update();
  world.update();
  assert.equal(world.data(a), "a");
});

test("a filter changes only in what it is given", () => {
  const world = start();
  const id = world.insert(unit, { category: 2, mask: 4, group: -3, isStatic: true });
  world.setFilter(id, { mask: 8 });
  assert.deepEqual(world.filter(id), { category: 2, mask: 8, group: -3, isStatic: true });
  world.setFilter(id, {});
  world.setFilter(id, /** @type {any} */ ({ isStatic: false, category: undefined }));
  assert.deepEqual(world.filter(id), { category: 2, mask: 8, group: -3, isStatic: false });
});

test("a loop over pairs of ids, and of indices", () => {
  const world = start();
  const [a, b, c] = world.insertMany([unit, unit, unit]);
  assert.deepEqual([...inPairs(world.update().begun)], [[a, b], [a, c], [b, c]]);
  assert.deepEqual([...inPairs(findPairs([unit, unit], { dimensions: 2 }))], [[0, 1]]);
  assert.deepEqual([...inPairs([])], []);
});
