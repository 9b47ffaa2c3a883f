// Many queries in one call find what a call for each of them finds, in the order of the queries.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { BroadPhase, init, slotOf } from "sweep-and-prune/broad-phase";
import { boxesAmong, random } from "./support/boxes.js";

before(() => init());

const among = [-3, -2, -1, 0, 1, 2, 3];

/** @typedef {{ ids: Float64Array, ends: Uint32Array }} Lists */

/** The list of each query. */
const listsOf = (/** @type {Lists} */ { ids, ends }) => [...ends].map((end, at) => [...ids.subarray(ends[at - 1] ?? 0, end)]);

/** Rows of numbers from one array, as many in each. */
const rowsOf = (/** @type {number[]} */ numbers, /** @type {number} */ width) => Array.from({ length: numbers.length / width }, (_, at) => numbers.slice(width * at, width * (at + 1)));

for (const precision of /** @type {const} */ (["single", "double"])) {
  for (const dimensions of /** @type {const} */ ([1, 2, 3])) {
    for (const views of [false, true]) {
      test(`${dimensions}D in ${precision} precision${views ? " with views" : ""}: as a call for each query`, () => {
        const next = random(dimensions);
        const world = new BroadPhase({ dimensions, precision, views });
        const bodies = boxesAmong(next, 60, dimensions, among);
        const ids = [...world.insertMany(bodies, Array.from({ length: 60 }, (_, at) => ({ category: 1 + (at % 3) })))];
        world.update();
        const points = Array.from({ length: 40 * dimensions }, () => Math.floor(7 * next()) - 3);
        const directions = Array.from({ length: 40 * dimensions }, () => Math.floor(3 * next()) - 1);
        const boxes = boxesAmong(next, 40, dimensions, among);
        const lengths = Array.from({ length: 40 }, () => Math.floor(4 * next()));
        const [eachPoint, eachDirection, eachBox] = [rowsOf(points, dimensions), rowsOf(directions, dimensions), rowsOf(boxes, 2 * dimensions)];
        const exclude = [ids[3] ?? NaN, ids[7] ?? NaN, NaN];
        for (const [filter, options] of /** @type {const} */ ([[undefined, undefined], [{ mask: 2 }, { exclude }], [undefined, { exclude: ids[0] ?? NaN }]])) {
          assert.deepEqual(listsOf(world.overlappingMany(boxes, filter, options)), eachBox.map((box) => [...world.overlapping(box, filter, options)]));
          assert.deepEqual(listsOf(world.containingMany(points, filter, options)), eachPoint.map((point) => [...world.containing(point, filter, options)]));
          assert.deepEqual(listsOf(world.withinMany(points, lengths, filter, options)), eachPoint.map((point, at) => [...world.within(point, lengths[at] ?? NaN, filter, options)]));
          assert.deepEqual(listsOf(world.withinMany(points, 1.5, filter, options)), eachPoint.map((point) => [...world.within(point, 1.5, filter, options)]));
          const unsorted = listsOf(world.overlappingMany(boxes, filter, { ...options, sorted: false }));
          assert.deepEqual(unsorted.map((list) => list.sort((a, b) => slotOf(a) - slotOf(b))), eachBox.map((box) => [...world.overlapping(box, filter, options)]));
          for (const [k, maxDistance] of /** @type {const} */ ([[1, Infinity], [5, 1.5], [0, 9], [2 ** 40, 2]])) {
            if (k >= 2 ** 32) {
              assert.throws(() => world.nearestMany(points, k, maxDistance), /^RangeError: `k`/);
              continue;
            }
            const near = world.nearestMany(points, k, maxDistance, filter, options);
            const expected = eachPoint.map((point) => world.nearest(point, k, maxDistance, filter, options));
            assert.deepEqual(listsOf(near), expected.map((list) => list.map(({ id }) => id)));
            assert.deepEqual([...near.distances], expected.flatMap((list) => list.map(({ distance }) => distance)));
          }
          for (const ignoreTouching of [false, true]) {
            const casting = { ...options, ignoreTouching };
            check(world.rayCastMany(points, directions, lengths, filter, casting), (at) => world.rayCast(eachPoint[at] ?? [], eachDirection[at] ?? [], lengths[at], filter, casting));
            check(world.rayCastMany(points, directions, undefined, filter, casting), (at) => world.rayCast(eachPoint[at] ?? [], eachDirection[at] ?? [], Infinity, filter, casting));
            check(world.boxCastMany(boxes, directions, 2, filter, casting), (at) => world.boxCast(eachBox[at] ?? [], eachDirection[at] ?? [], 2, filter, casting));
          }
        }
        world.free();

        /** @param {import("sweep-and-prune/broad-phase").Hits} hits @param {(at: number) => import("sweep-and-prune/broad-phase").Hit | undefined} single */
        function check({ ids, t, normals, startsInside }, single) {
          assert.equal(ids.length, 40);
          for (const [at, id] of ids.entries()) {
            const hit = single(at) ?? { id: -1, t: Infinity, normal: new Array(dimensions).fill(0), startsInside: false };
            assert.deepEqual({ id, t: t[at], normal: [...normals.subarray(at * dimensions, (at + 1) * dimensions)], startsInside: startsInside[at] === 1 }, hit);
          }
        }
      });
    }
  }
}

