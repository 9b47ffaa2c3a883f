// A world against a model: a map of boxes, and brute force.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import {
  BroadPhase,
  init,
  InvalidBoxError,
  NotInitializedError,
  OutOfMemoryError,
  SnapshotError,
  slotOf,
  StaleProxyError,
} from "sweep-and-prune/broad-phase";
import { boxesAmong, boxesSpread, oracle, random } from "./support/boxes.js";

/** @typedef {1 | 2 | 3} Dimensions */

assert.throws(() => new BroadPhase({ dimensions: 2 }), (error) => error instanceof NotInitializedError && /import `init` from "sweep-and-prune\/broad-phase"/.test(error.message));
before(() => init());

const every = /** @type {const} */ ([1, 2, 3]);
const kinds = every.flatMap((dimensions) => /** @type {const} */ (["single", "double"]).map((precision) => ({ dimensions, precision })));
const precisions = /** @type {const} */ (["single", "double"]);

/** @param {Float64Array} ids */
function pairsOf(ids) {
  return Array.from({ length: ids.length / 2 }, (_, i) => `${ids[2 * i]}-${ids[2 * i + 1]}`);
}

/**
 * The pairs of a map of boxes, sorted as a world sorts them.
 *
 * @param {Map<number, number[]>} model
 * @param {Dimensions} dimensions
 */
function modelPairs(model, dimensions) {
  const ids = [...model.keys()].sort((a, b) => slotOf(a) - slotOf(b));
  const rows = ids.flatMap((id) => model.get(id) ?? []);
  return oracle(rows, dimensions).map(([a, b]) => `${ids[a]}-${ids[b]}`);
}

for (const dimensions of every) {
  for (const precision of precisions) {
    test(`equals the model in ${dimensions}D, ${precision} precision`, () => {
      const next = random(30 + dimensions);
      const world = new BroadPhase({ dimensions, precision });
      /** @type {Map<number, number[]>} */
      const model = new Map();
      const row = () => boxesAmong(next, 1, dimensions).map((at) => (precision === "single" ? Math.fround(at) : at));
      /** @type {string[]} */
      let pairs = [];
      for (let step = 0; step < 300; step++) {
        const ids = [...model.keys()];
        const some = ids.filter(() => next() < 0.2);
        switch (Math.floor(next() * 6)) {
          case 0: {
            const box = row();
            model.set(world.insert(.../** @type {[number, number]} */ (/** @type {unknown} */ (box))), box);
            break;
          }
          case 1: {
            const boxes = Array.from({ length: Math.floor(next() * 4) }, row);
            world.insertMany(boxes.flat()).forEach((id, i) => model.set(id, boxes[i] ?? []));
            break;
          }
          case 2:
            for (const id of some.slice(0, 2)) {
              const box = row();
              world.set(id, .../** @type {[number, number]} */ (/** @type {unknown} */ (box)));
              model.set(id, box);
            }
            break;
          case 3: {
            const boxes = some.map(row);
            const into = world.buffers(some.length);
            into.ids.set(some);
            into.boxes.set(boxes.flat());
            world.setMany(into.ids, into.boxes);
            some.forEach((id, i) => model.set(id, boxes[i] ?? []));
            break;
          }
          case 4:
            if (next() < 0.5) world.removeMany(some.slice(0, 2));
            else some.slice(0, 2).forEach((id) => world.remove(id));
            some.slice(0, 2).forEach((id) => model.delete(id));
            break;
          case 5: {
            const { begun, ended } = world.update();
            const now = modelPairs(model, dimensions);
            assert.deepEqual(pairsOf(begun).sort(), now.filter((pair) => !pairs.includes(pair)).sort());
            assert.deepEqual(pairsOf(ended).sort(), pairs.filter((pair) => !now.includes(pair)).sort());
            assert.deepEqual(pairsOf(world.pairs()), now);
            pairs = now;
            for (const id of some) {
              const others = now.flatMap((pair) => pair.split("-").map(Number)).filter((_, i, all) => all[i ^ 1] === id);
              assert.deepEqual([...world.pairsOf(id)], others.sort((a, b) => slotOf(a) - slotOf(b)));
            }
          }
        }
        assert.equal(world.size, model.size);
        for (const id of some.filter((id) => model.has(id))) assert.deepEqual(world.box(id).map((at) => at + 0), model.get(id)?.map((at) => at + 0));
      }
      assert.deepEqual([...world.ids()].sort(), [...model.keys()].sort());
      world.free();
    });
  }
}

