// The packed package in Deno, in Bun, and in a Next app: in a server component and in the page.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { once } from "node:events";
import { existsSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:net";
import { join } from "node:path";
import { before, test } from "node:test";
import { setTimeout } from "node:timers/promises";
import { fileURLToPath } from "node:url";
import { resultOf, startBrowser } from "./support/browser.js";
import { installInto } from "./support/packed.js";

/** A project of its own, which holds a Next app. */
const project = fileURLToPath(new URL("runtimes", import.meta.url));
const modules = join(project, "node_modules");

before(() => {
  const wanted = readFileSync(join(project, "package.json"), "utf8");
  const marker = join(modules, ".installed");
  if (!existsSync(marker) || readFileSync(marker, "utf8") !== wanted) {
    // Without a lock: it would have to name the binaries of every platform.
    const options = ["--no-package-lock", "--no-audit", "--no-fund", "--loglevel=error"];
    execFileSync("npm", ["install", ...options], { cwd: project, stdio: "inherit" });
    writeFileSync(marker, wanted);
  }
  rmSync(join(modules, "sweep-and-prune"), { recursive: true, force: true });
  installInto(project);
});

const use = `
  import { countPairs, init } from "sweep-and-prune";
  import { BroadPhase, init as initWorlds } from "sweep-and-prune/broad-phase";
  const [{ simd }] = await Promise.all([init(), initWorlds()]);
  console.log(simd, countPairs([0, 1, 1, 2], { dimensions: 1 }), new BroadPhase({ dimensions: 2 }).size);`;

for (const [runtime, ...args] of /** @type {const} */ ([["deno", "run", "--allow-read", "--node-modules-dir=manual"], ["bun"]])) {
  test(runtime, () => {
    writeFileSync(join(project, "use.mjs"), use);
    const printed = execFileSync(join(modules, ".bin", runtime), [...args, "use.mjs"], { cwd: project, encoding: "utf8" });
    assert.equal(printed.trim(), "true 1 0");
  });
}

test("Next: on the server, in its edge runtime, and in the page", async () => {
  const next = join(modules, "next/dist/bin/next");
  rmSync(join(project, ".next"), { recursive: true, force: true });
  const env = { ...process.env, NEXT_TELEMETRY_DISABLED: "1", NODE_ENV: /** @type {const} */ ("production") };
  execFileSync(process.execPath, [next, "build"], { cwd: project, env, stdio: "pipe" });
  const port = await freePort();
  const server = spawn(process.execPath, [next, "start", "-H", "127.0.0.1", "-p", String(port)], { cwd: project, env, stdio: "ignore" });
  const browser = await startBrowser();
  try {
    const address = `http://127.0.0.1:${port}/`;
    assert.match(await textOf(address), /<p id="server">1<!-- --> pair on the server<\/p>/);
    assert.equal(await textOf(`${address}edge`), '{"pairs":1}');
    assert.deepEqual(await resultOf(browser, address), { simd: true, pairs: [0, 2], begun: 2 });
  } finally {
    await browser.close();
    server.kill();
  }
});

/**
 * The text at an address, once its server answers.
 *
 * @param {string} address
 */
async function textOf(address) {
  for (const end = Date.now() + 600_000; ; await setTimeout(100)) {
    try {
      return await (await fetch(address)).text();
    } catch (error) {
      if (Date.now() > end) throw error;
    }
  }
}

/** A port without a server. */
async function freePort() {
  const server = createServer().listen(0, "127.0.0.1");
  await once(server, "listening");
  const { port } = /** @type {import("node:net").AddressInfo} */ (server.address());
  await new Promise((resolve) => server.close(resolve));
  return port;
}
