// Draws docs/picture.png and docs/picture-dark.png for the READMEs: the falling spheres of the built site, in light and
// dark, with the figures that the page itself measures in this run. Build the site first (`npm run build`).
//
//   npm run pictures -w site [-- STEP]    STEP: the step of the simulation to draw (default 75)
//
// Chromium draws without a graphics card here, so the time of drawing says nothing about a visitor's machine: the
// picture leaves it out, and the view is small until the simulation pauses. The time of the search is that of this
// machine: run it while nothing else runs.
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "@playwright/test";
import { preview } from "vite";

const site = resolve(dirname(fileURLToPath(import.meta.url)), "..");
const docs = resolve(site, "../docs");
const lastStep = Number(process.argv[2] ?? 75);

/** Leaves the view and, below it, the time of the search and the number of pairs. */
const STYLE = `
  box-playground { padding: 0; margin: 0; max-width: none; }
  box-playground .panel { display: block; width: 44rem; padding: 1rem; background: var(--paper, Canvas); }
  box-playground .panel-stage { aspect-ratio: 16 / 10; }
  box-playground :is(.panel-transport, .panel-world, .panel-tools, .panel-lanes > :not(.lanes), .lane legend, .lane .field, .export) { display: none; }
  box-playground:not(.paused) .panel-stage { width: 4rem; }
  box-playground .lane dl { display: grid; grid-template-columns: 1fr 1fr; gap: 0 2.5rem; margin-top: 0.75rem; }
  box-playground .counter:not([data-counter=pairs], [data-counter=ms]) { display: none; }
  box-playground .counter { font-size: 1.0625rem; color: inherit; border: 0; }
`;

const server = await preview({ root: site, preview: { host: "127.0.0.1", port: 4300 }, logLevel: "error" });
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking"],
});
try {
  const page = await browser.newPage({ deviceScaleFactor: 2, viewport: { width: 1000, height: 700 } });
  await page.goto(new URL("playground.html?scene=falling+balls&dimensions=3&boxes=10000&algorithm=find+pairs", server.resolvedUrls.local[0]).href);
  await page.addStyleTag({ content: STYLE });
  const spheres = page.locator("box-playground");
  await spheres.scrollIntoViewIfNeeded();
  const moment = spheres.locator("[data-part=moment]");
  const step = async () => Number(/\d[\d,]*/.exec((await moment.textContent()) ?? "")?.[0].replaceAll(",", "") ?? 0);
  while ((await step()) < lastStep) await page.waitForTimeout(50);
  await spheres.locator("[data-part=play]").dispatchEvent("click");
  await spheres.evaluate((element) => element.classList.add("paused"));
  for (const [colorScheme, file] of [["light", "picture.png"], ["dark", "picture-dark.png"]]) {
    await page.emulateMedia({ colorScheme });
    await page.waitForTimeout(1500);
    await spheres.locator(".panel").screenshot({ path: join(docs, file) });
  }
  const figures = await spheres.locator(".counter:visible").evaluateAll((all) => all.map((row) => row.innerText.replace(/\s+/g, " ")));
  console.log(`step ${await step()}: ${figures.join("; ")}`);
} finally {
  await browser.close();
  await new Promise((done) => server.httpServer.close(done));
}