test("a removed id is stale, and its slot is reused under another id", () => {
  const world = new BroadPhase({ dimensions: 2 });
  const first = world.insert(0, 0, 1, 1);
  world.remove(first);
  world.update();
  const second = world.insert(0, 0, 1, 1);
  assert.equal(slotOf(first), slotOf(second));
  assert.notEqual(first, second);
  assert.ok(Number.isSafeInteger(second));
  assert.equal(world.contains(first), false);
  assert.equal(world.contains(second), true);
  const stale = [first, -1, 0.5, NaN, Infinity, 2 ** 60, second + 1];
  for (const id of stale) {
    assert.throws(() => world.set(id, 0, 0, 1, 1), StaleProxyError);
    assert.throws(() => world.remove(id), StaleProxyError);
    assert.throws(() => world.box(id), StaleProxyError);
    assert.throws(() => world.filter(id), StaleProxyError);
    assert.throws(() => world.pairsOf(id), StaleProxyError);
    assert.throws(() => world.setSwept(id, [0, 0, 1, 1], [0, 0, 1, 1]), StaleProxyError);
    const many = [second, second, Number(id)];
    assert.throws(
      () => world.setMany(many, new Float32Array(12)),
      (error) => error instanceof StaleProxyError && error.index === 2,
    );
    assert.throws(() => world.removeMany([Number(id)]), StaleProxyError);
  }
  assert.throws(() => world.removeMany([second, second]), StaleProxyError);
  assert.deepEqual(world.box(second), [0, 0, 1, 1]);
  world.free();
});

test("a refused call changes nothing", () => {
  const world = new BroadPhase({ dimensions: 2 });
  const id = world.insert(0, 0, 1, 1);
  const before = world.stateHash();
  assert.throws(() => world.insert(0, 0, 1, NaN), InvalidBoxError);
  assert.throws(() => world.insert(2, 0, 1, 1), InvalidBoxError);
  assert.throws(() => world.set(id, 0, 0, 1, NaN), InvalidBoxError);
  assert.throws(
    () => world.insertMany([0, 0, 1, 1, 0, 3, 1, 1]),
    (error) => error instanceof InvalidBoxError && error.index === 1 && error.axis === 1,
  );
  assert.throws(() => world.insertMany([0, 0, 1]), RangeError);
  assert.throws(() => world.setMany([id], new Float32Array(8)), RangeError);
  assert.throws(() => world.setMany([id, id], [0, 0, 9, 9, 1, 0, 0, 0]), InvalidBoxError);
  assert.throws(() => world.setFilter(id, { category: 2 ** 32 }), RangeError);
  assert.throws(() => world.setFilter(id, { group: 1.5 }), RangeError);
  assert.throws(() => world.overlapping([0, 0, 1]), RangeError);
  assert.throws(() => world.overlapping([1, 0, 0, 1]), InvalidBoxError);
  assert.throws(() => world.rayCast([NaN, 0], [1, 0]), RangeError);
  assert.throws(() => world.within([0, 0], -1), RangeError);
  assert.throws(() => world.nearest([0, Infinity]), RangeError);
  assert.throws(() => world.nearest([0, 0], 0.5), RangeError);
  assert.throws(() => world.buffers(-1), RangeError);
  assert.equal(world.stateHash(), before);
  assert.throws(() => new BroadPhase({ dimensions: 2, report: "fat", margin: -1 }), RangeError);
  assert.throws(() => new BroadPhase({ dimensions: 2, report: "fat", margin: NaN }), RangeError);
  assert.throws(() => new BroadPhase({ dimensions: 2, precision: /** @type {any} */ ("half") }), RangeError);
  assert.throws(() => new BroadPhase({ dimensions: /** @type {any} */ (4) }), RangeError);
  world.free();
  world.free();
  assert.throws(() => world.insert(0, 0, 1, 1), /^TypeError: this BroadPhase was freed/);
});

test("masks, groups and static bodies decide which bodies pair", () => {
  const world = new BroadPhase({ dimensions: 1 });
  const [a, b] = [world.insert(0, 1), world.insert(0, 1)];
  const pairs = () => (world.update(), world.pairs().length / 2);
  assert.equal(pairs(), 1);
  assert.deepEqual(world.filter(a), { category: 1, mask: 2 ** 32 - 1, group: 0, isStatic: false });
  world.setFilter(a, { mask: ~1 });
  assert.equal(world.filter(a).mask, 2 ** 32 - 2);
  assert.equal(pairs(), 0);
  world.setFilter(a, { mask: 0, group: 7 });
  world.setFilter(b, { group: 7 });
  assert.equal(pairs(), 1);
  world.setFilter(a, { group: -7 });
  world.setFilter(b, { group: -7 });
  assert.equal(pairs(), 0);
  world.setFilter(a, { isStatic: true });
  world.setFilter(b, { isStatic: true });
  assert.equal(pairs(), 0);
  assert.equal(world.overlapping([0, 1]).length, 2);
  assert.equal(world.overlapping([0, 1], { isStatic: true }).length, 0);
  world.free();
});

