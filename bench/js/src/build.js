// Builds the crate in ../scenes: as WebAssembly, and for this machine.
import { spawnSync } from "node:child_process";
import { existsSync } from "node:fs";
import { join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

/** The scenes as WebAssembly; `SCENES_WASM` names a file that is there already. */
export function buildWasm() {
  if (process.env.SCENES_WASM) return resolve(process.env.SCENES_WASM);
  const { target } = cargo("--lib", "--profile", "wasm", "--target", "wasm32-unknown-unknown");
  return join(target, "wasm32-unknown-unknown/wasm/sweep_and_prune_js_bench.wasm");
}

/** The native program, or nothing where there is no compiler for this machine. */
export function buildNative() {
  const { status, target } = cargo("--bin", "native", "--release");
  const program = join(target, "release/native");
  return status === 0 && existsSync(program) ? program : undefined;
}

/** Builds a part of the crate in ../scenes. */
function cargo(/** @type {string[]} */ ...args) {
  const root = fileURLToPath(new URL("../../..", import.meta.url));
  const target = resolve(root, process.env.CARGO_TARGET_DIR ?? "target");
  const { status } = spawnSync("cargo", ["build", "--quiet", "--package", "sweep-and-prune-js-bench", ...args], {
    cwd: root,
    stdio: ["ignore", "inherit", "inherit"],
  });
  return { status, target };
}
