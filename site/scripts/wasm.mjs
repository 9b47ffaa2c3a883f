// Compiles the simulation to WebAssembly, with and without vector instructions, into
// src/generated/. Quick when nothing has changed.

import { spawnSync } from "node:child_process";
import { copyFileSync, mkdirSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const root = resolve(dirname(fileURLToPath(import.meta.url)), "../..");
const target = resolve(root, process.env.CARGO_TARGET_DIR ?? "target");
const output = join(root, "site/src/generated");
const crate = "sweep-and-prune-simulation-wasm";

/** Each build has a target folder of its own, or each would throw away the other's work. */
const builds = [
  { file: "simulation.wasm", folder: "wasm-scalar", flags: "" },
  { file: "simulation.simd.wasm", folder: "wasm-simd", flags: "-C target-feature=+simd128" },
];

mkdirSync(output, { recursive: true });
for (const { file, folder, flags } of builds) {
  const targetDir = join(target, folder);
  const { status } = spawnSync(
    "cargo",
    ["build", "--quiet", "--release", "--target", "wasm32-unknown-unknown", "--package", crate, "--target-dir", targetDir],
    { cwd: root, stdio: "inherit", env: { ...process.env, RUSTFLAGS: flags } },
  );
  if (status !== 0) process.exit(status ?? 1); // cargo has said why
  const built = join(targetDir, "wasm32-unknown-unknown/release", `${crate.replaceAll("-", "_")}.wasm`);
  copyFileSync(built, join(output, file));
}
