// Hostile calls against a model: see support/hostile.js. HOSTILE_CALLS says how many.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { init, PairFinder } from "sweep-and-prune";
import { BroadPhase, init as initWorlds } from "sweep-and-prune/broad-phase";
import { HostileFinder, HostileWorld } from "./support/hostile.js";

const calls = Number(process.env["HOSTILE_CALLS"] ?? (process.env["TEST_LONG"] ? 1_000_000 : 60_000));
const seed = Number(process.env["HOSTILE_SEED"] ?? 1);

before(() => Promise.all([init(), initWorlds()]));

for (const [name, make] of /** @type {const} */ ([
  ["a world", (/** @type {number} */ seed) => new HostileWorld(seed, BroadPhase)],
  ["a finder", (/** @type {number} */ seed) => new HostileFinder(seed, PairFinder)],
])) {
  test(`${name} stays right under ${calls / 2} hostile calls`, (t) => {
    // A new one for every 20,000, each with a seed that leads to its fault alone.
    for (let [made, at] = [0, seed]; made < calls / 2; at++) {
      const hostile = make(at);
      try {
        while (hostile.calls < 20_000 && made + hostile.calls < calls / 2) hostile.step();
      } catch (/** @type {any} */ error) {
        throw new Error(`seed ${at}, after ${hostile.calls} calls: ${error.stack}`);
      }
      made += hostile.calls;
      if (hostile.deep > 0) t.diagnostic(`seed ${at}: ${hostile.deep} stack overflows`);
    }
    assert.ok(true);
  });
}
