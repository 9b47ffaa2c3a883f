import { readdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import type { AxeResults } from "axe-core";
import type { Page } from "@playwright/test";

/** Every page of the site, by its path. */
export const PAGES: readonly string[] = readdirSync(new URL("../../", import.meta.url))
  .filter((file) => file.endsWith(".html"))
  .map((file) => `/${file}`);

/** Everything that a browser complains about, from now on. */
export function complaints(page: Page): string[] {
  const all: string[] = [];
  const hear = (complaint: string): void => {
    // What the driver in software says of its own slowness is not the page's fault, nor is that the
    // tests forbid service workers.
    if (!/GPU stall|GL Driver Message|software WebGL|blocked by Playwright/i.test(complaint)) all.push(complaint);
  };
  page.on("console", (message) => {
    if (message.type() === "error" || message.type() === "warning") hear(message.text());
  });
  page.on("pageerror", (error) => hear(String(error)));
  page.on("requestfailed", (request) => hear(`failed: ${request.url()}`));
  page.on("response", (response) => {
    if (!response.ok() && response.status() !== 304) hear(`${response.status()}: ${response.url()}`);
  });
  return all;
}

/** Every request to a host that is not the site's, from now on. */
export function requestsElsewhere(page: Page, baseURL: string): string[] {
  const all: string[] = [];
  page.on("request", (request) => {
    const { protocol, origin } = new URL(request.url());
    if (protocol.startsWith("http") && origin !== baseURL) all.push(request.url());
  });
  return all;
}

/** Shows the whole page, a window at a time, so that everything on it has been awake. */
export async function scrolledThrough(page: Page): Promise<void> {
  await page.evaluate(async () => {
    for (let y = 0; y < document.documentElement.scrollHeight; y += innerHeight * 0.8) {
      scrollTo({ top: y, behavior: "instant" });
      await new Promise((resolve) => setTimeout(resolve, 60));
    }
    scrollTo({ top: 0, behavior: "instant" });
    await new Promise((resolve) => setTimeout(resolve, 300));
  });
}

/** How far things moved by themselves, in the units of layout shift, while the page loaded and was read; and what. */
export async function shifts(page: Page, path: string): Promise<{ sum: number; what: string }> {
  await page.goto("about:blank");
  await page.goto(path);
  await page.evaluate(() => {
    const seen = { sum: 0, what: "" };
    Object.assign(window, { shifts: seen });
    type Shift = PerformanceEntry & { value: number; sources: { node: Node | null }[] };
    new PerformanceObserver((list) => {
      for (const { value, sources } of list.getEntries() as Shift[]) {
        const moved = sources.map(({ node }) => `${node?.nodeName} “${node?.textContent?.trim().slice(0, 40)}”`);
        seen.sum += value;
        seen.what += `\n${value.toFixed(4)} at ${Math.round(scrollY)} px: ${moved.join(", ")}`;
      }
    }).observe({ type: "layout-shift", buffered: true });
  });
  await scrolledThrough(page);
  return page.evaluate(() => (window as unknown as { shifts: { sum: number; what: string } }).shifts);
}

const axeSource = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

/** What axe finds wrong with the page, one line for each. */
export async function violations(page: Page): Promise<string[]> {
  await page.evaluate(axeSource);
  const { violations } = await page.evaluate(
    () => (window as unknown as { axe: { run(): Promise<AxeResults> } }).axe.run(),
  );
  return violations.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.html).join(" ")}`);
}
