// Headless Chromium, and what a page leaves in `globalThis.result`.
import { setTimeout } from "node:timers/promises";
import { chromium } from "playwright-core";

/** Starts Chromium. */
export function startBrowser() {
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-background-networking", "--disable-component-update"],
  });
}

/**
 * What a page leaves in `result`.
 *
 * @param {import("playwright-core").Browser} browser
 * @param {string} address
 */
export async function resultOf(browser, address) {
  const page = await browser.newPage();
  /** @type {string[]} */
  const errors = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("requestfailed", (request) => errors.push(`cannot load ${request.url()}`));
  try {
    await page.goto(address);
    // Not `waitForFunction`, which evaluates in the page, where a policy may forbid it.
    for (const end = Date.now() + 600_000; Date.now() < end; await setTimeout(50)) {
      const result = await page.evaluate("globalThis.result");
      if (result !== undefined) return result;
    }
    throw new Error("the page has no result after ten minutes");
  } catch (error) {
    throw new Error(`${errors.join("\n")}\n${error}`);
  } finally {
    await page.close();
  }
}
