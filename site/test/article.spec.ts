import { readFileSync } from "node:fs";
import { expect, test } from "@playwright/test";

test("the library's pairs are those of brute force", async ({ page }) => {
  await page.goto("/");
  await page.getByRole("button", { name: "Find pairs" }).click();
  await expect(page.locator(".trial-result")).toContainText("the same pairs");
  await page.getByLabel("Random boxes in 3D").fill("15");
  await page.getByRole("button", { name: "Find pairs" }).click();
  await expect(page.locator(".trial-result")).toContainText("among 1,000,000 boxes");
});

test("the complexity table shows every measured variant and what it claims", async ({ page }) => {
  await page.goto("/");
  const { variants } = JSON.parse(readFileSync(new URL("../../docs/complexity.json", import.meta.url), "utf8"));
  const rows = page.locator(".table-scroll tbody tr");
  await expect(rows).toHaveCount(variants.length);
  for (const [at, { method, sort, best, worst, space, rows: measured }] of variants.entries()) {
    const row = rows.nth(at);
    await expect(row.locator("th")).toContainText(new RegExp(`^${method}`, "i"));
    if (sort) await expect(row.locator("th")).toContainText(sort);
    await expect(row.locator("td").nth(0)).toContainText(best);
    await expect(row.locator("td").nth(2)).toContainText(worst);
    await expect(row.locator("td").nth(3)).toHaveText(space);
    const ofBest = measured.find((found: { case: string }) => found.case === "best");
    await expect(row.locator("td").nth(0)).toContainText(ofBest.slope.toFixed(2));
  }
});
