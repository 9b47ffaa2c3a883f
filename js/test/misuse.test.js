// Every public call of every entry, with odd values in the place of each argument in turn: what it
// throws is a named error, or a TypeError or RangeError of this package, and a call that throws changes nothing.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { anyPair, countPairs, findPairs, findPairsBetween, forEachPair, init, PairFinder } from "sweep-and-prune";
import { BroadPhase, init as initWorlds, slotOf } from "sweep-and-prune/broad-phase";
import { checkError, misuse, odd } from "./support/misuse.js";

before(() => Promise.all([init(), initWorlds()]));

const rows = new Float32Array([0, 0, 2, 2, 5, 5, 6, 6, 2, 1, 3, 4]);
const options = /** @type {const} */ ({ dimensions: 2 });

test("finding pairs", () => {
  misuse("findPairs", findPairs, [rows, options]);
  misuse("findPairsBetween", findPairsBetween, [rows, rows, options]);
  misuse("countPairs", countPairs, [rows, options]);
  misuse("anyPair", anyPair, [rows, options]);
  misuse("forEachPair", forEachPair, [rows, options, () => true]);
  misuse("new PairFinder", (options) => new PairFinder(options).free(), [options]);
  const finder = /** @type {any} */ (new PairFinder(options));
  const calls = { find: [rows], findBetween: [rows, rows], count: [rows], countBetween: [rows, rows], forEach: [rows, () => {}], forEachBetween: [rows, rows, () => {}], findInto: [rows, new Uint32Array(9)], findBetweenInto: [rows, rows, new Uint32Array(9)], any: [rows], anyBetween: [rows, rows], chunks: [rows, rows] };
  for (const [name, good] of Object.entries(calls)) {
    misuse(name, (...args) => finder[name](...args), good);
    assert.deepEqual([...finder.find(rows)], [0, 2], `after ${name}`);
  }
  finder.free();
  for (const [name, good] of Object.entries(calls)) assert.throws(() => finder[name](...good), /^TypeError: this PairFinder was freed/);
});

for (const dimensions of /** @type {const} */ ([1, 2, 3])) {
  for (const precision of /** @type {const} */ (["single", "double"])) {
    test(`a world in ${precision} precision, ${dimensions}D`, () => {
      const box = new Array(2 * dimensions).fill(0);
      const point = new Array(dimensions).fill(0);
      const direction = point.with(0, 1);
      /** A world of three bodies, and each of its methods with valid arguments. */
      const start = () => {
        const world = /** @type {any} */ (new BroadPhase({ dimensions, precision }));
        const [a, b, c] = world.insertMany(new Float64Array(6 * dimensions));
        world.update();
        const calls = {
          ...{ insert: box, insertMany: [[...box, ...box], {}], set: [a, ...box], setMany: [[a, b], [...box, ...box]], setSwept: [a, box, box], teleport: [a, ...box], shift: [point] },
          ...{ remove: [c], removeMany: [[c]], clear: [], setFilter: [a, {}], filter: [a], setEnabled: [a, false], isEnabled: [a], excludePair: [a, b], includePair: [a, b], isExcluded: [a, b], pairsByBody: [], contains: [a], box: [a], reportedBox: [a], pairsOf: [a], buffers: [2] },
          ...{ update: [], pairs: [{}], ids: [], snapshot: [], stateHash: [], overlapping: [box, {}], containing: [point, {}] },
          ...{ within: [point, 1, {}], nearest: [point, 1, 5, {}, { exclude: 1 }], rayCast: [point, direction, 5, {}, { exclude: 1 }], rayCastAll: [point, direction, 5, {}, { ignoreTouching: true }] },
          ...{ boxes: [[a, b]], restore: [new BroadPhase({ dimensions, precision }).snapshot()], clone: [], setData: [a, 1], "insert ": [box, { data: 1, mask: 2 }], "insertMany ": [[box], {}, [1]] },
          ...{ overlappingMany: [[...box, ...box], {}, {}], containingMany: [[...point, ...point], {}, { exclude: 1 }], withinMany: [[point, point], [1, 1], {}, {}], nearestMany: [point, 1, 5, {}, {}] },
          ...{ rayCastMany: [point, direction, [5], {}, {}], boxCastMany: [box, [direction], 5, {}, {}] },
          ...{ boxCast: [box, direction, 5, {}, {}], boxCastAll: [box, direction, 5, {}, { exclude: [1] }] },
        };
        return { world, calls: /** @type {Record<string, unknown[]>} */ (calls) };
      };
      for (const name of Object.keys(start().calls)) {
        const width = start().calls[name]?.length ?? 0;
        for (let at = 0; at < width; at++) {
          for (const value of odd) {
            const { world, calls } = start();
            const before = world.stateHash();
            try {
              world[name.trim()](...(calls[name] ?? []).with(at, value));
            } catch (error) {
              checkError(name, error);
              assert.equal(world.stateHash(), before, `${name} threw, and changed the world`);
            }
            world.free();
          }
        }
        const { world, calls } = start();
        world.free();
        assert.throws(() => world[name.trim()](...(calls[name] ?? [])), /^TypeError: this BroadPhase was freed/, name);
      }
    });
  }
}

test("making a world, and a snapshot with any byte changed or its end cut off", () => {
  misuse("new BroadPhase", (options) => new BroadPhase(options).free(), [options]);
  for (const key of ["precision", "report", "margin", "prediction"]) {
    misuse(key, (value) => new BroadPhase({ dimensions: 2, [key]: value }).free(), [0]);
  }
  misuse("slotOf", slotOf, [0]);
  const world = new BroadPhase(options);
  world.insertMany(rows);
  world.update();
  const snapshot = world.snapshot();
  misuse("fromSnapshot", (bytes, options) => BroadPhase.fromSnapshot(bytes, options).free(), [snapshot, options]);
  for (let at = 0; at < snapshot.length; at++) {
    const changed = snapshot.with(at, /** @type {number} */ (snapshot[at]) ^ 1);
    for (const bytes of [changed, snapshot.slice(0, at)]) {
      assert.throws(() => BroadPhase.fromSnapshot(bytes, options), /^(SnapshotError|RangeError)/, String(at));
    }
  }
});
