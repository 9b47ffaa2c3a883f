// What a user writes: every entry that loads a file, in the page and in a module worker. Leaves its
// result in `globalThis.result`.
import { findPairs, init } from "sweep-and-prune";
import { BroadPhase } from "sweep-and-prune/broad-phase";
import { inEngines } from "./engines.js";

async function run() {
  const { simd } = await init();
  const pairs = [...findPairs(new Float32Array([0, 0, 2, 2, 5, 5, 6, 6, 2, 1, 3, 4]), { dimensions: 2 })];
  const world = new BroadPhase({ dimensions: 1 });
  world.insertMany([0, 1, 1, 2]);
  const begun = world.update().begun.length;
  const worker = new Worker(new URL("./worker.js", import.meta.url), { type: "module" });
  const inWorker = await new Promise((resolve, reject) => {
    worker.onmessage = ({ data }) => resolve(data);
    worker.onerror = ({ message }) => reject(new Error(message || "the worker did not start"));
  });
  return { simd, pairs, begun, inEngines: inEngines(BroadPhase), inWorker };
}

run().then(
  (result) => (globalThis.result = result),
  (error) => (globalThis.result = String(error?.stack ?? error)),
);
