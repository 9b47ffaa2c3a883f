import { expect, test } from "@playwright/test";
import { PAGES } from "./support/pages.ts";

test.use({ serviceWorkers: "allow" });

test("once visited, every page opens without a network", async ({ page, context }) => {
  await page.goto("/");
  await page.evaluate(() => navigator.serviceWorker.ready);
  await context.setOffline(true);
  for (const path of [...PAGES, "/", "/falling.html?discs.bodies=50"]) {
    const failed: string[] = [];
    page.on("requestfailed", (request) => failed.push(request.url()));
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
