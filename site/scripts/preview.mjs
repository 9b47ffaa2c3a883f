// Draws public/preview.png, which is shown where someone links to the site: the question, the boxes of the built
// article's first picture, and the two counts. And public/still/, pictures of what moves, for where no scripts run.
// Build the site first (`npm run build`).
//
//   npm run preview-picture -w site
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "@playwright/test";
import { preview } from "vite";

const site = resolve(dirname(fileURLToPath(import.meta.url)), "..");

/** The picture as wide as the card, in the page's dark colors, with the words over its quiet left half. */
const STYLE = `
  body > *:not(main), .article-body, .article-head > *:not(.hero), .hero > *:not(.hero-stage), .hero-stage input { display: none !important; }
  html { scrollbar-gutter: auto !important; }
  .article { max-width: none !important; padding: 0 !important; }
  .article-head { padding: 0 !important; }
  .hero { margin: 0 !important; }
  .hero-stage canvas { height: 630px !important; border-radius: 0 !important; }
  .card { position: absolute; inset: 0; padding: 64px 72px; color: #fff; background: linear-gradient(100deg, #12161a 30%, #12161ae6 48%, #12161a00 82%); }
  .card h2 { margin: 0 0 34px; font: 500 84px/1.05 var(--serif); letter-spacing: -0.02em; }
  .card p { margin: 0 0 6px; font: 500 31px/1.35 var(--sans); color: #c9d1d6; }
  .card strong { color: #fff; font-variant-numeric: tabular-nums; }
  .card strong.few { color: #4fd695; }
  .card small { position: absolute; left: 72px; bottom: 58px; font: 500 25px/1 var(--sans); color: #a0a8b0; }
`;

const server = await preview({ root: site, preview: { host: "127.0.0.1", port: 4301 }, logLevel: "error" });
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
try {
  const page = await browser.newPage({ viewport: { width: 1200, height: 630 }, colorScheme: "dark", reducedMotion: "reduce", serviceWorkers: "block" });
  await page.goto(server.resolvedUrls.local[0]);
  await page.locator("hero-boxes[data-ready]").waitFor();
  await page.addStyleTag({ content: STYLE });
  await page.getByLabel("Sweep line", { exact: true }).evaluate((line) => {
    line.value = "700";
    line.dispatchEvent(new Event("input", { bubbles: true }));
  });
  await page.waitForTimeout(800);
  // The counts are those of the picture.
  const [tests, boxes] = await page.locator("hero-boxes").evaluate((hero) => [Number(hero.dataset.tests), hero.rows.length / 4]);
  const whole = (number) => number.toLocaleString("en");
  await page.locator(".hero-stage").evaluate((stage, html) => stage.insertAdjacentHTML("beforeend", html), `
    <div class="card">
      <h2>Which boxes<br>overlap?</h2>
      <p>Every pair: <strong>${whole((boxes * (boxes - 1)) / 2)}</strong> tests</p>
      <p>Sort and sweep: <strong class="few">${whole(tests)}</strong> tests</p>
      <small>Sweep and prune, explained with demos</small>
    </div>`);
  await page.screenshot({ path: join(site, "public/preview.png") });

  // Some steps into each world, as wide as it stands on a page.
  for (const [path, element, file, steps] of [
    ["index.html#falling", "#d20 box-playground", "discs", 24],
    ["playground.html", "box-playground", "playground", 2],
  ]) {
    await page.setViewportSize({ width: 1280, height: 900 });
    await page.emulateMedia({ colorScheme: "light", reducedMotion: "reduce" });
    await page.goto(new URL(path, server.resolvedUrls.local[0]).href);
    const world = page.locator(element);
    const picture = world.locator(".panel-stage");
    await picture.scrollIntoViewIfNeeded();
    const button = world.locator("[data-part=step]");
    for (let step = 0; step < steps; step++) {
      const before = await world.getAttribute("data-step");
      await button.click();
      await page.waitForFunction(([world, before]) => world.dataset.step !== before, [await world.elementHandle(), before]);
    }
    await page.waitForTimeout(1000);
    await picture.screenshot({ path: join(site, `public/still/${file}.jpg`), type: "jpeg", quality: 72 });
  }
} finally {
  await browser.close();
  await new Promise((done) => server.httpServer.close(done));
}
