// Whole steps of physics engines with their own broad phases and with this package, in Chromium:
//
//   node js/examples/measure/main.js [ENGINE...]
import { fileURLToPath } from "node:url";
import { startBrowser } from "../../test/support/browser.js";
import { serve } from "../../test/support/serve.js";

const { server, address } = await serve([fileURLToPath(new URL("page.js", import.meta.url))]);
const browser = await startBrowser();
try {
  const page = await browser.newPage();
  page.on("pageerror", (error) => console.error(String(error)));
  await page.goto(address);
  await page.waitForFunction("globalThis.ready");
  const wanted = process.argv.length > 2 ? process.argv.slice(2) : await page.evaluate("names");
  for (const engine of wanted) {
    for (const scene of await page.evaluate(`scenesOf(${JSON.stringify(engine)})`)) {
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
