"use client";

// What a user writes: imported on the server too, where it is rendered first; started in the page.
import { useEffect, useState } from "react";
import { findPairs, init } from "sweep-and-prune";
import { BroadPhase, init as initWorlds } from "sweep-and-prune/broad-phase";

async function run() {
  const [{ simd }] = await Promise.all([init(), initWorlds()]);
  const pairs = [...findPairs(new Float32Array([0, 0, 2, 2, 5, 5, 6, 6, 2, 1, 3, 4]), { dimensions: 2 })];
  const world = new BroadPhase({ dimensions: 1 });
  world.insertMany([0, 1, 1, 2]);
  return { simd, pairs, begun: world.update().begun.length };
}

export default function Client() {
  const [result, setResult] = useState();
  useEffect(() => {
    run().then(setResult, (error) => setResult(String(error?.stack ?? error)));
  }, []);
  useEffect(() => {
    if (result !== undefined) globalThis.result = result;
  }, [result]);
  return <p>{result === undefined ? "not yet" : "done"}</p>;
}
