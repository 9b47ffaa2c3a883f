// What the builds of the npm packages share: compiled cores, modules, declarations, budgets.
import { spawn } from "node:child_process";
import { existsSync, mkdirSync, readdirSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { homedir } from "node:os";
import { basename, dirname, join, relative, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { deflateRawSync, gzipSync } from "node:zlib";
import { build } from "esbuild";
import { rolldown } from "rolldown";
import { dts } from "rolldown-plugin-dts";
import wabt from "wabt";
import { joined, textsOfCrates, textsOfModules } from "./licenses.mjs";

export const root = dirname(dirname(fileURLToPath(import.meta.url)));
const registry = join(process.env.CARGO_HOME ?? join(homedir(), ".cargo"), "registry");
const target = resolve(root, process.env.CARGO_TARGET_DIR ?? "target");
const tools = await wabt();
/** What the package that is built contains: names of crates, and paths of modules. */
const crates = new Set();
const modules = new Set();

/** A flag for the compiler: indices of functions as short as they can be, the same code, 4 % smaller, and 1 to 2 % after gzip. */
export const SHORT_INDICES = "-Clink-arg=--compress-relocations";

/** Starts the build of a package's `dist/`; call what it returns at the end, which removes what an earlier build left. */
export function begin(folder) {
  const dist = join(folder, "dist");
  const started = Date.now();
  mkdirSync(dist, { recursive: true });
  return () => {
    // Written, since on Windows a copy has the time of its source, and would be removed as left from an earlier build.
    for (const licence of ["LICENSE-MIT", "LICENSE-APACHE"]) writeFileSync(join(dist, licence), readFileSync(join(root, licence)));
    const wasm = ["--all-features", "--target=wasm32-unknown-unknown"];
    const ofCrates = [...crates].flatMap((crate) => textsOfCrates(join(root, "Cargo.toml"), `--package=${crate}`, ...wasm));
    const texts = [...ofCrates, ...textsOfModules([...modules])];
    if (texts.length > 0) writeFileSync(join(dist, "LICENSE-DEPENDENCIES"), joined(texts));
    // Of a folder whose files are written over, the time does not change.
    for (const name of readdirSync(dist, { recursive: true })) {
      const path = join(dist, name);
      const entry = statSync(path);
      if (entry.isFile() && entry.mtimeMs < started - 1000) rmSync(path);
    }
  };
}

/**
 * Compiles a crate to WebAssembly, and to nothing else, or it would not be optimized as one program; into a target folder of its own, so that no build undoes another. `levels.all` is the
 * optimization of `all` of it, and `levels.core` of what is compiled with the crate `sweep-and-prune` itself rather than with the
 * one that uses it, which are above all the finder's innermost loops.
 */
export async function compile(crate, { features = [], directory, flags = [], levels }) {
  crates.add(crate);
  const what = ["--package", crate, "--no-default-features", "--features", features.join()];
  const profile = ["--profile", "wasm", "--target", "wasm32-unknown-unknown"];
  // Paths of this machine do not belong in the package.
  const all = [...flags, ...levels.flags, SHORT_INDICES, `--remap-path-prefix=${registry}=registry`].join("\x1f");
  const inner = ["--config", `profile.wasm.package.sweep-and-prune.opt-level=${JSON.stringify(levels.core)}`];
  await run(
    "cargo",
    ["rustc", "--lib", "--crate-type", "cdylib", "--quiet", ...inner, ...what, ...profile, "--target-dir", join(target, directory)],
    { ...process.env, CARGO_ENCODED_RUSTFLAGS: all, CARGO_PROFILE_WASM_OPT_LEVEL: String(levels.all) },
  );
  return readFileSync(join(target, directory, `wasm32-unknown-unknown/wasm/${crate.replaceAll("-", "_")}.wasm`));
}

/** Writes a compiled core, if it is within its budget, has vector instructions exactly if `simd`, and names nothing of this machine. */
export function writeCore(path, bytes, { budget, simd }) {
  const file = basename(path);
  // What lies there has passed; reading instructions takes ten seconds, which no second start should.
  if (!existsSync(path) || !bytes.equals(readFileSync(path))) {
    for (const folder of [root, registry]) if (bytes.includes(folder)) throw new Error(`${file} names a folder of this machine, ${folder}`);
    const module = tools.readWasm(bytes, { readDebugNames: false });
    const text = module.toText({ foldExprs: false, inlineExport: false });
    module.destroy();
    // Not any vector instruction, which copying has too: those that compare coordinates.
    const vector = text.match(/^\s*(f32x4|f64x2)\.(le|ge|lt|gt)\b/gm)?.length ?? 0;
    if (simd !== vector > 0) throw new Error(`${file} has ${vector} vector comparisons`);
    console.log(`${file}: ${vector} vector comparisons`);
  }
  report(file, [bytes], budget);
  writeFileSync(path, bytes);
}

/**
 * Bundles the entries `{ name, source, budget }` of a package; a `source` that begins with `inline:` has its compiled cores inside.
 * A budget is for an entry and all that it imports. With `hasMaps`, source maps with the sources lie beside.
 */
export async function buildModules(folder, entries, { plugins = [], hasShortNames = false, hasMaps = false } = {}) {
  const { metafile } = await build({
    absWorkingDir: folder,
    entryPoints: Object.fromEntries(entries.map(({ name, source }) => [name, source])),
    outdir: "dist",
    bundle: true,
    splitting: true,
    format: "esm",
    platform: "neutral",
    target: "es2022",
    // Names stay, for stack traces that can be read, unless a package asks for short ones.
    minifyIdentifiers: hasShortNames,
    minifySyntax: true,
    minifyWhitespace: true,
    sourcemap: hasMaps && "linked",
    plugins: [inlined(folder), ...plugins],
    metafile: true,
  });
  for (const path of Object.keys(metafile.inputs)) modules.add(`${folder}/${path}`);
  for (const path of Object.keys(metafile.outputs).filter((path) => path.endsWith(".map"))) leaveOutCores(join(folder, path));
  for (const { name, budget = Infinity } of entries) {
    const glue = [...withImports(metafile.outputs, `dist/${name}.js`)];
    report(`${name}.js`, glue.map((path) => readFileSync(join(folder, path))), budget);
  }
}

/**
 * Writes a module for `require` beside each of these, which gives what it has: Node and bundlers load an ES module there, but a
 * compiler that reads `module: node16` wants to see CommonJS. So there is one copy of the code.
 */
export function writeForRequire(folder, names) {
  for (const name of names) writeFileSync(join(folder, "dist", `${name}.cjs`), `"use strict";\nmodule.exports = require("./${name}.js");\n`);
}

/** Takes the compiled cores out of the sources in a source map, and paths of this machine. */
function leaveOutCores(path) {
  const map = JSON.parse(readFileSync(path, "utf8"));
  map.sourcesContent = map.sourcesContent.map((source) => source.replace(/bytesOf\("[^"]{1000,}"\)/g, 'bytesOf("...")'));
  map.sources = map.sources.map((source) => (source.startsWith("inline:") ? relative(dirname(path), source.slice("inline:".length)) : source));
  writeFileSync(path, JSON.stringify(map));
}

/** Makes the inline form of an entry: the same module, with each compiled core, deflated, in place of its address. */
const inlined = (folder) => ({
  name: "inlined",
  setup({ onLoad, onResolve }) {
    onResolve({ filter: /^inline:/ }, ({ path }) => ({ path: join(folder, path.slice("inline:".length)), namespace: "inline" }));
    onLoad({ filter: /./, namespace: "inline" }, ({ path }) => {
      // Relative, for the source map.
      const imported = `import { bytesOf } from ${JSON.stringify(relative(dirname(path), join(root, "js/src/wasm/inlined.ts")))};\n`;
      const source = readFileSync(path, "utf8");
      const code = source.replace(/new URL\("(\.\/[^"]*\.wasm)", import\.meta\.url\)/g, (_, file) => {
        const deflated = deflateRawSync(readFileSync(join(folder, "dist", file)), { level: 9 });
        return `bytesOf("${deflated.toString("base64")}")`;
      });
      if (code === source) throw new Error(`${path} names no compiled core as new URL("./NAME.wasm", import.meta.url)`);
      return { contents: imported + code, loader: "ts", resolveDir: dirname(path) };
    });
  },
});

/** An output and all that it imports. */
function withImports(outputs, path, found = new Set()) {
  found.add(path);
  for (const { external, path: imported } of outputs[path].imports) {
    if (!external && !found.has(imported)) withImports(outputs, imported, found);
  }
  return found;
}

/**
 * Writes the declarations of the entries `{ name, source }`: of their public API alone. With `isForRequire`, also for those of
 * {@link writeForRequire}.
 */
export async function buildDeclarations(folder, entries, { isForRequire = false } = {}) {
  const typescript = join(createRequire(join(folder, "package.json")).resolve("typescript/package.json"), "..");
  const all = join(target, "declarations", relative(root, folder));
  await run(process.execPath, [join(typescript, "bin/tsc"), "--project", folder, "--outDir", all, "--rootDir", root, "--stripInternal"], process.env);
  const emitted = ({ source }) => join(all, relative(root, join(folder, source))).replace(/\.ts$/, ".d.ts");
  const bundle = await rolldown({
    input: Object.fromEntries(entries.map((entry) => [entry.name, emitted(entry)])),
    plugins: [dts({ dtsInput: true, tsconfig: false })],
    experimental: { attachDebugInfo: "none" }, // no comments with paths
  });
  const { output } = await bundle.write({ dir: join(folder, "dist"), format: "es", chunkFileNames: "shared-[name].d.ts", banner: '/// <reference lib="esnext.disposable" preserve="true" />' });
  for (const { fileName, code } of isForRequire ? output : []) {
    writeFileSync(join(folder, "dist", fileName.replace(/\.d\.ts$/, ".d.cts")), code.replace(/(from "\.\/[\w-]+)\.js"/g, '$1.cjs"'));
  }
}

/** Runs a command that says itself what is wrong; then the build ends. */
async function run(command, args, env) {
  const child = spawn(command, args, { cwd: root, stdio: "inherit", env });
  child.on("error", ({ message }) => console.error(`cannot start ${command}: ${message}`));
  const [status] = await new Promise((resolve) => child.on("close", (...ended) => resolve(ended)));
  if (status !== 0) process.exit(status > 0 ? status : 1);
}

function report(name, parts, budget) {
  const size = parts.reduce((sum, bytes) => sum + bytes.length, 0);
  const zipped = parts.reduce((sum, bytes) => sum + gzipSync(bytes, { level: 9 }).length, 0);
  console.log(`${name}: ${size} bytes, ${zipped} after gzip`);
  if (zipped > budget) throw new Error(`${name} is over its budget of ${budget} bytes after gzip`);
}