test("a disabled body pairs with none and is not found, and keeps its filter", () => {
  const world = new BroadPhase({ dimensions: 1 });
  const [a, b] = [world.insert(0, 1), world.insert(0, 1)];
  const pairs = () => (world.update(), world.pairs().length / 2);
  assert.equal(pairs(), 1);
  world.setEnabled(a, false);
  world.setFilter(a, { group: 3 });
  assert.deepEqual([world.isEnabled(a), world.isEnabled(b), world.filter(a).group], [false, true, 3]);
  assert.equal(pairs(), 0);
  assert.deepEqual([...world.containing([0.5])], [b]);
  assert.equal(world.rayCast([-1], [1])?.id, b);
  assert.equal(BroadPhase.fromSnapshot(world.snapshot(), { dimensions: 1 }).isEnabled(a), false);
  world.setEnabled(a, true);
  assert.equal(pairs(), 1);
  assert.throws(() => world.setEnabled(a, /** @type {any} */ (0)), /^TypeError: `enabled` must be true or false, not 0/);
  world.free();
});

test("pairs are excluded one by one, and included again", () => {
  const world = new BroadPhase({ dimensions: 1 });
  const [a = NaN, b = NaN, c = NaN] = world.insertMany([0, 1, 0, 1, 0, 1]);
  const pairs = () => (world.update(), [...world.pairs()]);
  world.excludePair(b, a);
  assert.deepEqual([world.isExcluded(a, b), world.isExcluded(b, c)], [true, false]);
  assert.deepEqual(pairs(), [a, c, b, c]);
  const restored = BroadPhase.fromSnapshot(world.snapshot(), { dimensions: 1 });
  world.includePair(a, b);
  restored.includePair(a, b);
  assert.deepEqual(pairs(), [a, b, a, c, b, c]);
  assert.deepEqual([...restored.update().begun], [a, b]);
  world.excludePair(a, a);
  assert.equal(world.isExcluded(a, a), false);
  world.excludePair(a, c);
  world.remove(c);
  const again = world.insert(0, 1);
  world.update();
  assert.throws(() => world.includePair(a, c), (error) => error instanceof StaleProxyError && error.index === 1 && error.id === c);
  assert.deepEqual(pairs(), [a, b, a, again, b, again]);
  world.free();
  restored.free();
});

for (const views of [false, true]) test(`pairs by body are those that \`pairsOf\` gives for each; views: ${views}`, () => {
  const world = new BroadPhase({ dimensions: 2, views });
  const next = random(3);
  const ids = world.insertMany(boxesSpread(next, 400, 2)).slice();
  world.update();
  world.removeMany(ids.filter(() => next() < 0.2));
  world.update();
  world.insertMany(boxesSpread(next, 50, 2));
  world.update();
  const { starts, others } = world.pairsByBody();
  assert.ok(others.length > 200);
  for (const id of world.ids().slice()) {
    const slot = slotOf(id);
    assert.deepEqual([...others.subarray(starts[slot], starts[slot + 1])], world.pairsOf(id));
  }
  world.free();
});

test("a swept body pairs with what it would have jumped over", () => {
  const world = new BroadPhase({ dimensions: 2 });
  const wall = world.insert(5, -5, 5.1, 5);
  const bullet = world.insert(0, 0, 0.1, 0.1);
  world.update();
  world.setSwept(bullet, [0, 0, 0.1, 0.1], [10, 0, 10.1, 0.1]);
  assert.deepEqual([...world.update().begun], [wall, bullet]);
  assert.deepEqual([...world.update().ended], [wall, bullet]);
  assert.equal(world.box(bullet)[0], 10);
  world.free();
});

test("fat AABBs pair within the margin", () => {
  const world = new BroadPhase({ dimensions: 3, margin: 0.5, report: "fat" });
  world.insert(0, 0, 0, 1, 1, 1);
  world.insert(1.75, 0, 0, 2, 1, 1);
  assert.equal(world.update().begun.length, 2);
  const exact = new BroadPhase({ dimensions: 3 });
  exact.insert(0, 0, 0, 1, 1, 1);
  exact.insert(1.75, 0, 0, 2, 1, 1);
  assert.equal(exact.update().begun.length, 0);
});

