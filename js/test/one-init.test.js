// One `init()` starts every entry point that was imported. A file of its own: nothing may have started before.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { countPairs, init, NotInitializedError } from "sweep-and-prune";
import { BroadPhase, init as initWorlds } from "sweep-and-prune/broad-phase";
import { BroadPhase as Events, init as initEvents } from "sweep-and-prune/events-2d";

const lines = [0, 1, 1, 2];
const find = () => countPairs(lines, { dimensions: 1 });
const track = () => new BroadPhase({ dimensions: 1 }).size;
const report = () => new Events({ dimensions: 1 }).size;

test("with `wasm`, the core of this entry point starts and no other", async () => {
  await init({ wasm: readFileSync(new URL("../dist/sweep-and-prune.simd.wasm", import.meta.url)) });
  assert.equal(find(), 1);
  for (const call of [track, report]) assert.throws(call, NotInitializedError);
});

test("if another cannot start, the error comes out, and the next call tries again", async () => {
  const { instantiate } = WebAssembly;
  WebAssembly.instantiate = /** @type {any} */ (() => Promise.reject(new Error("refused")));
  await assert.rejects(initWorlds(), /refused/);
  WebAssembly.instantiate = instantiate;
  for (const call of [track, report]) assert.throws(call, NotInitializedError);
});

test("without, all start, whichever entry point it is of, and calls at the same time wait for all", async () => {
  const [first, second] = [init(), init()];
  assert.deepEqual(await second, { simd: true });
  assert.deepEqual([find(), track(), report()], [1, 0, 0]);
  assert.deepEqual(await first, { simd: true });
  assert.deepEqual([await initWorlds(), await initEvents()], [{ simd: true }, { simd: true }]);
});
