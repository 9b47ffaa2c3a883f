// The shared scenes in WebAssembly: the boxes of each line of scenes/golden.txt.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

const root = fileURLToPath(new URL("../../..", import.meta.url));

/**
 * Name to bytes, as js/test/golden/ has them.
 *
 * @returns {Promise<Map<string, ArrayBuffer>>}
 */
export async function compileScenes() {
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
  const parts = new Map();
  for (let part = 0; part < count(); part++) {
    const read = (/** @type {number} */ at, /** @type {number} */ length) => memory.buffer.slice(at, at + length);
    const title = new TextDecoder().decode(read(name(part), name_length(part)));
    parts.set(title, read(bytes(part), bytes_length(part)));
  }
  return parts;
}

/**
 * The 64-bit FNV-1a hash, in hexadecimal, as scenes/src/golden.rs has it.
 *
 * @param {Uint8Array} bytes
 */
export function fnv1a(bytes) {
  let hash = 0xcbf29ce484222325n;
  for (const byte of bytes) hash = BigInt.asUintN(64, (hash ^ BigInt(byte)) * 0x100000001b3n);
  return hash.toString(16).padStart(16, "0");
}
