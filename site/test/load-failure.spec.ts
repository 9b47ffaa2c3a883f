import { chromium, expect, test } from "@playwright/test";
import config from "../playwright.config.ts";

// A page says in a sentence why it cannot play, and offers to try again.

/** What says so, by page. */
const PLACES = {
  "/": "hero-boxes .load-failure",
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

test.describe("with a service worker", () => {
  test.use({ serviceWorkers: "allow" });

  test("a page of an older build, whose files are no longer there, is not loaded again", async ({ page }) => {
    await page.goto("/playground.html");
    await expect(page.locator("html")).toHaveAttribute("data-stored", "");
    await expect(page.locator("box-playground")).toHaveAttribute("data-step", /./);
    // The next visit has this file no more.
    const file = await page.evaluate(async () => {
      const [name] = await caches.keys();
      const cache = await caches.open(name!);
      const url = (await cache.keys()).map(({ url }) => url).find((url) => /\/experiment[^/]*\.wasm/.test(url))!;
      await cache.put(url, new Response("", { status: 404 }));
      return url;
    });
    await page.goto("/playground.html");
    await expect(page.locator(PLACES["/playground.html"])).toContainText("A file of this page did not load", { timeout: 20_000 });
    await page.getByRole("button", { name: "Try again" }).click();
    await expect(page.locator("box-playground"), file).toHaveAttribute("data-step", /./);
  });
});

test("a demo that did not load says so without advice for its makers, and comes when it is tried again", async ({ page }) => {
  await page.route(/simulation[^/]*\.wasm/, (route) => route.abort());
  await page.goto("/#d2");
  const demo = page.locator("#d2 sap-demo");
  await expect(demo.getByRole("alert")).toHaveText("This demo did not load. Is there a connection?");
  await page.unroute(/simulation[^/]*\.wasm/);
  await demo.getByRole("button", { name: "Try again" }).click();
  await expect(demo.getByRole("alert")).toHaveCount(0);
  await expect(demo.getByRole("button", { name: "Step", exact: true })).toBeEnabled();
});

test("where the script of the demos does not load, each demo says so", async ({ page }) => {
  await page.route(/\/demos-[^/]*\.js/, (route) => route.abort());
  await page.goto("/#d2");
  await expect(page.locator("#d2 .load-failure")).toContainText("A file of this page did not load");
  await expect(page.locator("#d2").getByRole("button", { name: "Try again" })).toBeVisible();
});

test("where the editor does not load, the button says so and can be pressed again", async ({ page }) => {
  for (const [path, name] of [["/#d14", "Edit"], ["/tasks.html", "Try it"]] as const) {
    await page.route(/\/(editing|editor)-[^/]*\.js/, (route) => route.abort());
    await page.goto(path);
    const button = page.getByRole("button", { name, exact: true }).first();
    await button.scrollIntoViewIfNeeded();
    await button.click();
    await expect(page.locator(".load-failure").first()).toContainText("A file of this page did not load");
    await expect(button).toBeEnabled();
  }
});

test("where the library does not load, the trial says so", async ({ page }) => {
  await page.route(/sweep-and-prune[^/]*\.wasm/, (route) => route.abort());
  await page.goto("/");
  await page.locator("library-trial").scrollIntoViewIfNeeded();
  await page.getByRole("button", { name: "Find pairs" }).click();
  await expect(page.locator(".trial-result")).toContainText("A file of this page did not load");
});

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
