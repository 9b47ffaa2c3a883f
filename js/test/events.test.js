// The small entry points, for events only: what they have works as in `sweep-and-prune/broad-phase`.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { before, test } from "node:test";
import { gzipSync } from "node:zlib";
import { BroadPhase, InvalidBoxError, init, StaleProxyError } from "sweep-and-prune/broad-phase";
import { BroadPhase as Events2D } from "sweep-and-prune/events-2d";
import { BroadPhase as Events3D } from "sweep-and-prune/events-3d";
import { boxesSpread, random } from "./support/boxes.js";

before(() => init());

/** @type {[any, 1 | 2 | 3][]} */
const small = [[Events2D, 1], [Events2D, 2], [Events3D, 3]];

/** A result as arrays, whatever becomes of views. @param {any} result @returns {any} */
function plain(result) {
  if (ArrayBuffer.isView(result)) return [.../** @type {Float64Array} */ (result)];
  return result?.begun ? { begun: plain(result.begun), ended: plain(result.ended) } : result;
}

for (const [Events, dimensions] of small) {
  for (const options of [{}, { report: /** @type {const} */ ("fat"), margin: 0.01, prediction: 1 }, { views: true }]) {
    test(`${dimensions}D with ${JSON.stringify(options)}: the same ids and events, call for call`, () => {
      const next = random(dimensions);
      const worlds = [new Events({ dimensions, ...options }), new BroadPhase({ dimensions, ...options })];
      /** What both worlds return, which must be equal. @param {(world: any) => any} call */
      const both = (call) => {
        const [own, other] = worlds.map((world) => {
          try {
            return plain(call(world));
          } catch (error) {
            return [/** @type {any} */ (error).name, /** @type {any} */ (error).message];
          }
        });
        assert.deepEqual(own, other);
        return own;
      };
      const width = 2 * dimensions;
      const first = boxesSpread(next, 500, dimensions);
      /** @type {number[]} */
      const ids = both((world) => world.insertMany(first, { mask: ~2 }));
      let events = 0;
      for (let frame = 0; frame < 60; frame++) {
        const some = ids.filter(() => next() < 0.2);
        const rows = boxesSpread(next, some.length, dimensions);
        both((world) => world.setMany(some, rows));
        const [a = NaN, b = NaN] = some;
        const box = [...rows.subarray(0, width)];
        both((world) => world.set(a, ...box));
        if (frame % 4 === 1) both((world) => world.teleport(a, box));
        if (frame % 16 === 5) both((world) => world.shift(box.slice(0, dimensions)));
        both((world) => world.setSwept(b, box, [...rows.subarray(width, 2 * width)]));
        both((world) => world.setFilter(b, { category: 2 * (frame % 2), group: frame % 3 - 1 }));
        both((world) => world.setEnabled(ids[frame], frame % 3 > 0));
        const removed = frame % 5 === 0 ? ids.splice(0, 20) : [];
        both((world) => world.removeMany(removed));
        ids.push(both((world) => world.insert(...box)));
        for (const call of ["box", "reportedBox", "filter", "contains", "isEnabled"]) both((world) => world[call](a));
        both((world) => world.set(ids[0], ...box.toReversed())); // inverted
        both((world) => world.remove(7)); // stale
        const changes = both((world) => world.update());
        events += changes.begun.length + changes.ended.length;
        both((world) => world.size);
        both((world) => world.ids());
      }
      assert.ok(events > 1000, `${events} ids in events prove little`);
      both((world) => (world.clear(), world.update()));
      assert.throws(() => worlds[0]?.set(ids[0] ?? NaN, new Array(width).fill(0)), StaleProxyError);
      assert.throws(() => worlds[0]?.insertMany(new Array(width).fill(NaN)), InvalidBoxError);
      for (const world of worlds) world.free();
    });
  }
}

test("what they do not have is refused by name, or not there", () => {
  const wrong = [[Events2D, 3], [Events3D, 1], [Events3D, 2]];
  for (const [Events, dimensions] of /** @type {any} */ (wrong)) {
    assert.throws(() => new Events({ dimensions }), /^RangeError: "sweep-and-prune\/events-.d" has boxes of .* import `BroadPhase` from "sweep-and-prune\/broad-phase"/);
  }
  assert.throws(() => new Events2D(/** @type {any} */ ({ dimensions: 2, precision: "double" })), /in single precision only/);
  assert.throws(() => new Events2D(/** @type {any} */ ({ dimensions: 4 })), /^RangeError: `dimensions` must be 1, 2 or 3, not 4/);
  const world = /** @type {any} */ (new Events2D({ dimensions: 2 }));
  for (const name of ["pairs", "pairsOf", "overlapping", "rayCast", "nearest", "snapshot", "stateHash"]) assert.equal(world[name], undefined);
  assert.ok(!(world instanceof BroadPhase));
});

/** The bytes of a file after gzip. @param {string} path */
function zipped(path) {
  return gzipSync(readFileSync(new URL(`../dist/${path}`, import.meta.url)), { level: 9 }).length;
}

/** The bytes of a module and all that it imports after gzip. @param {string} path */
function zippedWithImports(path) {
  const found = new Set([path]);
  for (const at of found) {
    for (const [, name] of readFileSync(new URL(`../dist/${at}`, import.meta.url), "utf8").matchAll(/from"\.\/([^"]+)"/g)) if (name) found.add(name);
  }
  return [...found].reduce((sum, at) => sum + zipped(at), 0);
}

test("each takes at most 80 KB after gzip, JavaScript and WebAssembly", () => {
  for (const name of ["events-2d", "events-3d"]) {
    const script = zippedWithImports(`${name}.js`);
    assert.ok(script > zipped(`${name}.js`), "no import was found");
    for (const build of [".wasm", ".simd.wasm"]) assert.ok(script + zipped(name + build) <= 80_000, `${name}${build}: ${script} + ${zipped(name + build)}`);
  }
});

test("the sizes in the README are those of the files", () => {
  const readme = readFileSync(new URL("../README.md", import.meta.url), "utf8");
  const rows = [...readme.matchAll(/^\| `sweep-and-prune(?:\/(.+))?` \| (\d+) KB \| (\d+) KB \| (\d+) KB \|$/gm)];
  assert.equal(rows.length, 4);
  for (const [row, name, ...said] of rows) {
    const [core, script, inline] = name ? [name, name, `${name}-inline`] : ["sweep-and-prune", "index", "inline"];
    const sizes = [zipped(`${core}.simd.wasm`), zippedWithImports(`${script}.js`), zippedWithImports(`${inline}.js`)];
    // A few bytes more or less need no other table.
    sizes.forEach((size, at) => assert.ok(Math.abs(size / 1000 - Number(said[at])) <= 1, `${row}: ${size} bytes`));
  }
});
