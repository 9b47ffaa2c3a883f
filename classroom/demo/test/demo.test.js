// `<sap-demo>` of the packed package, in a page that has nothing but one script tag for it.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { once } from "node:events";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { extname, join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

const here = fileURLToPath(new URL("..", import.meta.url));
const project = mkdtempSync(join(tmpdir(), "sap-demo-"));
const types = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm", ".css": "text/css" };

/** @type {import("playwright-core").Browser} */
let browser;
/** @type {import("node:http").Server} */
let server;
let base = "";
/** What stands between the body's tags. */
let body = "";
/** Scripts come once this is fulfilled. */
let scripts = Promise.resolve();

before(async () => {
  const installed = join(project, "node_modules/sweep-and-prune-classroom");
  const packed = execFileSync("npm", ["pack", "--ignore-scripts", "--silent", "--pack-destination", project], { cwd: here, encoding: "utf8" });
  mkdirSync(installed, { recursive: true });
  execFileSync("tar", ["-xzf", join(project, packed.trim()), "-C", installed, "--strip-components=1"]);
  server = createServer((request, response) => {
    const path = new URL(request.url ?? "/", "http://localhost").pathname;
    const type = /** @type {Record<string, string>} */ (types)[extname(path) || ".html"] ?? "";
    const send = () => {
      try {
        response.writeHead(200, { "content-type": type }).end(path === "/" ? page() : readFileSync(join(installed, "dist", path)));
      } catch {
        response.writeHead(404).end();
      }
    };
    if (type.includes("javascript")) scripts.then(send);
    else send();
  }).listen(0, "127.0.0.1");
  await once(server, "listening");
  const address = /** @type {import("node:net").AddressInfo} */ (server.address());
  base = `http://127.0.0.1:${address.port}/`;
  browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-background-networking", "--disable-component-update"],
  });
});

after(async () => {
  await browser?.close();
  server?.close();
  rmSync(project, { recursive: true, force: true });
});

const page = () => `<!doctype html>
<html lang="en"><head><title>t</title><link rel="icon" href="data:,"><link rel="stylesheet" href="demo.css">
<script type="module" src="demo.js"></script></head><body>${body}</body></html>`;

/** Opens the page; what it complained of, and what it asked for. */
async function open() {
  const page = await browser.newPage();
  /** @type {string[]} */
  const complaints = [];
  /** @type {string[]} */
  const requests = [];
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
  page.on("request", (request) => requests.push(request.url()));
  return { page, complaints, requests };
}

test("one script tag, and it runs", async () => {
  body = '<sap-demo strategy="pairwise" balls="5" skip-interval="4" decorations="checks:#4c8:20"></sap-demo>';
  const { page, complaints, requests } = await open();
  await page.goto(base);
  await page.waitForFunction("document.querySelector('sap-demo').state?.tick > 3");
  const state = /** @type {any} */ (await page.evaluate("(d => (d.pause(), d.reset(), d.pause(), d.state))(document.querySelector('sap-demo'))"));
  assert.equal(state.hash.length, 16);
  assert.deepEqual(complaints, []);
  assert.ok(requests.length > 4);
  assert.deepEqual(requests.filter((url) => !url.startsWith(base) && !url.startsWith("data:")), []);
  await page.close();
});

