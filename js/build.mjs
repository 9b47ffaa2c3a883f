// Builds js/dist/: the compiled core twice, without and with vector instructions, the modules,
// their declarations. Fails if a build is not what its name says, or over its size budget.
import { spawn } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, readdirSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { homedir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import binaryen from "binaryen";
import { build } from "esbuild";
import wabt from "wabt";

const here = fileURLToPath(new URL(".", import.meta.url));
const root = join(here, "..");
const dist = join(here, "dist");
const registry = join(process.env.CARGO_HOME ?? join(homedir(), ".cargo"), "registry");
const target = process.env.CARGO_TARGET_DIR ?? join(root, "target");

/**
 * How a crate is compiled: `all` of it, and `core`, what is compiled with the crate `sweep-and-prune`
 * itself rather than with the one that uses it, which are above all the finder's innermost loops.
 */
const small = { all: "s", core: "s", flags: [] };
/** The finder for size: 40 KB instead of 63, for at most 4 % of its speed (2026-11-22); its loops for speed take no more. */
const smallWithFastLoops = { all: "s", core: 3, flags: ["-Cllvm-args=-inline-threshold=15"] };
/** BroadPhase for speed: 151 KB instead of about 132, for up to a third less time. Inlining more makes it larger, not faster. */
const fast = { all: 3, core: 3, flags: ["-Cllvm-args=-inline-threshold=25"] };
/**
 * One type of box: as fast with less inlined, and 3 KB smaller. Binaryen takes 3 KB more and no time; it would make the
 * finder and the BroadPhase larger (10,000 bodies at rest, drifting and flying, 2026-11-23).
 */
const fastForOne = { all: 3, core: 3, flags: ["-Cllvm-args=-inline-threshold=20"], isOptimizedAgain: true };

/**
 * The cores, each a feature of js/wasm/, with budgets in bytes after gzip: what a page downloads
 * before the first call.
 */
const cores = [
  { name: "sweep-and-prune", feature: "finder", budget: 40 * 1024, levels: smallWithFastLoops },
  { name: "broad-phase", feature: "broad-phase", budget: 155_000, levels: fast },
  // For a game that needs nothing but events: one type of box.
  { name: "events-2d", feature: "events-2d", budget: 70_500, levels: fastForOne },
  { name: "events-3d", feature: "events-3d", budget: 70_500, levels: fastForOne },
  { name: "algorithms", feature: "algorithms", budget: 60_000, levels: small },
];

/** The entries, with budgets of what they import in all; of those that carry a core inside, none. */
const entries = [
  { name: "index", budget: 7_600 },
  { name: "inline" },
  { name: "broad-phase", budget: 11_000 },
  { name: "broad-phase-inline" },
  { name: "events-2d", budget: 9_000 },
  { name: "events-2d-inline" },
  { name: "events-3d", budget: 9_000 },
  { name: "events-3d-inline" },
  { name: "algorithms", budget: 8_500 },
  { name: "algorithms-inline" },
  // With Lit, which it draws its controls by.
  { name: "demo", budget: 46_000 },
];

/** Without and with vector instructions. */
const builds = [
  { suffix: ".wasm", directory: "wasm-scalar", flags: [], simd: false },
  { suffix: ".simd.wasm", directory: "wasm-simd", flags: ["-Ctarget-feature=+simd128"], simd: true },
];

/** Styles of elements without their comments and indentation. */
const leanStyles = {
  name: "lean styles",
  setup: ({ onLoad }) =>
    onLoad({ filter: /src.demo.(styles|comparison)\.ts$/ }, ({ path }) => ({
      contents: readFileSync(path, "utf8").replace(/css`[^`]*`/g, (css) => css.replace(/\/\*.*?\*\//gs, "").replace(/\s+/g, " ")),
      loader: "ts",
    })),
};

const started = Date.now();
mkdirSync(dist, { recursive: true });
const tools = await wabt();
const [scalar, vector] = builds;
// Two at a time: the compiler's last pass, over the whole program, takes one processor.
await Promise.all([
  buildCores(cores, scalar),
  // The algorithms have no vector instructions.
  buildCores(cores.filter(({ name }) => name !== "algorithms"), vector).then(buildSimulation),
]);
await buildModules();
await buildDeclarations();
copyFileSync(join(here, "src/demo/demo.css"), join(dist, "demo.css"));
for (const licence of ["LICENSE-MIT", "LICENSE-APACHE"]) copyFileSync(join(root, licence), join(dist, licence));
removeStale();

async function buildCores(cores, build) {
  for (const core of cores) {
    const compiled = await compileCore(core, build);
    const bytes = core.levels.isOptimizedAgain ? optimizeAgain(compiled, build.simd) : compiled;
    const path = join(dist, core.name + build.suffix);
    // What lies there has passed; reading instructions takes ten seconds, which no second start should.
    if (!existsSync(path) || !bytes.equals(readFileSync(path))) checkCore(core, build, bytes);
    report(core.name + build.suffix, [bytes], core.budget);
    writeFileSync(path, bytes);
  }
}

/** The balls of the demos. */
async function buildSimulation() {
  const crate = "sweep-and-prune-simulation-wasm";
  const bytes = await compile(crate, ["--package", crate], { directory: "wasm-demo", flags: [], levels: small });
  checkCore({ name: "simulation" }, { suffix: ".wasm", simd: false }, bytes);
  report("simulation.wasm", [bytes], 125_000);
  writeFileSync(join(dist, "simulation.wasm"), bytes);
}

/** Compiles the core; each build has a target folder of its own, so that neither undoes the other. */
function compileCore({ feature, levels }, { directory, flags }) {
  const crate = "sweep-and-prune-wasm";
  const what = ["--package", crate, "--no-default-features", "--features", feature];
  return compile(crate, what, { directory: join(directory, feature), flags, levels });
}

/** Optimizes compiled code with Binaryen, which allows it the instructions that Rust uses by default, and no others. */
function optimizeAgain(compiled, simd) {
  const module = binaryen.readBinary(compiled);
  const { BulkMemory, BulkMemoryOpt, MultiValue, MutableGlobals, NontrappingFPToInt, ReferenceTypes, SIMD128, SignExt } = binaryen.Features;
  module.setFeatures(
    BulkMemory | BulkMemoryOpt | MultiValue | MutableGlobals | NontrappingFPToInt | ReferenceTypes | SignExt | (simd ? SIMD128 : 0),
  );
  binaryen.setOptimizeLevel(3);
  binaryen.setShrinkLevel(0);
  module.optimize();
  const bytes = module.emitBinary();
  module.dispose();
  return Buffer.from(bytes);
}

/** Compiles a crate to WebAssembly, into a target folder of its own. */
async function compile(crate, what, { directory, flags, levels }) {
  const profile = ["--profile", "wasm", "--target", "wasm32-unknown-unknown"];
  // Paths of this machine do not belong in the package.
  const all = [...flags, ...levels.flags, `--remap-path-prefix=${registry}=registry`].join("\x1f");
  const inner = ["--config", `profile.wasm.package.sweep-and-prune.opt-level=${JSON.stringify(levels.core)}`];
  await run(
    "cargo",
    ["build", "--quiet", ...inner, ...what, ...profile, "--target-dir", join(target, directory)],
    { ...process.env, CARGO_ENCODED_RUSTFLAGS: all, CARGO_PROFILE_WASM_OPT_LEVEL: String(levels.all) },
  );
  return readFileSync(join(target, directory, `wasm32-unknown-unknown/wasm/${crate.replaceAll("-", "_")}.wasm`));
}

/** Whether it has vector instructions if and only if it should, and names nothing of this machine. */
function checkCore({ name }, { suffix, simd }, bytes) {
  const file = name + suffix;
  for (const path of [root, registry]) {
    if (bytes.includes(path)) throw new Error(`${file} names a folder of this machine, ${path}`);
  }
  const module = tools.readWasm(bytes, { readDebugNames: false });
  const text = module.toText({ foldExprs: false, inlineExport: false });
  module.destroy();
  // Not any vector instruction, which copying has too: those that compare coordinates.
  const vector = text.match(/^\s*(f32x4|f64x2)\.(le|ge|lt|gt)\b/gm)?.length ?? 0;
  if (simd !== vector > 0) throw new Error(`${file} has ${vector} vector comparisons`);
  console.log(`${file}: ${vector} vector comparisons`);
}

async function buildModules() {
  const { metafile } = await build({
    absWorkingDir: here,
    entryPoints: entries.map(({ name }) => `src/${name}.ts`),
    outdir: "dist",
    bundle: true,
    splitting: true,
    format: "esm",
    platform: "neutral",
    target: "es2022",
    // Names stay, for stack traces that can be read.
    minifySyntax: true,
    minifyWhitespace: true,
    loader: { ".wasm": "base64" },
    plugins: [leanStyles],
    metafile: true,
  });
  for (const { name, budget = Infinity } of entries) {
    const glue = [...withImports(metafile.outputs, `dist/${name}.js`)];
    report(`${name}.js`, glue.map((path) => readFileSync(join(here, path))), budget);
  }
}

/** An output and all that it imports. */
function withImports(outputs, path, found = new Set()) {
  found.add(path);
  for (const { external, path: imported } of outputs[path].imports) {
    if (!external && !found.has(imported)) withImports(outputs, imported, found);
  }
  return found;
}

async function buildDeclarations() {
  const typescript = join(createRequire(import.meta.url).resolve("typescript/package.json"), "..");
  await run(process.execPath, [join(typescript, "bin/tsc"), "--project", here], process.env);
}

/** Runs a command that says itself what is wrong; then the build ends. */
async function run(command, args, env) {
  const child = spawn(command, args, { cwd: root, stdio: "inherit", env });
  child.on("error", ({ message }) => console.error(`cannot start ${command}: ${message}`));
  const [status] = await new Promise((resolve) => child.on("close", (...ended) => resolve(ended)));
  if (status !== 0) process.exit(status > 0 ? status : 1);
}

/** Removes the files that an earlier build left and this one did not write. (Of a folder whose files
 * are written over, the time does not change.) */
function removeStale() {
  for (const name of readdirSync(dist, { recursive: true })) {
    const path = join(dist, name);
    const entry = statSync(path);
    if (entry.isFile() && entry.mtimeMs < started - 1000) rmSync(path);
  }
}

function report(name, parts, budget) {
  const size = parts.reduce((sum, bytes) => sum + bytes.length, 0);
  const zipped = parts.reduce((sum, bytes) => sum + gzipSync(bytes, { level: 9 }).length, 0);
  console.log(`${name}: ${size} bytes, ${zipped} after gzip`);
  if (zipped > budget) throw new Error(`${name} is over its budget of ${budget} bytes after gzip`);
}
