// The npm package in the tools that js/test/consumers.test.js does not have, each in its newest version and without
// configuration: built from the packed package, and run. Slow, because they are installed first: only with
// TEST_PACKAGES=1, which `./test --long` sets.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { once } from "node:events";
import { cpSync, existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { dirname, extname, join } from "node:path";
import { after, before, describe, test } from "node:test";
import { fileURLToPath } from "node:url";

const root = dirname(dirname(fileURLToPath(import.meta.url)));
const skip = !process.env.TEST_PACKAGES && "only with TEST_PACKAGES=1";
const consumer = join(root, "js/test/support/consumer");

/** What is installed beside the package, under its name. */
const tools = ["parcel@2", "@rspack/core@2", "@rspack/cli@2", "vite@8", "vitest@5", "esbuild", "rollup@4", "@rollup/plugin-node-resolve"];
// The oldest TypeScript that the types promise to work with, and the newest.
tools.push("publint", "@arethetypeswrong/cli", "typescript-oldest@npm:typescript@5.7", "typescript-newest@npm:typescript@latest");

describe("The packed package in", { skip }, () => {
  let project, browser, resultOf;

  before(async () => {
    // Not above, where a clone without node_modules could not load it.
    const { resultOf: read, startBrowser } = await import("../js/test/support/browser.js");
    const { installInto } = await import("../js/test/support/packed.js");
    resultOf = read;
    project = process.env.TEST_PROJECT ?? mkdtempSync(join(tmpdir(), "sweep-and-prune-bundlers-"));
    mkdirSync(project, { recursive: true });
    if (!existsSync(join(project, "node_modules"))) {
      writeFileSync(join(project, "package.json"), '{ "private": true, "type": "module" }');
      run("npm", "install", "--silent", "--no-audit", "--no-fund", ...tools);
    }
    rmSync(join(project, "node_modules/sweep-and-prune"), { recursive: true, force: true });
    installInto(project);
    cpSync(consumer, project, { recursive: true });
    browser = await startBrowser();
  });

  after(async () => {
    await browser?.close();
    if (!process.env.TEST_PROJECT && project) rmSync(project, { recursive: true, force: true });
  });

  /** Runs a command in the project and returns what it printed. */
  function run(command, ...options) {
    const { status, stdout, stderr, error } = spawnSync(command, options, { cwd: project, encoding: "utf8" });
    assert.equal(status, 0, `${command}: ${error ?? ""}\n${stdout}\n${stderr}`);
    return stdout.trim();
  }

  const tool = (name, ...options) => run(join(project, "node_modules/.bin", name), ...options);

  /** A folder of the project with a page, whose script is `script`. */
  function page(name, script, type = "module", policy = "") {
    const folder = join(project, name);
    rmSync(folder, { recursive: true, force: true });
    mkdirSync(folder);
    writeFileSync(
      join(folder, "index.html"),
      `<!doctype html><html><head><title>t</title>${policy}</head><body><script type="${type}" src="${script}"></script></body></html>`,
    );
    return folder;
  }

  /** What the page of a folder leaves in `globalThis.result`. */
  async function shown(folder) {
    const server = await serve(folder);
    try {
      return await resultOf(browser, server.address);
    } finally {
      server.close();
    }
  }

  const expected = { simd: true, pairs: [0, 2], begun: 2, inEngines: [1, 1], inWorker: 45 };
  const expectedInline = { simd: true, pairs: [0, 2], begun: 2, inEngines: [1, 1] };

  test("Parcel", async () => {
    const folder = page("parcel", "./app.js");
    for (const name of ["app.js", "engines.js", "worker.js"]) cpSync(join(consumer, name), join(folder, name));
    tool("parcel", "build", join(folder, "index.html"), "--dist-dir", join(folder, "dist"), "--no-cache");
    assert.deepEqual(await shown(join(folder, "dist")), expected);
  });

  test("Rspack", async () => {
    const folder = page("rspack", "./main.js");
    tool("rspack", "build", "--mode", "production", "--entry", "./app.js", "--output-path", folder);
    assert.deepEqual(await shown(folder), expected);
  });

  test("Vite, whose workers are plain scripts by default", async () => {
    const folder = page("vite", "./app.js");
    for (const name of ["app.js", "engines.js", "worker.js"]) cpSync(join(consumer, name), join(folder, name));
    tool("vite", "build", folder, "--base", "./", "--logLevel", "error");
    assert.deepEqual(await shown(join(folder, "dist")), expected);
  });

  for (const [name, bundle] of [
    ["esbuild", (from, to) => tool("esbuild", from, "--bundle", "--format=iife", `--outfile=${to}`, "--log-level=error")],
    ["rollup", (from, to) => tool("rollup", from, "--plugin", "node-resolve", "--format", "iife", "--name", "app", "--file", to, "--silent")],
  ]) {
    test(`${name}, as a plain script: the inline entries run, the others say what to do`, async () => {
      const inline = page(`${name}-inline`, "./bundle.js", "text/javascript");
      bundle("inline.js", join(inline, "bundle.js"));
      assert.deepEqual(await shown(inline), expectedInline);
      const folder = page(`${name}-default`, "./bundle.js", "text/javascript");
      writeFileSync(
        join(project, "find.js"),
        'import { init } from "sweep-and-prune";\ninit().then(() => (globalThis.result = "started"), (error) => (globalThis.result = String(error)));',
      );
      bundle("find.js", join(folder, "bundle.js"));
      assert.match(await shown(folder), /sweep-and-prune cannot start: .*import the entry that ends in \/inline/);
    });
  }

  test("a page without a bundler, from another origin, as from a CDN", async () => {
    const cdn = await serve(join(project, "node_modules/sweep-and-prune"), { "access-control-allow-origin": "*" });
    const readme = readFileSync(join(root, "js/README.md"), "utf8");
    const [, code] = /```html\n<script type="module">\n(.*?)<\/script>\n```/s.exec(readme) ?? [];
    assert.ok(code, "the README has no line for a CDN");
    const host = /https:\/\/cdn\.[a-z.]+\/npm\/sweep-and-prune@[\d.]+\//;
    assert.match(code, host);
    const folder = page("cdn", "./app.js");
    writeFileSync(join(folder, "app.js"), code.replace(host, cdn.address).replace(/console\.log\((.*)\);.*/, "globalThis.result = $1;"));
    try {
      assert.equal(await shown(folder), "0,2");
    } finally {
      cdn.close();
    }
  });

  test("Vitest", () => {
    writeFileSync(
      join(project, "pairs.test.js"),
      `import { expect, test } from "vitest";
       import { findPairs, init } from "sweep-and-prune";
       import { BroadPhase } from "sweep-and-prune/broad-phase";
       test("finds a pair", async () => {
         await init();
         expect([...findPairs(new Float32Array([0, 1, 1, 2]), { dimensions: 1 })]).toEqual([0, 1]);
         expect(new BroadPhase({ dimensions: 2 }).size).toBe(0);
       });`,
    );
    tool("vitest", "run", "pairs.test.js");
  });

  test("Node, by require", () => {
    writeFileSync(
      join(project, "use.cjs"),
      `const { countPairs, init } = require("sweep-and-prune");
       const { BroadPhase } = require("sweep-and-prune/broad-phase");
       const { insertObjects } = require("sweep-and-prune/pixi");
       init().then(() => console.log(countPairs([0, 1, 1, 2], { dimensions: 1 }), insertObjects(new BroadPhase({ dimensions: 2 }), []).length));`,
    );
    assert.equal(run(process.execPath, "--no-warnings", "use.cjs"), "1 0");
  });

  for (const version of ["oldest", "newest"]) {
    test(`TypeScript, the ${version}, without the types of the browser and of Node`, () => {
      const ways = { nodenext: "nodenext", esnext: "bundler", ...(version === "oldest" && { es2022: "node10" }) };
      for (const [module, moduleResolution] of Object.entries(ways)) {
        const lib = ["es2022", "esnext.disposable"];
        const compilerOptions = { noEmit: true, strict: true, target: "es2022", lib, types: [], module, moduleResolution };
        writeFileSync(join(project, "tsconfig.json"), JSON.stringify({ compilerOptions, files: ["typed.ts"] }));
        run(process.execPath, join(project, `node_modules/typescript-${version}/bin/tsc`));
      }
    });
  }

  for (const version of ["oldest", "newest"]) {
    test(`CommonJS in TypeScript, the ${version}, with module: node16`, () => {
      writeFileSync(
        join(project, "required.cts"),
        `import { countPairs, init } from "sweep-and-prune";
         import { BroadPhase } from "sweep-and-prune/broad-phase";
         import { BroadPhase as Events } from "sweep-and-prune/events-2d/inline";
         import { replaceBroadPhase } from "sweep-and-prune/cannon-es";
         init().then(() => console.log(countPairs([0, 1, 1, 2], { dimensions: 1 }), new BroadPhase({ dimensions: 2 }).size));
         // @ts-expect-error the types are read
         new Events({ dimensions: 3 });
         // @ts-expect-error these too
         replaceBroadPhase([]);`,
      );
      const compilerOptions = { noEmit: true, strict: true, target: "es2022", lib: ["es2022", "esnext.disposable", "dom"], types: [], module: "node16" };
      writeFileSync(join(project, "tsconfig.json"), JSON.stringify({ compilerOptions, files: ["required.cts"] }));
      run(process.execPath, join(project, `node_modules/typescript-${version}/bin/tsc`));
    });
  }

  test("publint and attw have no finding", () => {
    const installed = join(project, "node_modules/sweep-and-prune");
    tool("publint", "run", installed, "--level", "warning", "--strict");
    const [packed] = JSON.parse(run("npm", "pack", installed, "--ignore-scripts", "--json"));
    // Files that are no modules have no types.
    const files = Object.keys(JSON.parse(readFileSync(join(installed, "package.json"), "utf8")).exports).filter((name) => /\.(wasm|json)$/.test(name));
    tool("attw", packed.filename, "--exclude-entrypoints", ...files);
  });

  test("what the README links to is in the package", () => {
    const installed = join(project, "node_modules/sweep-and-prune");
    const links = [...readFileSync(join(installed, "README.md"), "utf8").matchAll(/\]\((docs\/[^)#]+)/g)].map(([, link]) => link);
    assert.ok(links.length >= 5);
    for (const link of links) assert.ok(existsSync(join(installed, link)), link);
    const { exports } = JSON.parse(readFileSync(join(installed, "package.json"), "utf8"));
    const files = readdirSync(join(installed, "dist")).filter((name) => name.endsWith(".wasm"));
    for (const name of files) assert.equal(exports[`./${name}`], `./dist/${name}`, "not exported");
    const all = (target) => (typeof target === "string" ? [target] : Object.values(target).flatMap(all));
    for (const target of all(exports)) {
      assert.ok(existsSync(join(installed, target)), target);
    }
  });
});

/** Serves a folder, and tells its address. */
async function serve(folder, headers = {}) {
  const types = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm" };
  const server = createServer((request, response) => {
    const path = new URL(request.url ?? "/", "http://localhost").pathname;
    try {
      const bytes = readFileSync(join(folder, path === "/" ? "index.html" : path));
      const type = types[extname(path) || ".html"] ?? "application/octet-stream";
      response.writeHead(200, { "content-type": type, ...headers }).end(bytes);
    } catch {
      response.writeHead(404).end();
    }
  }).listen(0, "127.0.0.1");
  await once(server, "listening");
  return { address: `http://127.0.0.1:${server.address().port}/`, close: () => server.close() };
}
