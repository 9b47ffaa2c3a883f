import { expect, test } from "@playwright/test";
import { PAGES } from "./support/pages.ts";

test.use({ serviceWorkers: "allow" });

test("once visited, every page opens without a network", async ({ page, context }) => {
  const failed: string[] = [];
  page.on("requestfailed", (request) => {
    // What is still loading when the page is left is aborted, and that is no failure.
    if (request.failure()?.errorText !== "net::ERR_ABORTED") failed.push(request.url());
  });
  await page.goto("/");
  await page.evaluate(() => navigator.serviceWorker.ready);
  await context.setOffline(true);
  for (const path of [...PAGES, "/", "/falling.html?discs.bodies=50"]) {
    await page.goto(path);
    await page.waitForLoadState("load");
    await expect(page.locator("main")).toBeAttached();
    expect(failed).toEqual([]);
  }
  // Not only the text: the library answers.
  await page.goto("/");
  await page.getByRole("button", { name: "Find pairs" }).click();
  await expect(page.locator(".trial-result")).toContainText("the same pairs");
});
