// Hits of rays and moving boxes against brute force: where, which face, whether they start inside, and what is left out.
// Coordinates are small whole numbers, so that boxes touch all the time, and speeds are powers of two, so that t is exact.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { BroadPhase, init, slotOf } from "sweep-and-prune/broad-phase";
import { boxesAmong, random } from "./support/boxes.js";

before(() => init());

/** @typedef {1 | 2 | 3} Dimensions */
/** @typedef {{ from: number[], direction: number[], limit: number }} Path */

const among = [-3, -2, -1, 0, 1, 2, 3];

/**
 * How a moving box meets another on an axis: how far it has to move up until it touches it, and until it is past.
 *
 * @param {Path} path
 * @param {number[]} box
 * @param {number} axis
 */
function meeting({ from, direction }, box, axis) {
  const d = direction.length;
  const at = (/** @type {number[]} */ of, /** @type {number} */ i) => of[i] ?? NaN;
  return { speed: at(direction, axis), before: at(box, axis) - at(from, axis + d), behind: at(box, axis + d) - at(from, axis) };
}

/** Whether they overlap at a time: with their edges, or within them. */
const overlaps = (/** @type {Path} */ path, /** @type {number[]} */ box, /** @type {number} */ t, isInside = false) =>
  path.direction.every((_, axis) => {
    const { speed, before, behind } = meeting(path, box, axis);
    return isInside ? before < speed * t && speed * t < behind : before <= speed * t && speed * t <= behind;
  });

/** The times at which something may change, and those between. */
function times(/** @type {Path} */ path, /** @type {number[]} */ box) {
  const edges = path.direction.flatMap((_, axis) => {
    const { speed, before, behind } = meeting(path, box, axis);
    return speed === 0 ? [] : [before / speed, behind / speed];
  });
  const all = [0, path.limit, ...edges.filter((t) => t > 0 && t < path.limit)].sort((a, b) => a - b);
  return all.flatMap((t, at) => [t, (t + (all[at + 1] ?? t)) / 2]);
}

/** The hit of one body, if there is one. */
function expectedHit(/** @type {Path} */ path, /** @type {number[]} */ box, /** @type {boolean} */ ignoreTouching) {
  const t = times(path, box).find((t) => overlaps(path, box, t));
  if (t === undefined || (ignoreTouching && !times(path, box).some((t) => overlaps(path, box, t, true)))) return undefined;
  const startsInside = overlaps(path, box, 0, true);
  const normal = path.direction.map(() => 0);
  if (!startsInside) {
    // The faces that touch at t; one that it moves towards comes first.
    const faces = path.direction.flatMap((_, axis) => {
      const { speed, before, behind } = meeting(path, box, axis);
      return [[before, -1], [behind, 1]].filter(([at]) => at === speed * t).map(([, side = 0]) => ({ axis, side, isApproached: speed * side < 0 }));
    });
    const face = faces.find(({ isApproached }) => isApproached) ?? faces[0];
    assert.ok(face, "no face touches");
    normal[face.axis] = face.side;
  }
  return { t, normal, startsInside };
}

for (const dimensions of /** @type {const} */ ([1, 2, 3])) {
  for (const precision of /** @type {const} */ (["single", "double"])) {
    test(`hits in ${dimensions}D, ${precision}, equal brute force`, () => {
      const next = random(70 + dimensions);
      let [touching, inside, ignored, faces] = [0, 0, 0, new Set()];
      for (let round = 0; round < 400; round++) {
        const world = new BroadPhase({ dimensions, precision, views: round % 2 === 0 });
        const width = 2 * dimensions;
        // Of some size: at flat boxes no inside can be entered.
        const grown = (/** @type {number[]} */ row) => row.map((at, i) => (i % width < dimensions ? at : at + 1));
        const rows = grown(boxesAmong(next, 6, dimensions, among));
        const ids = [...world.insertMany(rows)];
        const boxes = new Map(ids.map((id, i) => [id, rows.slice(i * width, (i + 1) * width)]));
        if (next() < 0.5) world.update();
        const isRay = next() < 0.3;
        const box = boxesAmong(next, 1, dimensions, among);
        const from = isRay ? [...box.slice(0, dimensions), ...box.slice(0, dimensions)] : grown(box);
        const speeds = [-2, -1, 0, 1, 2];
        const direction = Array.from({ length: dimensions }, () => speeds[Math.floor(next() * 5)] ?? 0);
        const limit = [0, 0.5, 1, 4, 100][Math.floor(next() * 5)] ?? 0;
        const path = { from, direction, limit };
        for (const ignoreTouching of [false, true]) {
          const exclude = ids.filter(() => next() < 0.2);
          const expected = ids
            .filter((id) => !exclude.includes(id))
            .flatMap((id) => {
              const hit = expectedHit(path, /** @type {number[]} */ (boxes.get(id)), ignoreTouching);
              return hit ? [{ id, ...hit }] : [];
            })
            .sort((a, b) => a.t - b.t || slotOf(a.id) - slotOf(b.id));
          const options = { exclude, ignoreTouching };
          const start = from.slice(0, dimensions);
          const all = isRay ? world.rayCastAll(start, direction, limit, undefined, options) : world.boxCastAll(from, direction, limit, undefined, options);
          const first = isRay ? world.rayCast(start, direction, limit, undefined, options) : world.boxCast(from, direction, limit, undefined, options);
          // -0 is 0.
          assert.deepEqual(all.map((hit) => ({ ...hit, t: hit.t + 0 })), expected, JSON.stringify({ path, boxes: [...boxes.values()], options }));
          assert.deepEqual(first, all[0]);
          for (const { normal, startsInside, t } of all) {
            faces.add(normal.join());
            if (startsInside) inside++;
            else if (t === 0) touching++;
          }
          if (ignoreTouching) ignored += world.boxCastAll(from, direction, limit, undefined, { exclude }).length - all.length;
        }
        world.free();
      }
      assert.ok(touching > 50 && inside > 50 && ignored > 50, `${touching} touch, ${inside} start inside, ${ignored} are ignored`);
      assert.equal(faces.size, 2 * dimensions + 1, "not every face was hit");
    });
  }
}

