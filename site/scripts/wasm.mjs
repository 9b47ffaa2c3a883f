// Compiles what the site runs beside the package to WebAssembly, with and without vector
// instructions, into src/generated/. Quick when nothing has changed.

import { spawnSync } from "node:child_process";
import { copyFileSync, mkdirSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { compile, SHORT_INDICES } from "../../scripts/npm-package.mjs";

const root = resolve(dirname(fileURLToPath(import.meta.url)), "../..");
const target = resolve(root, process.env.CARGO_TARGET_DIR ?? "target");
const output = join(root, "site/src/generated");

const crates = [
  { name: "simulation", package: "sweep-and-prune-simulation-wasm" },
  { name: "experiment", package: "sweep-and-prune-site-wasm" },
  { name: "bench-scenes", package: "sweep-and-prune-js-bench" },
];

/** Each build has a target folder of its own, or each would throw away the other's work. */
const builds = [
  { suffix: ".wasm", folder: "wasm-scalar", flags: SHORT_INDICES },
  { suffix: ".simd.wasm", folder: "wasm-simd", flags: `${SHORT_INDICES} -Ctarget-feature=+simd128` },
];

mkdirSync(output, { recursive: true });
for (const { suffix, folder, flags } of builds) {
  const targetDir = join(target, folder);
  const profile = ["--profile", "wasm", "--target", "wasm32-unknown-unknown", "--target-dir", targetDir];
  const packages = crates.flatMap((crate) => ["--package", crate.package]);
  const { status } = spawnSync("cargo", ["build", "--quiet", "--lib", ...profile, ...packages], {
    cwd: root,
    stdio: "inherit",
    env: { ...process.env, RUSTFLAGS: flags },
  });
  if (status !== 0) process.exit(status ?? 1); // cargo has said why
  for (const crate of crates) {
    const built = join(targetDir, "wasm32-unknown-unknown/wasm", `${crate.package.replaceAll("-", "_")}.wasm`);
    copyFileSync(built, join(output, crate.name + suffix));
  }
}

// The algorithms of the classroom with the broken variants, which only the site shows.
const algorithms = await compile("sweep-and-prune-site-broken", {
  directory: "wasm-scalar/broken",
  levels: { all: "s", core: "s", flags: [] },
});
writeFileSync(join(output, "algorithms.wasm"), algorithms);
