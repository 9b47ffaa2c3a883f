import { gzipSync } from "node:zlib";
import { expect, test } from "@playwright/test";
import { FallingBalls } from "./falling-balls.ts";

test("three.js is not loaded before the spheres are near, and the first page is light", async ({ page }) => {
  let bytes = 0;
  const scripts: string[] = [];
  page.on("response", async (response) => {
    if (response.url().endsWith(".js")) scripts.push(response.url());
    bytes += gzipSync(await response.body().catch(() => Buffer.alloc(0))).length;
  });
  await page.setViewportSize({ width: 1280, height: 700 });
  await page.goto("/falling.html");
  await new FallingBalls(page, "discs").open();
  await page.waitForLoadState("networkidle");
  expect(scripts.filter((url) => url.includes("sphere-view"))).toEqual([]);
  expect(bytes, "gzipped, before the spheres").toBeLessThan(300_000);
});

test("says so where there is no WebGL, and still counts", async ({ page }) => {
  await page.addInitScript(() => {
    const original = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (this: HTMLCanvasElement, kind: string, ...rest: unknown[]) {
      return kind.startsWith("webgl") ? null : (original as (...all: unknown[]) => unknown).call(this, kind, ...rest);
    } as typeof original;
  });
  await page.goto("/falling.html");
  const balls = await new FallingBalls(page, "spheres").open();
  await expect(balls.root.locator('[data-part="message"]')).toContainText("no picture: drawing the spheres needs WebGL");
  await expect.poll(() => balls.value("pairs")).toBeGreaterThan(0);
});
