// The shared scenes: WebAssembly computes the same boxes, bit for bit, as the native build that
// wrote the golden file, and this package finds the pairs that it names.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { findPairs, init } from "sweep-and-prune";
import { sorted } from "./support/boxes.js";

const root = fileURLToPath(new URL("../..", import.meta.url));
const golden = readFileSync(join(root, "scenes/golden.txt"), "utf8");

/** Name to bytes, as js/test/golden/ has them.
 *
 * @type {Map<string, ArrayBuffer>}
 */
const parts = new Map();

before(async () => {
  await init();
  const { CARGO_ENCODED_RUSTFLAGS: _, CARGO_TARGET_DIR, ...env } = process.env;
  const target = join(CARGO_TARGET_DIR ?? join(root, "target"), "wasm-golden");
  const profile = ["--profile", "wasm", "--target", "wasm32-unknown-unknown", "--target-dir", target];
  const { status } = spawnSync("cargo", ["build", "--quiet", "--package", "sweep-and-prune-golden", ...profile], {
    cwd: root,
    env: { ...env, RUSTFLAGS: "" },
    stdio: ["ignore", "inherit", "inherit"],
  });
  assert.equal(status, 0);
  const wasm = readFileSync(join(target, "wasm32-unknown-unknown/wasm/sweep_and_prune_golden.wasm"));
  const { instance } = await WebAssembly.instantiate(wasm);
  const { memory, count, name, name_length, bytes, bytes_length } = /** @type {any} */ (instance.exports);
  for (let part = 0; part < count(); part++) {
    const read = (/** @type {number} */ at, /** @type {number} */ length) => memory.buffer.slice(at, at + length);
    const title = new TextDecoder().decode(read(name(part), name_length(part)));
    parts.set(title, read(bytes(part), bytes_length(part)));
  }
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

/**
 * The 64-bit FNV-1a hash, in hexadecimal, as scenes/src/golden.rs has it.
 *
 * @param {Uint8Array} bytes
 */
function fnv1a(bytes) {
  let hash = 0xcbf29ce484222325n;
  for (const byte of bytes) hash = BigInt.asUintN(64, (hash ^ BigInt(byte)) * 0x100000001b3n);
  return hash.toString(16).padStart(16, "0");
}
