// What cannot be started. A file of its own: nothing may have started before.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { countPairs, init } from "sweep-and-prune";

const simdWasm = new URL("../dist/sweep-and-prune.simd.wasm", import.meta.url);

test("what is no core of this entry is refused by name, and a Response of it is taken", async () => {
  const others = {
    "a core of another entry": readFileSync(new URL("../dist/broad-phase.wasm", import.meta.url)),
    "an empty module": new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0]),
    "no module": new Uint8Array(8),
    "a number": 12,
    "an answer that is none": new Response("x", { status: 404 }),
  };
  for (const [name, other] of Object.entries(others)) {
    await assert.rejects(init({ wasm: /** @type {any} */ (other) }), /^(TypeError: (`wasm` is|WebAssembly)|LinkError|CompileError|Error: the server answers 404)/, name);
  }
  await init({ wasm: Promise.resolve(new Response(readFileSync(simdWasm), { headers: { "content-type": "application/wasm" } })), simd: true });
  assert.equal(countPairs([0, 1, 1, 2], { dimensions: 1 }), 1);
});
