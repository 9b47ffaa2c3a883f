// Whole steps of physics engines with their own broad phases and with this package, in Chromium:
//
//   node js/examples/measure/main.js [ENGINE...]
import { createServer } from "node:http";
import { once } from "node:events";
import { fileURLToPath } from "node:url";
import * as esbuild from "esbuild";
import { startBrowser } from "../../test/support/browser.js";

const alias = { "sweep-and-prune": "sweep-and-prune/inline", "sweep-and-prune/broad-phase": "sweep-and-prune/broad-phase/inline" };
const { outputFiles } = await esbuild.build({ entryPoints: [fileURLToPath(new URL("page.js", import.meta.url))], bundle: true, format: "esm", write: false, outdir: "/", alias, logLevel: "error" });
const server = createServer((request, response) => {
  const isPage = request.url === "/";
  // A page with shared memory has a finer clock.
  response.writeHead(200, { "content-type": isPage ? "text/html" : "text/javascript", "cross-origin-opener-policy": "same-origin", "cross-origin-embedder-policy": "require-corp" });
  response.end(isPage ? '<!doctype html><script type="module" src="/page.js"></script>' : outputFiles[0].contents);
}).listen(0, "127.0.0.1");
await once(server, "listening");
const browser = await startBrowser();
try {
  const page = await browser.newPage();
  page.on("pageerror", (error) => console.error(String(error)));
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  await page.waitForFunction("globalThis.ready");
  const wanted = process.argv.length > 2 ? process.argv.slice(2) : await page.evaluate("names");
  for (const engine of wanted) {
    for (const scene of ["gas", "pile"]) {
      for (const count of [200, 1_000, 5_000]) {
        const measured = await page.evaluate(`measure(${JSON.stringify(engine)}, "${scene}", ${count}, ${count === 5_000 ? 45 : 180})`);
        const last = measured.at(-1);
        const cells = measured.map(({ broadPhase, ms, contacts }) => `${broadPhase} ${ms.toFixed(2)} ms (${(ms / last.ms).toFixed(2)}), ${contacts} contacts`);
        console.log(`${engine}, ${scene}, ${count}: ${cells.join("; ")}`);
      }
    }
  }
} finally {
  await browser.close();
  server.close();
}
