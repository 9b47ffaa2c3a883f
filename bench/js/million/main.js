// One million moving boxes in Chromium, in a worker: how many updates a second, and whether the
// page keeps its frames.
//
//     node bench/js/million/main.js [--boxes 1000000] [--seconds 10] [--dimensions 3] [--scene drift]
//
// The package must be built (npm run build -w js). CHROMIUM names the browser.
import { once } from "node:events";
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";
import { parseArgs } from "node:util";
import { chromium } from "playwright-core";
import { buildWasm } from "../src/build.js";
import { describe } from "../src/machine.js";
import { median } from "../src/record.js";

const { values: flags } = parseArgs({
  options: {
    boxes: { type: "string", default: "1000000" },
    seconds: { type: "string", default: "10" },
    dimensions: { type: "string", default: "3" },
    scene: { type: "string", default: "drift" },
  },
});

const here = fileURLToPath(new URL("..", import.meta.url));
const dist = fileURLToPath(new URL("../../../js/dist", import.meta.url));
const scenes = buildWasm();
const types = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm" };

const server = createServer((request, response) => {
  const path = normalize(new URL(request.url ?? "/", "http://localhost").pathname);
  const file = path === "/scenes.wasm" ? scenes : path.startsWith("/dist/") ? join(dist, path.slice(6)) : join(here, path);
  try {
    const content = readFileSync(file);
    response.setHeader("content-type", types[extname(file)] ?? "application/octet-stream");
    response.end(content);
  } catch {
    response.statusCode = 404;
    response.end();
  }
}).listen(0, "127.0.0.1");
await once(server, "listening");
const { port } = server.address();

const machine = describe();
console.log(`${machine.cpu}, ${machine.cores} cores, load ${machine.load}`);
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--disable-background-networking"],
});
try {
  for (const by of ["finder", "world"]) {
    const page = await browser.newPage();
    const question = new URLSearchParams({ scene: flags.scene, boxes: flags.boxes, dimensions: flags.dimensions, by });
    await page.goto(`http://127.0.0.1:${port}/million/page.html?${question}`);
    // The first updates compile and grow memory.
    await page.waitForFunction(() => window.record.failed || window.record.updates.length >= 3, null, { timeout: 120_000 });
    const failed = await page.evaluate(() => window.record.failed);
    if (failed) throw new Error(failed);
    await page.evaluate(() => Object.assign(window.record, { frames: [], updates: [] }));
    await page.waitForTimeout(1000 * Number(flags.seconds));
    const { frames, updates } = await page.evaluate(() => window.record);
    report(by, frames, updates);
    await page.close();
  }
} finally {
  await browser.close();
  server.close();
}

function report(by, frames, updates) {
  const span = (times) => (times.at(-1) - times[0]) / 1000;
  const rate = (times) => ((times.length - 1) / span(times)).toFixed(1);
  const gaps = frames.slice(1).map((time, at) => time - frames[at]);
  const of = (field) => `${median(updates.map((update) => update[field])).toFixed(0)} ms`;
  const what = by === "finder" ? "PairFinder" : "BroadPhase";
  const boxes = Number(flags.boxes).toLocaleString("en");
  console.log(
    `${flags.scene} ${flags.dimensions}D, ${boxes} boxes, ${what}: ${rate(updates.map(({ at }) => at))} updates a second ` +
      `(moving them ${of("moving")}, finding ${of("finding")}); page ${rate(frames)} frames a second, ` +
      `median gap ${median(gaps).toFixed(1)} ms, longest ${Math.max(...gaps).toFixed(0)} ms`,
  );
}
