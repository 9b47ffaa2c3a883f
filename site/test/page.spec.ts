import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { gzipSync } from "node:zlib";
import type { AxeResults } from "axe-core";
import { expect, test, type Page } from "@playwright/test";
import { Lab } from "./lab.ts";

const axeSource = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

/** Everything that a browser complains about, from now on. */
function complaints(page: Page): string[] {
  const all: string[] = [];
  page.on("console", (message) => {
    if (message.type() === "error" || message.type() === "warning") all.push(message.text());
  });
  page.on("pageerror", (error) => all.push(String(error)));
  page.on("requestfailed", (request) => all.push(`failed: ${request.url()}`));
  page.on("response", (response) => {
    if (!response.ok() && response.status() !== 304) all.push(`${response.status()}: ${response.url()}`);
  });
  return all;
}

/** What the driver in software says of its own slowness is not the page's fault. */
const ofThePage = (complaint: string): boolean => !/GPU stall|GL Driver Message|software WebGL/i.test(complaint);

test("loads and runs without a complaint or a request to another host", async ({ page, baseURL }) => {
  const heard = complaints(page);
  const elsewhere: string[] = [];
  page.on("request", (request) => {
    const { protocol, origin } = new URL(request.url());
    if (protocol.startsWith("http") && origin !== baseURL) elsewhere.push(request.url());
  });
  await page.goto("/");
  for (const id of ["discs", "spheres"] as const) {
    const lab = await new Lab(page, id).open();
    const step = await lab.stepNumber();
    await expect.poll(() => lab.stepNumber()).toBeGreaterThan(step + 5);
  }
  await page.getByRole("button", { name: "Find pairs" }).click();
  await expect(page.locator(".trial-result")).toContainText("pairs among");
  expect(heard.filter(ofThePage)).toEqual([]);
  expect(elsewhere).toEqual([]);
});

test("three.js is not loaded before the spheres are near, and the first page is light", async ({ page }) => {
  let bytes = 0;
  const scripts: string[] = [];
  page.on("response", async (response) => {
    if (response.url().endsWith(".js")) scripts.push(response.url());
    bytes += gzipSync(await response.body().catch(() => Buffer.alloc(0))).length;
  });
  await page.setViewportSize({ width: 1280, height: 700 });
  await page.goto("/");
  await new Lab(page, "discs").open();
  await page.waitForLoadState("networkidle");
  expect(scripts.filter((url) => url.includes("sphere-view"))).toEqual([]);
  expect(bytes, "gzipped, before the spheres").toBeLessThan(300_000);
});

test("nothing jumps while it loads and runs", async ({ page }) => {
  await page.addInitScript(() => {
    const shifts: number[] = [];
    Object.assign(window, { shifts });
    new PerformanceObserver((list) => {
      for (const entry of list.getEntries()) shifts.push((entry as PerformanceEntry & { value: number }).value);
    }).observe({ type: "layout-shift", buffered: true });
  });
  for (const width of [1280, 820, 390]) {
    await page.setViewportSize({ width, height: 900 });
    await page.goto("/");
    for (const id of ["discs", "spheres"] as const) await new Lab(page, id).open();
    await page.waitForTimeout(1500);
    const shifts = await page.evaluate(() => (window as unknown as { shifts: number[] }).shifts);
    expect(shifts.reduce((sum, shift) => sum + shift, 0), `at ${width} pixels`).toBeLessThan(0.005);
  }
});

for (const width of [320, 390, 820, 1280]) {
  test(`fits a window ${width} pixels wide`, async ({ page }) => {
    await page.setViewportSize({ width, height: 844 });
    await page.goto("/");
    for (const id of ["discs", "spheres"] as const) await new Lab(page, id).open();
    await page.getByRole("button", { name: "Find pairs" }).click();
    expect(
      await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth),
    ).toBeLessThanOrEqual(0);
  });
}

for (const colorScheme of ["light", "dark"] as const) {
  test(`axe finds nothing in ${colorScheme}`, async ({ page }) => {
    await page.emulateMedia({ colorScheme, reducedMotion: "reduce" });
    await page.goto("/");
    for (const id of ["discs", "spheres"] as const) await new Lab(page, id).open();
    await page.evaluate(axeSource);
    const { violations } = await page.evaluate(
      () => (window as unknown as { axe: { run(): Promise<AxeResults> } }).axe.run(),
    );
    expect(violations.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.html).join(" ")}`)).toEqual([]);
  });
}

test("says so where there is no WebGL, and still counts", async ({ page }) => {
  await page.addInitScript(() => {
    const original = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (this: HTMLCanvasElement, kind: string, ...rest: unknown[]) {
      return kind.startsWith("webgl") ? null : (original as (...all: unknown[]) => unknown).call(this, kind, ...rest);
    } as typeof original;
  });
  await page.goto("/");
  const lab = await new Lab(page, "spheres").open();
  await expect(lab.root.locator('[data-part="message"]')).toContainText("no picture");
  await expect.poll(() => lab.value("pairs")).toBeGreaterThan(0);
});

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
