// The packed package, installed as users install it, in the tools that they use, with no
// configuration; what comes out runs in Chromium.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { once } from "node:events";
import { cpSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { dirname, extname, join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { nodeResolve } from "@rollup/plugin-node-resolve";
import * as esbuild from "esbuild";
import { rollup } from "rollup";
import * as vite from "vite";
import webpack from "webpack";
import { resultOf, startBrowser } from "./support/browser.js";
import { installInto } from "./support/packed.js";

const here = fileURLToPath(new URL("..", import.meta.url));
/** A project with nothing in it but the package. */
const project = mkdtempSync(join(tmpdir(), "sweep-and-prune-"));
const installed = join(project, "node_modules/sweep-and-prune");

/** @type {import("playwright-core").Browser} */
let browser;

before(async () => {
  installInto(project);
  cpSync(join(here, "test/support/consumer"), project, { recursive: true });
  writeFileSync(join(project, "package.json"), '{ "private": true, "type": "module" }');
  browser = await startBrowser();
});

after(async () => {
  await browser?.close();
  rmSync(project, { recursive: true, force: true });
});

const expected = { simd: true, pairs: [0, 2], begun: 2, inEngines: [1, 1], inWorker: 45 };
const expectedInline = { simd: true, pairs: [0, 2], begun: 2, inEngines: [1, 1] };

/** The entries for engines, which have no core of their own. */
const engines = ["cannon-es", "excalibur", "matter-js", "phaser", "pixi", "three"];

const types = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm" };

/**
 * The result of a folder's index.html over http.
 *
 * @param {string} folder
 */
async function resultOfFolder(folder) {
  const server = createServer((request, response) => {
    const path = new URL(request.url ?? "/", "http://localhost").pathname;
    try {
      const bytes = readFileSync(join(folder, path === "/" ? "index.html" : path));
      const type = /** @type {Record<string, string>} */ (types)[extname(path) || ".html"];
      // As strict a policy as WebAssembly can live with.
      const policy = "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'";
      const headers = { "content-type": type ?? "application/octet-stream", "content-security-policy": policy };
      response.writeHead(200, headers).end(bytes);
    } catch {
      response.writeHead(404).end();
    }
  }).listen(0, "127.0.0.1");
  await once(server, "listening");
  const { port } = /** @type {import("node:net").AddressInfo} */ (server.address());
  try {
    return await resultOf(browser, `http://127.0.0.1:${port}/`);
  } finally {
    server.close();
  }
}

/**
 * A page that runs a script.
 *
 * @param {string} folder
 * @param {string} script
 * @param {string} [head]
 */
function writePage(folder, script, head = "") {
  mkdirSync(folder, { recursive: true });
  writeFileSync(
    join(folder, "index.html"),
    `<!doctype html><html><head><title>t</title>${head}</head><body><script type="module" src="${script}"></script></body></html>`,
  );
}

test("no bundler: a plain script, and a module worker", async () => {
  const folder = join(project, "plain");
  const base = "./node_modules/sweep-and-prune/dist";
  mkdirSync(folder);
  cpSync(join(project, "node_modules"), join(folder, "node_modules"), { recursive: true });
  /** @type {Record<string, string>} */
  const entries = { "sweep-and-prune/broad-phase": "broad-phase", "sweep-and-prune": "index" };
  for (const engine of engines) entries[`sweep-and-prune/${engine}`] = engine;
  for (const name of ["app.js", "engines.js", "worker.js"]) {
    let code = readFileSync(join(project, name), "utf8");
    for (const [entry, file] of Object.entries(entries)) code = code.replaceAll(`"${entry}"`, `"${base}/${file}.js"`);
    writeFileSync(join(folder, name), code);
  }
  writePage(folder, "./app.js");
  assert.deepEqual(await resultOfFolder(folder), expected);
});

test("each module has a source map with its sources, without the compiled cores", () => {
  const dist = join(installed, "dist");
  const modules = readdirSync(dist).filter((name) => name.endsWith(".js"));
  const seen = new Set();
  for (const name of modules) {
    const [, file] = /\n\/\/# sourceMappingURL=(.*)\n$/.exec(readFileSync(join(dist, name), "utf8")) ?? [];
    assert.equal(file, `${name}.map`);
    const text = readFileSync(join(dist, `${name}.map`), "utf8");
    assert.ok(text.length < 150_000, `${name}.map has a core in it`);
    assert.ok(!text.includes(dirname(here)), `${name}.map has a path of this machine`);
    const { sources, sourcesContent, mappings } = JSON.parse(text);
    assert.ok(mappings.length > 0 && sources.length === sourcesContent.length);
    for (const [at, source] of sources.entries()) {
      seen.add(source);
      assert.match(source, /^\.\.\//, "a path of another machine");
      // The inline form of an entry is not its source, but what the build makes of it.
      if (source.startsWith("../src") && !name.includes("inline")) assert.equal(sourcesContent[at], readFileSync(join(here, "dist", source), "utf8"));
    }
  }
  assert.ok(seen.has("../src/world/broad-phase.ts") && seen.has("../src/pairs/pair-finder.ts"));
});

test("Vite, built", async () => {
  const root = join(project, "vite");
  viteProject(root);
  await vite.build({ root, configFile: false, logLevel: "error", base: "./" });
  assert.deepEqual(await resultOfFolder(join(root, "dist")), expected);
});

test("Vite, in development", async () => {
  const root = join(project, "vite-dev");
  viteProject(root);
  const server = await vite.createServer({ root, configFile: false, logLevel: "error", server: { port: 0, host: "127.0.0.1" } });
  try {
    await server.listen();
    const address = server.resolvedUrls?.local[0];
    assert.ok(address);
    assert.deepEqual(await resultOf(browser, address), expected);
  } finally {
    await server.close();
  }
});

/** @param {string} root */
function viteProject(root) {
  writePage(root, "./app.js");
  for (const name of ["app.js", "engines.js", "worker.js", "package.json"]) cpSync(join(project, name), join(root, name));
  cpSync(installed, join(root, "node_modules/sweep-and-prune"), { recursive: true });
}

test("webpack", async () => {
  const folder = join(project, "webpack");
  writePage(folder, "./main.js");
  const stats = await new Promise((resolve, reject) =>
    webpack(
      { mode: "production", context: project, entry: "./app.js", output: { path: folder } },
      (error, stats) => (error ? reject(error) : resolve(stats)),
    ),
  );
  assert.equal(stats.hasErrors(), false, stats.toString());
  assert.deepEqual(await resultOfFolder(folder), expected);
});

test("esbuild, the inline entries", async () => {
  const folder = join(project, "esbuild");
  writePage(folder, "./inline.js");
  await esbuild.build({ absWorkingDir: project, entryPoints: ["inline.js"], bundle: true, format: "esm", outdir: folder });
  assert.deepEqual(await resultOfFolder(folder), expectedInline);
});

test("Rollup, the inline entries", async () => {
  const folder = join(project, "rollup");
  writePage(folder, "./inline.js");
  const bundle = await rollup({ input: join(project, "inline.js"), plugins: [nodeResolve()] });
  await bundle.write({ dir: folder, format: "es" });
  await bundle.close();
  assert.deepEqual(await resultOfFolder(folder), expectedInline);
});

test("esbuild, the entry whose file it does not copy: the error says what to do", async () => {
  const folder = join(project, "esbuild-default");
  writePage(folder, "./default.js");
  await esbuild.build({ absWorkingDir: project, entryPoints: { default: "app.js" }, bundle: true, format: "esm", outdir: folder });
  assert.match(await resultOfFolder(folder), /sweep-and-prune cannot start: .* answers 404 .*\/inline/);
});

test("esbuild and Rollup for Node: no file is needed beside the bundle", async () => {
  const code = `
    import { countPairs, init } from "sweep-and-prune";
    import { BroadPhase, init as initWorlds } from "sweep-and-prune/broad-phase";
    await Promise.all([init(), initWorlds()]);
    console.log(countPairs([0, 1, 1, 2], { dimensions: 1 }), new BroadPhase({ dimensions: 2 }).size);`;
  writeFileSync(join(project, "on-a-server.js"), code);
  const by = {
    esbuild: (/** @type {string} */ file) =>
      esbuild.build({ absWorkingDir: project, entryPoints: ["on-a-server.js"], bundle: true, platform: "node", format: "esm", outfile: file }),
    rollup: async (/** @type {string} */ file) => {
      const plugins = [nodeResolve({ exportConditions: ["node"] })];
      const bundle = await rollup({ input: join(project, "on-a-server.js"), plugins });
      await bundle.write({ file, format: "es" });
      await bundle.close();
    },
  };
  for (const [name, build] of Object.entries(by)) {
    const file = join(project, "server", `${name}.mjs`);
    await build(file);
    assert.equal(execFileSync(process.execPath, [file], { encoding: "utf8" }).trim(), "1 0", name);
  }
});

test("Node, and importing it on a server does nothing", () => {
  const code = `
    const before = Object.keys(globalThis).length;
    globalThis.fetch = globalThis.WebAssembly.instantiate = () => { throw new Error("touched") };
    const instantiate = WebAssembly.compile;
    WebAssembly.compile = () => { throw new Error("touched") };
    const entries = ["", "/broad-phase", "/events-2d", "/events-3d"].flatMap((entry) => [entry, entry + "/inline"]);
    const files = ["index", "broad-phase", "events-2d", "events-3d"]; // of the entries that are others in Node
    const loaded = [];
    for (const entry of entries) loaded.push(typeof (await import("sweep-and-prune" + entry)).init);
    for (const file of files) loaded.push(typeof (await import("./node_modules/sweep-and-prune/dist/" + file + ".js")).init);
    for (const engine of ${JSON.stringify(engines)}) await import("sweep-and-prune/" + engine);
    console.log(loaded.every((type) => type === "function"), Object.keys(globalThis).length === before);`;
  const run = (/** @type {string} */ code) =>
    execFileSync(process.execPath, ["--input-type=module", "--eval", code], { cwd: project, encoding: "utf8" }).trim();
  assert.equal(run(code), "true true");
  const use = `
    import { countPairs, init } from "sweep-and-prune";
    await init();
    console.log(countPairs([0, 1, 1, 2], { dimensions: 1 }));`;
  assert.equal(run(use), "1");
});

test("TypeScript, as bundlers and as Node resolve", () => {
  const typescript = join(createRequire(import.meta.url).resolve("typescript/package.json"), "..", "bin/tsc");
  for (const [module, resolution] of [["esnext", "bundler"], ["nodenext", "nodenext"]]) {
    const options = ["--noEmit", "--strict", "--target", "es2022", "--lib", "es2022,dom,esnext.disposable", "--types", ""];
    const how = ["--module", module ?? "", "--moduleResolution", resolution ?? ""];
    execFileSync(process.execPath, [typescript, ...options, ...how, "typed.ts"], { cwd: project, stdio: "pipe", encoding: "utf8" });
  }
});

test("the package holds what it should and nothing else", () => {
  const listed = execFileSync("npm", ["pack", "--dry-run", "--ignore-scripts", "--json"], { cwd: here, encoding: "utf8" });
  const files = /** @type {{ path: string }[]} */ (JSON.parse(listed)[0].files).map(({ path }) => path);
  for (const file of ["package.json", "README.md", "dist/index.js", "dist/index.d.ts", "dist/sweep-and-prune.simd.wasm", "dist/LICENSE-MIT", "docs/games.md"]) {
    assert.ok(files.includes(file), file);
  }
  const odd = files.filter((path) => !/^(package\.json|README\.md|dist\/[\w.-]+\.(js|cjs|js\.map|d\.ts|d\.cts|wasm)|dist\/LICENSE-\w+|docs\/[\w-]+\.md|docs\/picture\.svg)$/.test(path));
  assert.deepEqual(odd, []);
  assert.deepEqual(files.filter((path) => /demo|simulation|algorithms|runner|player/.test(path)), [], "what teaches is in a package of its own");
  const { unpackedSize } = JSON.parse(listed)[0];
  assert.ok(unpackedSize <= 4_900_000, `${unpackedSize} bytes unpacked`);
});

test("the declarations are those of the public API", () => {
  const entries = ["index", "broad-phase", "events-2d", "events-3d", ...engines];
  const declared = readdirSync(join(installed, "dist")).filter((name) => name.endsWith(".d.ts"));
  assert.deepEqual(declared.filter((name) => !name.startsWith("shared-")).sort(), entries.map((name) => `${name}.d.ts`).sort());
  /** @type {Set<string>} */
  const exported = new Set();
  for (const name of entries) for (const [, names] of readFileSync(join(installed, "dist", `${name}.d.ts`), "utf8").matchAll(/^export \{([^}]*)\};?$/gm)) for (const one of (names ?? "").split(",")) exported.add(one.replace("type ", "").trim());
  for (const file of declared) {
    const text = readFileSync(join(installed, "dist", file), "utf8");
    assert.doesNotMatch(text, /@internal|WorldMemory|Engine|Handle</, file);
    // Whatever is declared can be imported by its name, apart from what only gives another its shape.
    for (const [, name] of text.matchAll(/^(?:export )?declare (?:abstract )?(?:class|function|const) (\w+)/gm)) assert.ok(exported.has(name ?? ""), `${file} declares ${name}`);
  }
});
