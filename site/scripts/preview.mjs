// Draws public/preview.png, which is shown where someone links to the site: the first picture of the built article.
// Build the site first (`npm run build`).
//
//   npm run preview-picture -w site
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "@playwright/test";
import { preview } from "vite";

const site = resolve(dirname(fileURLToPath(import.meta.url)), "..");

/** The title, the picture and the count of tests. */
const STYLE = `
  .site-header, .lede, .hero-switch, .hero-world, .hero-legend, .hero-stage input, .hero ~ * { display: none !important; }
  .article { max-width: none !important; padding: 0 56px !important; }
  .article-head { padding-top: 40px !important; }
  h1 { margin: 0 0 20px !important; font-size: 68px !important; }
  .hero { margin: 0 !important; }
  .hero-stage canvas { height: 370px !important; }
  .hero-panel { display: block !important; margin-top: 14px; }
  .hero-work { display: flex; align-items: baseline; gap: 1.5rem; font-size: 26px; }
  .hero-count, .hero-detail { font-size: 26px !important; white-space: nowrap; }
  .hero-count strong { font-size: 40px !important; }
  .hero-bar, .article-body { display: none !important; }
  .hero-detail { height: auto !important; }
`;

const server = await preview({ root: site, preview: { host: "127.0.0.1", port: 4301 }, logLevel: "error" });
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] });
try {
  const page = await browser.newPage({ viewport: { width: 1200, height: 630 }, reducedMotion: "reduce", serviceWorkers: "block" });
  await page.goto(server.resolvedUrls.local[0]);
  await page.locator("hero-boxes[data-ready]").waitFor();
  await page.addStyleTag({ content: STYLE });
  await page.getByLabel("Sweep line", { exact: true }).evaluate((line) => {
    line.value = "430";
    line.dispatchEvent(new Event("input", { bubbles: true }));
  });
  await page.waitForTimeout(500);
  await page.locator(".hero-detail").evaluate((detail) => (detail.textContent = detail.querySelector("[data-part=fewer]").textContent));
  await page.screenshot({ path: join(site, "public/preview.png") });
} finally {
  await browser.close();
  await new Promise((done) => server.httpServer.close(done));
}
