import { expect, test } from "@playwright/test";
import { PAGES } from "./support/pages.ts";

test.use({ serviceWorkers: "allow" });

test("the playground opens without a network after one visit", async ({ page, context }) => {
  const playground = page.locator("box-playground");
  await page.goto("/playground.html?scene=falling+balls&boxes=50");
  await expect(page.locator("html")).toHaveAttribute("data-stored", "");
  await expect(playground).toHaveAttribute("data-step", /./);
  // What its thread has loaded is stored as well.
  const stored = (): Promise<string[]> =>
    page.evaluate(async () => (await Promise.all((await caches.keys()).map(async (name) => (await (await caches.open(name)).keys()).map(({ url }) => url)))).flat());
  await expect.poll(async () => (await stored()).filter((url) => /\/(experiment|simulation)[^/]*\.simd[^/]*\.wasm/.test(url)).length).toBe(2);
  await context.setOffline(true);
  await page.reload();
  await expect(playground).toHaveAttribute("data-step", /./);
});

test("a page that was visited opens without a network; a first visit stores the article alone", async ({ page, context }) => {
  test.slow(); // every page twice
  const failed: string[] = [];
  page.on("requestfailed", (request) => {
    // What is still loading when the page is left is aborted, and that is no failure.
    if (request.failure()?.errorText !== "net::ERR_ABORTED") failed.push(request.url());
  });
  const stored = (): Promise<void> => expect(page.locator("html")).toHaveAttribute("data-stored", "");
  /** What is computed in a thread of its own has begun: its files have been loaded. */
  const isAlive = async (): Promise<void> => {
    for (const element of await page.locator("box-playground:not([compact])").all()) await expect(element).toHaveAttribute("data-step", /./);
  };
  await page.goto("/playground.html");
  await stored();
  const bytes = await page.evaluate(async () => {
    let sum = 0;
    for (const name of await caches.keys()) {
      const cache = await caches.open(name);
      for (const request of await cache.keys()) sum += (await (await cache.match(request))!.arrayBuffer()).byteLength;
    }
    return sum;
  });
  expect(bytes, "the article and this page").toBeLessThan(3_500_000);
  // The embedded demo has no frame of a page, and stores nothing.
  const visited = PAGES.filter((path) => path !== "/embed.html" && path !== "/index.html");
  for (const path of visited) {
    await page.goto(path);
    await stored();
    await isAlive();
  }
  // A request of a page that was left before it had an answer is no failure.
  failed.length = 0;
  await context.setOffline(true);
  for (const path of [...visited, "/", "/playground.html?scene=falling+balls&boxes=50"]) {
    await page.goto(path);
    await page.waitForLoadState("load");
    await expect(page.locator("main")).toBeAttached();
    await isAlive();
    expect(failed).toEqual([]);
  }
  // Not only the text: the library answers.
  await page.goto("/");
  await page.locator("library-trial").scrollIntoViewIfNeeded();
  await page.getByRole("button", { name: "Find pairs" }).click();
  await expect(page.locator(".trial-result")).toContainText("the same pairs");
  await page.locator("#d1 sap-demo").scrollIntoViewIfNeeded();
  await expect.poll(() => page.locator("#d1 sap-demo").evaluate((demo) => (demo as HTMLElement & { balls?: unknown[] }).balls?.length ?? 0)).toBe(5);
});