test("boxes and points in every form", () => {
  const world = new BroadPhase({ dimensions: 2 });
  const [a, b] = world.insertMany([0, 0, 2, 2, 5, 5, 6, 6]);
  const boxes = [[1, 1, 3, 3], [3, 3, 9, 9]];
  for (const form of [boxes, boxes.flat(), new Float32Array(boxes.flat()), new Int16Array(boxes.flat()), boxes.map(([minX = 0, minY = 0, maxX = 0, maxY = 0]) => ({ minX, minY, maxX, maxY }))]) {
    assert.deepEqual(listsOf(world.overlappingMany(/** @type {any} */ (form))), [[a], [b]]);
  }
  const points = [[1, 1], [5.5, 5.5]];
  for (const form of [points, points.flat(), new Float64Array(points.flat()), points.map(([x = 0, y = 0]) => ({ x, y }))]) {
    assert.deepEqual(listsOf(world.containingMany(form)), [[a], [b]]);
  }
  // Memory of its own: it may grow, and move, while the queries are written.
  const views = new BroadPhase({ dimensions: 2, views: true });
  const buffers = views.buffers(2);
  buffers.boxes.set([0, 0, 2, 2, 5, 5, 6, 6]);
  const ids = views.insertMany(buffers.boxes);
  assert.deepEqual(listsOf(views.overlappingMany(buffers.boxes, {}, { exclude: ids })), [[], []]);
  assert.deepEqual(listsOf(views.overlappingMany(views.buffers(2).boxes)).map(({ length }) => length), [1, 1]);
});

test("no queries find nothing, with every check", () => {
  const world = new BroadPhase({ dimensions: 2 });
  world.insert(0, 0, 1, 1);
  for (const found of [world.overlappingMany([]), world.containingMany([]), world.withinMany([], []), world.nearestMany([])]) assert.deepEqual([found.ids.length, found.ends.length], [0, 0]);
  assert.equal(world.rayCastMany([], []).ids.length, 0);
  assert.throws(() => world.overlappingMany([], { mask: 0.5 }), /^RangeError: `mask`/);
  world.free();
  assert.throws(() => world.overlappingMany([]), /^TypeError: this BroadPhase was freed/);
});

