// Every way to start, and what must not depend on it: the pairs and their order.
import assert from "node:assert/strict";
import { once } from "node:events";
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { test } from "node:test";
import { Worker } from "node:worker_threads";

const wasm = new URL("../dist/sweep-and-prune.wasm", import.meta.url);
const simdWasm = new URL("../dist/sweep-and-prune.simd.wasm", import.meta.url);

/**
 * Starts the package in a thread of its own.
 *
 * @param {string} entry
 * @param {object} [options]
 * @returns {Promise<{ simd: boolean, results: Uint32Array[] }>}
 */
async function startWith(entry, options) {
  const worker = new Worker(new URL("./support/start.js", import.meta.url), { workerData: { entry, options } });
  const [message] = await once(worker, "message");
  return message;
}

const expected = startWith("sweep-and-prune");

test("the vector build is chosen where the engine takes it", async () => {
  assert.equal((await expected).simd, true);
});

/** @type {[string, string, object, boolean][]} */
const ways = [
  ["the scalar build", "sweep-and-prune", { simd: false }, false],
  ["from the file beside the module", new URL("../dist/index.js", import.meta.url).href, {}, true],
  ["from the other file beside the module", new URL("../dist/index.js", import.meta.url).href, { simd: false }, false],
  ["inline", "sweep-and-prune/inline", {}, true],
  ["inline, the scalar build", "sweep-and-prune/inline", { simd: false }, false],
  ["from an address", "sweep-and-prune", { simd: false, wasm: wasm.href }, false],
  ["from bytes", "sweep-and-prune", { wasm: readFileSync(simdWasm) }, true],
  ["from an ArrayBuffer", "sweep-and-prune", { wasm: new Uint8Array(readFileSync(simdWasm)).buffer }, true],
  ["from a module", "sweep-and-prune", { wasm: new WebAssembly.Module(readFileSync(simdWasm)) }, true],
];
for (const [name, entry, options, simd] of ways) {
  test(`the same pairs in the same order: ${name}`, async () => {
    const started = await startWith(entry, options);
    assert.equal(started.simd, simd);
    assert.deepEqual(started.results, (await expected).results);
  });
}

test("over http, with the right content type and with a wrong one", async () => {
  const server = createServer((request, response) => {
    const type = request.url === "/right" ? "application/wasm" : "text/plain";
    response.writeHead(200, { "content-type": type }).end(readFileSync(simdWasm));
  }).listen(0, "127.0.0.1");
  await once(server, "listening");
  const { port } = /** @type {import("node:net").AddressInfo} */ (server.address());
  for (const path of ["right", "wrong"]) {
    const { results } = await startWith("sweep-and-prune", { wasm: `http://127.0.0.1:${port}/${path}` });
    assert.deepEqual(results, (await expected).results);
  }
  server.close();
});

test("started once; a failure can be tried again", async () => {
  const { init, findPairs } = await import("sweep-and-prune");
  const failing = init({ wasm: new URL("missing.wasm", import.meta.url) });
  assert.equal(init(), failing, "calls at the same time share a promise");
  await assert.rejects(failing, /ENOENT/);
  await assert.rejects(init({ wasm: new Uint8Array(8) }), WebAssembly.CompileError);
  const starting = init();
  assert.equal(init({ simd: false }), starting);
  const { simd } = await starting;
  assert.equal(init(), starting, "and so do later ones");
  assert.equal(simd, true);
  const inline = await import("sweep-and-prune/inline");
  assert.equal(inline.init(), starting, "the two entries are one package");
  assert.equal(inline.findPairs, findPairs);
});