test("a character that stands on the floor: it slides, falls no further, and jumps", () => {
  const world = new BroadPhase({ dimensions: 2 });
  const floor = world.insert(0, 0, 10, 1);
  const wall = world.insert(8, 1, 9, 5);
  const hero = [2, 1, 3, 3];
  assert.deepEqual(world.boxCast(hero, [1, 0]), { id: floor, t: 0, normal: [0, 1], startsInside: false });
  assert.deepEqual(world.boxCast(hero, [1, 0], 100, undefined, { ignoreTouching: true }), { id: wall, t: 5, normal: [-1, 0], startsInside: false });
  assert.deepEqual(world.boxCast(hero, [0, -1], 100, undefined, { ignoreTouching: true }), { id: floor, t: 0, normal: [0, 1], startsInside: false });
  assert.equal(world.boxCast(hero, [0, 1], 100, undefined, { ignoreTouching: true }), undefined);
  assert.deepEqual(world.boxCast([2, 0.5, 3, 3], [1, 0]), { id: floor, t: 0, normal: [0, 0], startsInside: true });
  world.free();
});

test("every query leaves out what is excluded, one or many, and what is stale excludes nothing", () => {
  for (const views of [false, true]) {
    const world = new BroadPhase({ dimensions: 2, views });
    const ids = [...world.insertMany([0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1])];
    const [a = NaN, b = NaN, c = NaN, stale = NaN] = ids;
    world.remove(stale);
    world.insert(0, 0, 1, 1); // has the slot of the stale one
    const every = [...world.overlapping([0, 0, 1, 1])];
    /** @type {((options?: any) => Iterable<any>)[]} */
    const queries = [
      (options) => world.overlapping([0, 0, 1, 1], undefined, options),
      (options) => world.containing([0.5, 0.5], undefined, options),
      (options) => world.within([0.5, 0.5], 1, undefined, options),
      (options) => world.nearest([0.5, 0.5], 9, Infinity, undefined, options),
      (options) => world.nearest([0.5, 0.5], 9, Infinity, () => true, options),
      (options) => world.rayCastAll([-1, 0.5], [1, 0], 9, undefined, options),
      (options) => world.rayCastAll([-1, 0.5], [1, 0], 9, () => true, options),
      (options) => world.boxCastAll([-2, 0, -1, 1], [1, 0], 9, undefined, options),
    ];
    for (const query of queries) {
      const found = (/** @type {any} */ exclude) => [...query({ exclude })].map((hit) => hit.id ?? hit);
      const without = (/** @type {number[]} */ ...out) => every.filter((id) => !out.includes(id));
      assert.deepEqual(found(a), without(a), String(query));
      assert.deepEqual(found([a, c]), without(a, c));
      assert.deepEqual(found(Float64Array.of(b)), without(b));
      assert.deepEqual(found([stale, -1, 0.5, NaN]), every);
      assert.deepEqual(found([]), every);
      assert.deepEqual(found(undefined), every);
      assert.deepEqual(found(world.overlapping([0, 0, 1, 1])), [], "its own view");
      for (const odd of ["1", null, {}, [null], new Float32Array([a])]) assert.throws(() => found(odd), TypeError, String(query));
      assert.throws(() => query({ exclud: a }), /^TypeError: `options` has no `exclud`/);
    }
    assert.equal(world.rayCast([-1, 0.5], [1, 0], 9, undefined, { exclude: [a, b] })?.id, c);
    assert.equal(world.rayCast([-1, 0.5], [1, 0], 9, (id) => id !== b, { exclude: a })?.id, c);
    assert.throws(() => world.rayCast([-1, 0.5], [1, 0], 9, undefined, /** @type {any} */ ({ ignoreTouching: 1 })), /^TypeError: `ignoreTouching` must be true or false, not 1/);
    assert.throws(() => world.rayCast([-1, 0.5], [1, 0], 9, undefined, /** @type {any} */ ({ sorted: false })), /^TypeError: `options` has no `sorted`/);
    world.free();
  }
});