test("nothing moves when the script comes, in any form", async () => {
  const forms = [
    "",
    "no-controls",
    "no-counters",
    "no-controls no-counters",
    "array",
    'decorations="checks,edges:array"',
    'heading="Five balls"',
    "predict",
    "strip",
    "static array swap-log",
    'variant="teleport"',
    'variant="one-to-n"',
    'strategy="swap" balls="20" array style="--sap-array-rows: 3"',
  ];
  body = forms.map((form) => `<sap-demo ${form} paused><p slot="caption" style="margin: 0">A caption</p></sap-demo>`).join("");
  const { page, complaints } = await open();
  for (const width of [1200, 390]) {
    await page.setViewportSize({ width, height: 800 });
    let release = () => {};
    scripts = new Promise((resolve) => (release = resolve));
    await page.goto(base, { waitUntil: "commit" });
    await page.waitForFunction("document.readyState === 'interactive' && document.styleSheets.length === 1");
    const heights = "[...document.querySelectorAll('sap-demo')].map((demo) => demo.getBoundingClientRect().height)";
    assert.equal(await page.evaluate("customElements.get('sap-demo')"), undefined, "not yet there");
    const before = /** @type {number[]} */ (await page.evaluate(heights));
    release();
    await page.evaluate("customElements.whenDefined('sap-demo').then(() => Promise.all([...document.querySelectorAll('sap-demo')].map(({ ready }) => ready)))");
    const then = /** @type {number[]} */ (await page.evaluate(heights));
    for (const [index, form] of forms.entries()) {
      assert.ok(Math.abs((then[index] ?? 0) - (before[index] ?? 0)) <= 1, `${form} at ${width}: ${before[index]} became ${then[index]}`);
    }
  }
  assert.deepEqual(complaints, []);
  await page.close();
});

test("its types need nothing but the package", () => {
  const typescript = join(createRequire(import.meta.url).resolve("typescript/package.json"), "..", "bin/tsc");
  writeFileSync(
    join(project, "typed.ts"),
    `import { type DemoState, readShared, SapDemo } from "sweep-and-prune-classroom/demo";
    const demo: SapDemo = document.createElement("sap-demo");
    demo.addEventListener("simulate", ({ detail }) => { const state: DemoState = detail; state.tests.toFixed(); });
    demo.addEventListener("sap-drag", (event) => event.detail.ball.toFixed());
    demo.balls = [[100, 100, 20]];
    const names: string[] = readShared(location.hash).map(([name]) => name);
    export { names, SapDemo };`,
  );
  writeFileSync(join(project, "package.json"), '{ "private": true, "type": "module" }');
  const options = ["--noEmit", "--strict", "--target", "es2022", "--lib", "es2022,dom,esnext.disposable", "--types", ""];
  execFileSync(process.execPath, [typescript, ...options, "--module", "esnext", "--moduleResolution", "bundler", "typed.ts"], {
    cwd: project,
    stdio: "pipe",
    encoding: "utf8",
  });
});

test("a program may answer later: the demo waits, goes back without asking again, and says what fails", async () => {
  body = '<sap-demo balls="3" skip-interval="2" decorations="checks" paused></sap-demo>';
  const { page, complaints } = await open();
  await page.goto(base);
  await page.evaluate("customElements.whenDefined('sap-demo').then(() => document.querySelector('sap-demo').ready)");
  const seen = /** @type {any} */ (
    await page.evaluate(`(async () => {
      const demo = document.querySelector("sap-demo");
      const asked = [];
      demo.program = () => new Promise((resolve) => asked.push(resolve));
      const waiting = [demo.state.tick, demo.state.tests];
      demo.step(); // Not before there is an answer.
      const stepped = demo.state.tick;
      const answer = () => (asked.at(-1)([{ kind: "test", a: 0, b: 1 }, { kind: "test", a: 1, b: 2 }]), demo.settled);
      await answer();
      const first = demo.state.tests;
      demo.step(); // The next detection, which has not been answered.
      const next = [demo.state.tick, asked.length];
      await answer();
      const shown = [demo.state.tests, demo.state.events];
      demo.step();
      const then = demo.state.tests;
      demo.back();
      demo.back();
      const back = [demo.state.tick, demo.state.tests, asked.length];
      demo.program = () => Promise.reject(new Error("it broke"));
      await demo.settled;
      await demo.updateComplete;
      return { waiting, stepped, first, next, shown, then, back, says: demo.shadowRoot.textContent };
    })()`)
  );
  assert.deepEqual(seen.waiting, [0, 0]);
  assert.equal(seen.stepped, 0);
  assert.equal(seen.first, 2);
  assert.deepEqual(seen.next, [3, 2]);
  assert.deepEqual(seen.shown, [1, 2]);
  assert.equal(seen.then, 2);
  assert.deepEqual(seen.back, [0, 2, 2]);
  assert.match(seen.says, /it broke/);
  assert.deepEqual(complaints, []);
  await page.close();
});
