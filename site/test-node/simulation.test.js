// The balls that the site lets fall, compiled with vector instructions and without.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

test("vector instructions change nothing", async () => {
  const [scalar, vectored] = ["", ".simd"].map((suffix) => readFileSync(new URL(`../src/generated/simulation${suffix}.wasm`, import.meta.url)));
  assert.ok(!vectored.equals(scalar));
  const hashes = [];
  for (const bytes of [scalar, vectored]) {
    // A copy of the class for each module.
    const { Simulation } = await import(`../../classroom/simulation/wasm/simulation.js?copy=${hashes.length}`);
    await Simulation.load(bytes);
    const simulation = new Simulation({ bodies: 500, size: 0.3 });
    for (let step = 0; step < 60; step++) simulation.step();
    hashes.push(simulation.hash());
  }
  assert.equal(hashes[0], hashes[1]);
});