test("a fat AABB reaches ahead of a body that moves, not of one that teleports or rests", () => {
  for (const { dimensions, precision } of kinds) {
    const world = /** @type {BroadPhase} */ (new BroadPhase(/** @type {any} */ ({ dimensions, precision, report: "fat", margin: 0.5, prediction: 2 })));
    const at = (/** @type {number} */ x) => [x, 0, 0].slice(0, dimensions).concat([x + 1, 1, 1].slice(0, dimensions));
    const reach = () => [world.reportedBox(id)[0], world.reportedBox(id)[dimensions]];
    const id = world.insert(/** @type {any} */ (at(0)));
    world.update();
    assert.deepEqual(reach(), [-0.5, 1.5]);
    world.set(id, /** @type {any} */ (at(2)));
    assert.deepEqual(reach(), [1.5, 7.5]);
    world.set(id, /** @type {any} */ (at(0)));
    assert.deepEqual(reach(), [-0.5, 1.5], "a move that is taken back");
    world.set(id, /** @type {any} */ (at(2)));
    world.update();
    world.update();
    assert.deepEqual(reach(), [1.5, 3.5], "at rest");
    world.teleport(id, /** @type {any} */ (at(4)));
    assert.deepEqual(reach(), [3.5, 5.5]);
    world.free();
  }
});

