import { chromium, expect, test } from "@playwright/test";
import config from "../playwright.config.ts";

// A page says in a sentence why it cannot play, and offers to try again.

/** What says so, by page. */
const PLACES = {
  "/": "hero-boxes .load-failure",
  "/falling.html": "#discs .load-failure",
  "/playground.html": "box-playground .load-failure",
} as const;

for (const [path, place] of Object.entries(PLACES)) {
  test(`${path} says that a file did not load, and tries again`, async ({ page }) => {
    await page.route(/\.wasm/, (route) => route.abort());
    await page.goto(path);
    await expect(page.locator(place)).toContainText("A file of this page did not load");
    await page.unroute(/\.wasm/);
    await page.locator(place).getByRole("button", { name: "Try again" }).click();
    await expect(page.locator(place)).toHaveCount(0);
    await expect(page.locator(place.replace(".load-failure", "[data-part=play]"))).toBeEnabled();
  });
}

test("without WebAssembly, each page says so", async ({ baseURL }) => {
  const { executablePath, args = [] } = config.use!.launchOptions!;
  const browser = await chromium.launch({ executablePath: executablePath!, args: [...args, "--js-flags=--jitless"] });
  try {
    const page = await browser.newPage();
    for (const [path, place] of Object.entries(PLACES)) {
      await page.goto(baseURL + path);
      await expect(page.locator(place), path).toContainText("needs WebAssembly");
      await expect(page.locator(place).getByRole("button", { name: "Try again" })).toBeVisible();
    }
  } finally {
    await browser.close();
  }
});
