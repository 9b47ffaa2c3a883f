// What a user of a bundler writes that does not copy the files which a module names.
import { findPairs, init } from "sweep-and-prune/inline";
import { BroadPhase } from "sweep-and-prune/broad-phase/inline";
import { inEngines } from "./engines.js";

async function run() {
  const { simd } = await init();
  const pairs = [...findPairs(new Float32Array([0, 0, 2, 2, 5, 5, 6, 6, 2, 1, 3, 4]), { dimensions: 2 })];
  const world = new BroadPhase({ dimensions: 1 });
  world.insertMany([0, 1, 1, 2]);
  return { simd, pairs, begun: world.update().begun.length, inEngines: inEngines(BroadPhase) };
}

run().then(
  (result) => (globalThis.result = result),
  (error) => (globalThis.result = String(error?.stack ?? error)),
);