test("a shift moves all boxes and reports nothing", () => {
  for (const { dimensions, precision } of kinds) {
    const options = /** @type {any} */ ({ dimensions, precision });
    for (const world of [new BroadPhase(options), new BroadPhase({ ...options, report: "fat", margin: 0.25, prediction: 1 })]) {
      // Quarters, so that nothing is rounded.
      const rows = boxesSpread(random(7), 300, dimensions).map((corner) => Math.round(4 * corner) / 4);
      const ids = world.insertMany(rows);
      world.update();
      const before = [...world.pairs()];
      const offset = [1024, -64, 8].slice(0, dimensions);
      world.shift(/** @type {any} */ (offset));
      const { begun, ended } = world.update();
      assert.deepEqual([begun.length, ended.length], [0, 0]);
      assert.deepEqual([...world.pairs()], before);
      const first = [...rows.subarray(0, 2 * dimensions)].map((corner, at) => corner + (offset[at % dimensions] ?? NaN));
      assert.deepEqual(world.box(ids[0] ?? NaN), first);
      for (const wrong of [[NaN, 0, 0], [Infinity, 0, 0], [0, 0, 0, 0], "1", null]) assert.throws(() => world.shift(/** @type {any} */ (wrong)), /`offset/);
      assert.deepEqual(world.box(ids[0] ?? NaN), first);
      world.free();
    }
  }
  assert.throws(() => new BroadPhase({ dimensions: 2 }).shift([1e39, 0]), /^RangeError: `offset\[0\]` is Infinity; it must be finite/);
});

test("queries equal brute force", () => {
  for (const dimensions of every) {
    const next = random(40 + dimensions);
    const rows = Float32Array.from(boxesSpread(next, 400, dimensions));
    const world = new BroadPhase({ dimensions });
    const ids = world.insertMany(rows);
    const width = 2 * dimensions;
    const at = (/** @type {number} */ i) => Array.from(rows.subarray(i * width, (i + 1) * width));
    /** @param {number[]} point @param {number[]} box */
    const distance = (point, box) =>
      Math.hypot(...point.map((x, axis) => Math.max(0, (box[axis] ?? 0) - x, x - (box[axis + dimensions] ?? 0))));
    for (let round = 0; round < 30; round++) {
      const point = Array.from({ length: dimensions }, () => Math.fround(next()));
      const area = [...point, ...point.map((x) => Math.fround(x + 0.1))];
      const expected = [...ids].filter((_, i) => oracle([...at(i), ...area], dimensions).length > 0);
      assert.deepEqual([...world.overlapping(area)], expected);
      const holding = [...ids].filter((_, i) => distance(point, at(i)) === 0);
      assert.deepEqual([...world.containing(point)], holding);
      const near = [...ids].filter((_, i) => distance(point, at(i)) <= 0.125);
      assert.deepEqual([...world.within(point, 0.125)], near);
      const nearest = world.nearest(point, 5);
      const distances = [...ids].map((_, i) => distance(point, at(i))).sort((a, b) => a - b);
      nearest.forEach((neighbor, i) => assert.ok(Math.abs(neighbor.distance - (distances[i] ?? NaN)) < 1e-9));
      assert.equal(nearest.length, 5);
      const direction = [1, ...point.slice(1).map(() => 0)];
      const hit = world.rayCast(point, direction, 2);
      const all = world.rayCastAll(point, direction, 2);
      assert.deepEqual(all[0], hit);
      const end = [...point];
      end[0] = 2;
      const path = [...point, ...point];
      path[dimensions] = 3;
      assert.deepEqual(all.map((hit) => hit.id).sort(), [...world.overlapping(path)].sort());
      assert.deepEqual(world.boxCast([...point, ...point], direction, 2), hit);
      assert.deepEqual(world.boxCastAll([...point, ...point], direction, 2), all);
    }
    world.free();
  }
});

test("a restored world continues like the one that was saved", () => {
  for (const precision of precisions) {
    const next = random(50);
    const world = new BroadPhase({ dimensions: 2, precision });
    const ids = world.insertMany(boxesSpread(next, 200, 2));
    world.update();
    world.removeMany(ids.subarray(0, 20));
    world.set(ids[30] ?? 0, 0, 0, 1, 1);
    const bytes = world.snapshot();
    const copy = BroadPhase.fromSnapshot(bytes, { dimensions: 2 });
    assert.equal(copy.precision, precision);
    assert.equal(copy.stateHash(), world.stateHash());
    assert.deepEqual(copy.snapshot(), bytes);
    const changes = [world, copy].map((each) => {
      each.set(ids[40] ?? 0, 0.25, 0.25, 0.75, 0.75);
      const { begun, ended } = each.update();
      return [begun, ended, each.insert(0, 0, 1, 1)];
    });
    assert.ok(/** @type {Float64Array} */ (changes[0]?.[0]).length > 0);
    assert.deepEqual(changes[0], changes[1]);
    assert.equal(copy.stateHash(), world.stateHash());
    assert.throws(() => copy.set(ids[0] ?? 0, 0, 0, 1, 1), StaleProxyError);

    const changed = bytes.slice();
    changed[50] = (changed[50] ?? 0) ^ 1;
    const bad = [new Uint8Array(0), bytes.subarray(0, 30), bytes.subarray(1), changed];
    for (const each of bad) assert.throws(() => BroadPhase.fromSnapshot(each, { dimensions: 2 }), SnapshotError);
    if (precision === "single") assert.throws(() => BroadPhase.fromSnapshot(bytes, { dimensions: 3 }), /other dimensions: pass `dimensions: 2`/);
    assert.throws(() => BroadPhase.fromSnapshot(/** @type {any} */ ([...bytes]), { dimensions: 2 }), TypeError);
  }
});

test("insert and set take as many numbers as a box has, and nothing else", () => {
  for (const dimensions of every) {
    for (const precision of precisions) {
      const world = /** @type {any} */ (new BroadPhase({ dimensions, precision }));
      const box = [0, 0, 0, 1, 1, 1].slice(3 - dimensions, 3 + dimensions);
      const id = world.insert(...box);
      const before = world.stateHash();
      const bad = [[...box, 1], box.slice(1), [], ...box.flatMap((_, at) => [null, "1", undefined, 1n].map((odd) => box.with(at, /** @type {any} */ (odd))))];
      for (const args of bad) {
        assert.throws(() => world.insert(...args), { name: "TypeError", message: new RegExp(`a box in ${dimensions}D is ${2 * dimensions} numbers: min`) });
        assert.throws(() => world.set(id, ...args), { name: "TypeError", message: /a box in .D/ });
      }
      assert.throws(() => world.insert(...box.with(0, NaN)), InvalidBoxError);
      assert.equal(world.stateHash(), before);
      world.free();
    }
  }
  const world = /** @type {any} */ (new BroadPhase({ dimensions: 2 }));
  assert.throws(() => world.insert(0, 0, null, 1), /`maxX` must be a number, not null; .*minX, minY, maxX, maxY/);
  assert.throws(() => world.insert(0, 0, 0, 1, 1, 1), /more arguments than maxY/);
});

test("an id must be a number: an object whose valueOf frees the world reaches no other memory", () => {
  const world = /** @type {any} */ (new BroadPhase({ dimensions: 1 }));
  const id = world.insert(0, 1);
  const calls = { set: [0, 1], teleport: [0, 1], setSwept: [[0, 1], [0, 1]], remove: [], box: [], reportedBox: [], filter: [], setFilter: [{}], pairsOf: [] };
  const evil = { valueOf: () => (world.free(), id) };
  for (const [name, rest] of Object.entries(calls)) {
    for (const odd of [evil, String(id), null, undefined, BigInt(id)]) {
      assert.throws(() => world[name](odd, ...rest), { name: "TypeError", message: /`id` must be a number, not / }, name);
    }
  }
  assert.equal(world.contains(evil), false);
  assert.throws(() => world.within([0], evil), /TypeError: `radius` must be a number/);
  assert.throws(() => world.rayCast([0], [1], evil), /TypeError: `limit` must be a number/);
  assert.equal(world.size, 1);
  world.free();
});

test("messages name the argument, its value and the limit", () => {
  const world = new BroadPhase({ dimensions: 2 });
  const id = world.insert(0, 0, 1, 1);
  /** @type {[() => unknown, RegExp][]} */
  const cases = [
    [() => world.set(id + 1, 0, 0, 1, 1), new RegExp(`^StaleProxyError: the id at index 0 \\(${id + 1}\\) is stale`)],
    [() => world.removeMany([id, 7]), /^StaleProxyError: the id at index 1 \(7\) is stale/],
    [() => world.setSwept(id, [0, 0, 1, 1], [0, 2, 1, 1]), /^InvalidBoxError: box 0 of `to` is inverted on axis 1 \(y\)/],
    [() => world.setSwept(id, [2, 0, 1, 1], [0, 0, 1, 1]), /^InvalidBoxError: box 0 of `from` .* axis 0 \(x\)/],
    [() => world.overlapping([0, 2, 1, 1]), /^InvalidBoxError: box 0 of `box`/],
    [() => world.insertMany([0, 0, 1, 1, 2, 2, 1, 1]), /^InvalidBoxError: box 1 of `boxes`/],
    [() => world.within([0, 0], -1), /^RangeError: `radius` is -1; it must be 0 or more/],
    [() => world.within([0, NaN], 1), /^RangeError: `center\[1\]` is NaN; it must be finite/],
    [() => world.containing([NaN, 0]), /^RangeError: `point\[0\]` is NaN; it must be a number/],
    [() => world.rayCast([0, 0], [1, Infinity]), /^RangeError: `direction\[1\]` is Infinity; it must be finite/],
    [() => world.rayCast([0, 0], [1, 0], -1), /^RangeError: `limit` is -1; it must be 0 or more/],
    [() => world.boxCast([0, 2, 1, 1], [1, 0]), /^RangeError: `box` is inverted/],
    [() => world.nearest([0, 0], 0.5), /^RangeError: `k` is 0.5; it must be a whole number/],
    [() => world.overlapping([0, 1]), /^RangeError: `box` has 2 numbers; in 2D it must have 4/],
    [() => world.setFilter(id, { mask: 2 ** 32 }), /^RangeError: `mask` of the filter is 4294967296; /],
    [() => new BroadPhase({ dimensions: 2, report: "fat", margin: -1 }), /^RangeError: `margin` is -1; it must be finite, and 0 or more/],
    [() => new BroadPhase({ dimensions: 2, prediction: 1 }), /^RangeError: `prediction` is 1, which has no effect without the option `report: "fat"`/],
  ];
  for (const [call, message] of cases) assert.throws(call, message);
  world.free();
});

test("buffers that JavaScript cannot allocate are an OutOfMemoryError", () => {
  const world = new BroadPhase({ dimensions: 1, precision: "double" });
  for (const count of [2 ** 33, 2 ** 52]) assert.throws(() => world.buffers(count), OutOfMemoryError);
  assert.throws(() => world.buffers(1.5), /^RangeError: `count` is 1.5/);
  world.free();
});

test("a snapshot whose dimensions were changed is refused, whatever it is read as", () => {
  for (const precision of precisions) {
    for (const from of every) {
      const world = new BroadPhase({ dimensions: from, precision });
      world.insertMany(new Float64Array(8 * from));
      const bytes = world.snapshot();
      // Boxes that are stored in more dimensions have theirs in the fifth byte.
      const isFlat = String.fromCharCode(...bytes.subarray(0, 4)) === "SaPf";
      assert.equal(isFlat, precision === "double" ? from < 3 : from < 2);
      for (const claimed of [0, 1, 2, 3, 255].filter((claimed) => claimed !== bytes[isFlat ? 4 : 5])) {
        const changed = bytes.with(isFlat ? 4 : 5, claimed);
        for (const to of every) assert.throws(() => BroadPhase.fromSnapshot(changed, { dimensions: to }), SnapshotError, `${from}D as ${to}D`);
      }
    }
  }
});

test("a snapshot of another dimension is refused, in each precision", () => {
  for (const from of every) {
    for (const precision of precisions) {
      const world = new BroadPhase({ dimensions: from, precision });
      const ids = world.insertMany(new Float64Array(8 * from));
      world.update();
      const bytes = world.snapshot();
      for (const to of every) {
        if (to !== from) assert.throws(() => BroadPhase.fromSnapshot(bytes, { dimensions: to }), SnapshotError, `${from}D as ${to}D`);
      }
      const copy = BroadPhase.fromSnapshot(bytes, { dimensions: from });
      assert.deepEqual([copy.dimensions, copy.precision, copy.stateHash()], [from, precision, world.stateHash()]);
      assert.deepEqual([...copy.ids()], [...ids]);
      assert.deepEqual(copy.snapshot(), bytes);
      for (let length = 0; length < 12; length++) {
        assert.throws(() => BroadPhase.fromSnapshot(bytes.subarray(0, length), { dimensions: from }), SnapshotError);
      }
    }
  }
});

test("a predicate decides what a query finds, and may call anything", () => {
  for (const views of [false, true]) {
    const world = new BroadPhase({ dimensions: 2, views });
    const next = random(60);
    const ids = world.insertMany(boxesSpread(next, 500, 2)).slice();
    const even = (/** @type {number} */ id) => {
      world.box(id);
      world.overlapping([0, 0, 1, 1]);
      world.insert(9, 9, 9, 9);
      return slotOf(id) % 2 === 0;
    };
    /** The even ones of what the same query finds without a predicate. @type {(found: Iterable<any>) => any[]} */
    const kept = (found) => [...found].filter((hit) => slotOf(hit.id ?? hit) % 2 === 0);
    for (let round = 0; round < 20; round++) {
      const [x, y] = [next() * 0.8, next() * 0.8];
      const area = [x, y, x + 0.2, y + 0.2];
      assert.deepEqual([...world.overlapping(area, even)], kept(world.overlapping(area)));
      assert.deepEqual([...world.containing([x, y], even)], kept(world.containing([x, y])));
      assert.deepEqual([...world.within([x, y], 0.1, even)], kept(world.within([x, y], 0.1)));
      const all = kept(world.rayCastAll([x, y], [1, 0], 5));
      assert.deepEqual(world.rayCastAll([x, y], [1, 0], 5, even), all);
      assert.deepEqual(world.rayCast([x, y], [1, 0], 5, even), all[0]);
      assert.deepEqual(world.boxCast(area, [1, 0], 5, even), kept(world.boxCastAll(area, [1, 0], 5))[0]);
      const near = kept(world.nearest([x, y], 500));
      for (const k of [0, 1, 3, 100, 400]) assert.deepEqual(world.nearest([x, y], k, Infinity, even).filter(({ distance }) => distance < 5), near.slice(0, k));
    }
    let calls = 0;
    world.rayCast([0, 0], [1, 1], 5, () => (calls++, true));
    assert.equal(calls, 1, "the nearest comes first, and the rest is not asked for");
    assert.equal(world.nearest([0, 0], 3, Infinity, () => false).length, 0);
    const error = new Error("from the predicate");
    assert.throws(() => world.overlapping([0, 0, 1, 1], () => { throw error; }), (thrown) => thrown === error);
    assert.ok(world.contains(ids[0] ?? NaN));
    world.free();
  }
});

test("a query without a filter finds every body, whatever its filter", () => {
  const world = new BroadPhase({ dimensions: 2 });
  const filters = [{ mask: 0 }, { category: 0 }, { group: -1 }, { isStatic: true }, { category: 0, mask: 0, group: -1 }];
  const ids = filters.flatMap((filter) => [...world.insertMany([0, 0, 1, 1], filter)]);
  /** @type {((filter?: any) => Iterable<any>)[]} */
  const queries = [
    (filter) => world.overlapping([0, 0, 1, 1], filter),
    (filter) => world.containing([0.5, 0.5], filter),
    (filter) => world.within([0.5, 0.5], 1, filter),
    (filter) => world.nearest([0.5, 0.5], 9, Infinity, filter),
    (filter) => world.rayCastAll([-1, 0.5], [1, 0], Infinity, filter),
    (filter) => world.boxCastAll([-1, 0, -1, 1], [1, 0], Infinity, filter),
  ];
  for (const query of queries) {
    const found = (/** @type {any} */ filter) => [...query(filter)].map((hit) => hit.id ?? hit);
    for (const none of [undefined, null, () => true]) assert.deepEqual(found(none), ids, String(query));
    assert.deepEqual(found({}), ids.slice(2, 4), String(query));
  }
  assert.equal(world.rayCast([-1, 0.5], [1, 0])?.id, ids[0]);
  assert.equal(world.boxCast([-1, 0, -1, 1], [1, 0])?.id, ids[0]);
  world.free();
});

test("without a limit, casts and nearest reach as far as numbers do", () => {
  const world = new BroadPhase({ dimensions: 1, precision: "double" });
  const id = world.insert(1e300, 2e300);
  const hit = { id, t: 1e300, normal: [-1], startsInside: false };
  assert.deepEqual([world.rayCast([0], [1]), world.rayCastAll([0], [1])], [hit, [hit]]);
  assert.deepEqual([world.boxCast([0, 0], [1]), world.boxCastAll([0, 0], [1])], [hit, [hit]]);
  assert.equal(world.rayCast([0], [1], 9e299), undefined);
  world.set(id, 1e150, 2e150);
  assert.deepEqual(world.nearest([0]), [{ id, distance: 1e150 }]);
  world.insert(1e150, 2e150);
  assert.equal(world.nearest([0]).length, 1, "one by default");
  world.free();
});

test("nearest finds nothing beyond maxDistance", () => {
  const world = new BroadPhase({ dimensions: 1 });
  const [a, b, c] = [world.insert(0, 1), world.insert(3, 4), world.insert(6, 7)];
  const found = (/** @type {[number?, any?]} */ ...rest) => world.nearest([0.5], 3, ...rest).map(({ id }) => id);
  assert.deepEqual(found(), [a, b, c]);
  assert.deepEqual(found(Infinity), [a, b, c]);
  assert.deepEqual(found(5.5), [a, b, c]);
  assert.deepEqual(found(5.4), [a, b]);
  assert.deepEqual(found(2.5, (/** @type {number} */ id) => id !== a), [b]);
  assert.deepEqual(found(0), [a]);
  for (const odd of [-1, NaN]) assert.throws(() => found(odd), /^RangeError: `maxDistance` is/);
  assert.throws(() => found(/** @type {any} */ ({})), /^TypeError: `maxDistance` must be a number/);
  // A distance that was found is not too far, though its square is rounded.
  const plane = new BroadPhase({ dimensions: 2, precision: "double" });
  const next = random(71);
  plane.insertMany(boxesSpread(next, 2000, 2));
  for (let round = 0; round < 200; round++) {
    const point = [next(), next()];
    const all = plane.nearest(point, 5);
    const farthest = all.at(-1)?.distance ?? NaN;
    assert.deepEqual(plane.nearest(point, 5, farthest), all);
    assert.ok(plane.nearest(point, 5, farthest * (1 - 2 ** -52)).every(({ distance }) => distance < farthest));
  }
  plane.free();
  world.free();
});

test("clear removes every body, and the next update reports that their pairs ended", () => {
  const world = new BroadPhase({ dimensions: 2 });
  const [a, b] = [world.insert(0, 0, 1, 1), world.insert(1, 1, 2, 2)];
  world.update();
  world.clear();
  assert.equal(world.size, 0);
  assert.throws(() => world.box(a), StaleProxyError);
  assert.deepEqual([...world.update().ended], [a, b]);
  world.clear();
  assert.notEqual(world.insert(0, 0, 1, 1), a);
  world.free();
});

test("pairs without an order are the same pairs", () => {
  const world = new BroadPhase({ dimensions: 2 });
  world.insertMany(boxesSpread(random(61), 3000, 2));
  world.update();
  world.removeMany(world.ids().subarray(0, 100));
  world.insertMany(boxesSpread(random(62), 1000, 2));
  world.update();
  const sorted = world.pairs();
  assert.ok(sorted.length > 2000);
  assert.deepEqual(world.pairs({ sorted: true }), sorted);
  assert.deepEqual(pairsOf(world.pairs({ sorted: false })).sort(), pairsOf(sorted).sort());
  world.free();
});

test("queries without an order find the same bodies", () => {
  const world = new BroadPhase({ dimensions: 2 });
  world.insertMany(boxesSpread(random(63), 3000, 2));
  const even = (/** @type {number} */ id) => id % 2 === 0;
  for (const filter of [undefined, { mask: 1 }, even]) {
    for (const [query, area] of /** @type {const} */ ([["overlapping", [0.2, 0.2, 0.8, 0.8]], ["containing", [0.5, 0.5]], ["within", [0.5, 0.5]]])) {
      const ask = (/** @type {any} */ options) => /** @type {any} */ (world)[query](area, ...(query === "within" ? [0.4] : []), filter, options);
      /** @type {Float64Array} */
      const sorted = ask({ sorted: true });
      assert.deepEqual(ask(undefined), sorted);
      assert.deepEqual(ask({ sorted: false }).sort(), sorted);
      if (query !== "containing") assert.ok(sorted.length > 100 && ask({ sorted: false }).join() !== sorted.join(), `${query} sorts nothing`);
    }
  }
  world.free();
});
