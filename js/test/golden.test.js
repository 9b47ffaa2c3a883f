// The shared scenes: WebAssembly computes the same boxes, bit for bit, as the native build that
// wrote the golden file, and this package finds the pairs that it names.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { findPairs, init } from "sweep-and-prune";
import { sorted } from "./support/boxes.js";
import { compileScenes, fnv1a } from "./support/scenes.js";

const root = fileURLToPath(new URL("../..", import.meta.url));
const golden = readFileSync(join(root, "scenes/golden.txt"), "utf8");

/** @type {Map<string, ArrayBuffer>} */
let parts;

before(async () => {
  await init();
  parts = await compileScenes();
});

test("the report in WebAssembly is the golden file", () => {
  const report = new TextDecoder().decode(parts.get("report")).split("\n");
  assert.deepEqual(report, golden.split("\n"));
});

test("findPairs gives the pairs of every line", () => {
  const lines = golden.split("\n").filter((line) => line && !line.startsWith("#"));
  assert.equal(lines.length, parts.size - 1);
  for (const line of lines) {
    const [scene, space, type, , count, hash] = line.split(" ");
    const boxes = parts.get(`${scene} ${space} ${type}`);
    assert.ok(boxes, line);
    const rows = type === "f64" ? new Float64Array(boxes) : new Float32Array(boxes);
    const pairs = sorted(findPairs(rows, { dimensions: /** @type {1 | 2 | 3} */ (Number(space?.[0])) }));
    assert.equal(`${pairs.length} ${fnv1a(new Uint8Array(Uint32Array.from(pairs.flat()).buffer))}`, `${count} ${hash}`, line);
  }
});