test("errors name the argument, the query and the value", () => {
  const world = new BroadPhase({ dimensions: 2 });
  world.insertMany([0, 0, 1, 1, 0, 0, 2, 2]);
  const [box, nan] = [[0, 0, 1, 1], [0, NaN, 1, 1]];
  assert.throws(() => world.overlappingMany([box, box, nan]), { name: "InvalidBoxError", index: 2, axis: 1, argument: "boxes", message: /box 2 of `boxes` has a NaN on axis 1 \(y\): its min is NaN and its max 1/ });
  assert.throws(() => world.overlappingMany([...box, 5, 0, 3, 1], undefined, { exclude: 0 }), { name: "InvalidBoxError", index: 1, axis: 0, message: /is inverted on axis 0 \(x\): its min is 5 and its max 3/ });
  assert.throws(() => world.overlappingMany([0, 0, 1]), /^RangeError: boxes holds 3 numbers/);
  assert.throws(() => world.containingMany([0, 0, 1]), /^RangeError: `points` holds 3 numbers, which is not a multiple of 2/);
  assert.throws(() => world.containingMany([0, 0, NaN, 1]), /^RangeError: `points\[2\]` is NaN/);
  assert.throws(() => world.containingMany([[0, 0], [1]]), /^RangeError: `points\[1\]` has 1 numbers/);
  assert.throws(() => world.withinMany([0, 0, 1, 1], [1]), /^RangeError: `radii` has 1, and there are 2 queries/);
  assert.throws(() => world.withinMany([0, 0, 1, 1], [1, -1]), /^RangeError: `radii\[1\]` is -1; it must be 0 or more/);
  assert.throws(() => world.nearestMany([0, Infinity]), /^RangeError: `points\[1\]` is Infinity; it must be finite/);
  assert.throws(() => world.rayCastMany([0, 0, 1, 1], [1, 0]), /^RangeError: `directions` has 1, and there are 2 queries/);
  assert.throws(() => world.rayCastMany([0, 0], [1, 0], [1, 2]), /^RangeError: `limits` has 2, and there are 1 queries/);
  assert.throws(() => world.boxCastMany([3, 0, 1, 1], [1, 0]), /^RangeError: `box` is inverted/);
  assert.throws(() => world.overlappingMany(box, /** @type {any} */ (() => true)), /^TypeError: `filter` must be an object here/);
  assert.throws(() => world.overlappingMany(box, /** @type {any} */ ({ sorted: false })), /^TypeError: `filter` has no `sorted`/);
  assert.throws(() => world.rayCastMany([0, 0], [1, 0], 1, {}, /** @type {any} */ ({ sorted: false })), /^TypeError: `options` has no `sorted`/);
});

test("lists are copies, or with the option `views` their ids are views until the next call", () => {
  const world = new BroadPhase({ dimensions: 2 });
  world.insertMany(boxesAmong(random(1), 100, 2, among));
  const found = world.overlappingMany(boxesAmong(random(2), 50, 2, among));
  const copied = listsOf(found);
  world.overlappingMany(boxesAmong(random(3), 80, 2, among));
  world.free();
  assert.deepEqual(listsOf(found), copied);
  for (const { buffer } of [found.ids, found.ends]) structuredClone(buffer, { transfer: [/** @type {ArrayBuffer} */ (buffer)] });
  const viewed = new BroadPhase({ dimensions: 2, views: true });
  viewed.insert(0, 0, 1, 1);
  const [first, second] = [viewed.overlappingMany([0, 0, 1, 1]), viewed.overlappingMany([0, 0, 1, 1])];
  assert.equal(first.ids.buffer, second.ids.buffer);
  assert.deepEqual([...first.ends], [1]);
  viewed.overlappingMany([5, 5, 6, 6]);
  assert.deepEqual([...first.ends], [1], "where the lists end is a copy");
});

test("a box of many that is inverted or too large is named by its query", () => {
  const world = new BroadPhase({ dimensions: 2 });
  world.insert([0, 0, 1, 1]);
  const along = [1, 0, 1, 0];
  assert.throws(() => world.boxCastMany([0, 0, 1, 1, 5, 5, 4, 6], along), { name: "RangeError", message: /^the box of query 1 is inverted/ });
  assert.throws(() => world.rayCastMany([0, 0, 5, 1e300], along), { name: "RangeError", message: /^the box of query 1 .* too large for single precision/ });
  assert.throws(() => world.boxCast([3, 3, 1, 1], [1, 0]), { name: "RangeError", message: /^`box` is inverted/ });
  assert.equal(world.boxCastMany([0, 0, 1, 1, 5, 5, 6, 6], along).ids.length, 2, "afterwards it answers as before");
});
