// Builds js/dist/: the compiled core twice, without and with vector instructions, the modules,
// their declarations. Fails if a build is not what its name says, or over its size budget.
import { spawnSync } from "node:child_process";
import { copyFileSync, mkdirSync, readdirSync, readFileSync, rmSync, statSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { build } from "esbuild";
import wabt from "wabt";

const here = fileURLToPath(new URL(".", import.meta.url));
const root = join(here, "..");
const dist = join(here, "dist");
const target = process.env.CARGO_TARGET_DIR ?? join(root, "target");

/** In bytes after gzip: what a page downloads before the first call. The goal for wasm is 40,000. */
const budgets = { wasm: 43_000, glue: 6_000 };

const cores = [
  { file: "sweep-and-prune.wasm", directory: "wasm-scalar", flags: "", simd: false },
  { file: "sweep-and-prune.simd.wasm", directory: "wasm-simd", flags: "-Ctarget-feature=+simd128", simd: true },
];

const started = Date.now();
mkdirSync(dist, { recursive: true });
const tools = await wabt();
for (const core of cores) {
  buildCore(core);
  checkCore(core);
}
await buildModules();
buildDeclarations();
for (const licence of ["LICENSE-MIT", "LICENSE-APACHE"]) copyFileSync(join(root, licence), join(dist, licence));
removeStale();

/** Compiles the core; each build has a target folder of its own, so that neither undoes the other. */
function buildCore({ file, directory, flags }) {
  const profile = ["--profile", "wasm", "--target", "wasm32-unknown-unknown"];
  const { CARGO_ENCODED_RUSTFLAGS: _, ...env } = process.env;
  run(
    "cargo",
    ["build", "--quiet", "--package", "sweep-and-prune-wasm", ...profile, "--target-dir", join(target, directory)],
    // For size: 45 KB instead of 70 after gzip, for which the search takes a tenth longer.
    { ...env, RUSTFLAGS: flags, CARGO_PROFILE_WASM_OPT_LEVEL: "s" },
  );
  const built = join(target, directory, "wasm32-unknown-unknown/wasm/sweep_and_prune_wasm.wasm");
  copyFileSync(built, join(dist, file));
}

/** Whether it has vector instructions if and only if it should, and keeps to its budget. */
function checkCore({ file, simd }) {
  const bytes = readFileSync(join(dist, file));
  const module = tools.readWasm(bytes, { readDebugNames: false });
  const text = module.toText({ foldExprs: false, inlineExport: false });
  module.destroy();
  // Not any vector instruction, which copying has too: those that compare coordinates.
  const vector = text.match(/^\s*(f32x4|f64x2)\.(le|ge|lt|gt)\b/gm)?.length ?? 0;
  if (simd !== vector > 0) throw new Error(`${file} has ${vector} vector comparisons`);
  report(file, [bytes], budgets.wasm, `, ${vector} vector comparisons`);
}

async function buildModules() {
  const { metafile } = await build({
    absWorkingDir: here,
    entryPoints: ["src/index.ts", "src/inline.ts"],
    outdir: "dist",
    bundle: true,
    splitting: true,
    format: "esm",
    platform: "neutral",
    target: "es2022",
    // Names stay, for stack traces that can be read.
    minifySyntax: true,
    minifyWhitespace: true,
    loader: { ".wasm": "binary" },
    metafile: true,
  });
  const glue = withImports(metafile.outputs, "dist/index.js");
  report("index.js", glue.map((path) => readFileSync(join(here, path))), budgets.glue, "");
}

/** An output and all that it imports. */
function withImports(outputs, path) {
  const imports = outputs[path].imports.filter(({ external }) => !external);
  return [path, ...imports.flatMap((imported) => withImports(outputs, imported.path))];
}

function buildDeclarations() {
  const typescript = join(createRequire(import.meta.url).resolve("typescript/package.json"), "..");
  run(process.execPath, [join(typescript, "bin/tsc"), "--project", here], process.env);
}

/** Runs a command that says itself what is wrong; then the build ends. */
function run(command, args, env) {
  const { status, error } = spawnSync(command, args, { cwd: root, stdio: "inherit", env });
  if (error) console.error(`cannot start ${command}: ${error.message}`);
  if (status !== 0) process.exit(status ?? 1);
}

/** Removes what an earlier build left and this one did not write. */
function removeStale() {
  for (const name of readdirSync(dist)) {
    const path = join(dist, name);
    if (statSync(path).mtimeMs < started - 1000) rmSync(path, { recursive: true });
  }
}

function report(name, parts, budget, more) {
  const size = parts.reduce((sum, bytes) => sum + bytes.length, 0);
  const zipped = parts.reduce((sum, bytes) => sum + gzipSync(bytes, { level: 9 }).length, 0);
  console.log(`${name}: ${size} bytes, ${zipped} after gzip${more}`);
  if (zipped > budget) throw new Error(`${name} is over its budget of ${budget} bytes after gzip`);
}
