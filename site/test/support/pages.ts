import { readdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import type { AxeResults } from "axe-core";
import type { Page } from "@playwright/test";

/** Every page of the site, by its path. */
export const PAGES: readonly string[] = readdirSync(new URL("../../", import.meta.url))
  .filter((file) => file.endsWith(".html"))
  .map((file) => `/${file}`);

/** Where race.html leads: four algorithms in the playground. */
export const RACE = "/playground.html?scene=uniform&boxes=1000&algorithm=global+pairwise&2=sorted+pairwise&3=swap-driven+sweep&4=find+pairs";

/** Where the pages lead that only forward. */
export const MOVED: Readonly<Record<string, string>> = {
  "/race.html": RACE,
  "/falling.html": "/playground.html?scene=falling+balls&boxes=2000&algorithm=find+pairs",
};

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
  // What is still loading when the page is left is aborted, and that is no failure.
  page.on("requestfailed", (request) => request.failure()?.errorText !== "net::ERR_ABORTED" && hear(`failed: ${request.url()}`));
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

/** Shows the whole page, a window at a time, each for two frames, so that everything on it has been awake. */
export async function scrolledThrough(page: Page): Promise<void> {
  await page.evaluate(async () => {
    for (let y = 0; y < document.documentElement.scrollHeight; y += innerHeight * 0.8) {
      scrollTo({ top: y, behavior: "instant" });
      for (let frame = 0; frame < 2; frame++) await new Promise(requestAnimationFrame);
    }
    scrollTo({ top: 0, behavior: "instant" });
    for (let frame = 0; frame < 20; frame++) await new Promise(requestAnimationFrame);
  });
}

/** Notes how far things have moved by themselves since the page began to load, in the units of layout shift, and what moved. */
export async function watchShifts(page: Page): Promise<() => Promise<{ sum: number; what: string }>> {
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
  return () => page.evaluate(() => (window as unknown as { shifts: { sum: number; what: string } }).shifts);
}

/** How many pixels the page is wider than its window. */
export const overflow = (page: Page): Promise<number> =>
  page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);

const axeSource = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

/** What axe finds wrong with the page, one line for each: by all of its rules, or by these only. */
export async function violations(page: Page, rules?: readonly string[]): Promise<string[]> {
  if (!(await page.evaluate(() => "axe" in window))) await page.evaluate(axeSource);
  type Axe = { axe: { run(options: object): Promise<AxeResults> } };
  const { violations } = await page.evaluate((rules) => (window as unknown as Axe).axe.run(rules ? { runOnly: rules } : {}), rules);
  return violations.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.html).join(" ")}`);
}

/** What hides a part of its own text: a box that clips, or a choice, and is too small. Boxes that scroll are meant to. */
export function cutOff(page: Page): Promise<string[]> {
  return page.evaluate(() => {
    /** The arrow of a choice, in pixels. */
    const ARROW = 18;
    const found: string[] = [];
    const look = (root: Document | ShadowRoot): void => {
      for (const element of root.querySelectorAll<HTMLElement>("*")) {
        if (element.shadowRoot) look(element.shadowRoot);
        const { overflowX, overflowY, clipPath, textOverflow, font, paddingLeft, paddingRight } = getComputedStyle(element);
        if (element.matches("select") && element.clientWidth > 1) {
          const context = new OffscreenCanvas(1, 1).getContext("2d")!;
          context.font = font;
          const room = element.clientWidth - Number.parseFloat(paddingLeft) - Number.parseFloat(paddingRight) - ARROW;
          for (const { text } of (element as HTMLSelectElement).options) {
            const { width } = context.measureText(text);
            if (width > room) found.push(`the choice "${text}": ${width.toFixed(0)} px in ${room.toFixed(0)}`);
          }
        }
        // What is meant for screen readers alone is clipped; what ends in dots says that there is more.
        if (clipPath !== "none" || textOverflow === "ellipsis" || !element.innerText?.trim() || element.closest("svg")) continue;
        const isOver = (overflowX === "hidden" && element.scrollWidth > element.clientWidth + 1) || (overflowY === "hidden" && element.scrollHeight > element.clientHeight + 2);
        if (isOver) found.push(`${element.tagName}.${element.className} (${element.scrollWidth} in ${element.clientWidth}, ${element.scrollHeight} in ${element.clientHeight}): ${element.innerText.trim().slice(0, 60)}`);
      }
    };
    look(document);
    return found;
  });
}

/** Controls that a finger misses (less than 44 pixels high), and text that is smaller than 12 pixels, in drawings 11. */
export function tooSmall(page: Page): Promise<string[]> {
  return page.evaluate(() => {
    const found = new Set<string>();
    const isSeen = (element: Element): boolean => {
      const { width, height } = element.getBoundingClientRect();
      return width > 1 && height > 1 && element.checkVisibility({ visibilityProperty: true, opacityProperty: true });
    };
    const look = (root: Document | ShadowRoot): void => {
      for (const element of root.querySelectorAll<HTMLElement>("*")) {
        if (element.shadowRoot) look(element.shadowRoot);
        if (!isSeen(element) || element.closest(".site-footer")) continue;
        if (element.matches("button, select, summary, input:not([type=checkbox], [type=radio]), label:has(input[type=checkbox], input[type=radio]), nav a, .button")) {
          const { height } = element.getBoundingClientRect();
          if (height < 43.5) found.add(`${element.tagName} ${height.toFixed(0)} px high: ${(element.getAttribute("aria-label") ?? element.innerText).slice(0, 40)}`);
        }
        const hasText = [...element.childNodes].some((node) => node.nodeType === Node.TEXT_NODE && node.textContent!.trim() !== "");
        if (!hasText || element.matches("option, style, script, noscript, sup, sub")) continue;
        const svg = element.closest<SVGSVGElement>("svg[viewBox]");
        const scale = svg && svg !== (element as Element) ? svg.getBoundingClientRect().width / (svg.viewBox.baseVal.width || 1) : 1;
        const size = Number.parseFloat(getComputedStyle(element).fontSize) * scale;
        if (size < (svg ? 10.95 : 11.95)) found.add(`${size.toFixed(1)} px: ${element.textContent!.trim().slice(0, 40)}`);
      }
    };
    look(document);
    return [...found];
  });
}

/** Presses Tab until the focus leaves the page: how many stops there were, those where it cannot be seen, and what was left out. */
export async function tabbedThrough(page: Page): Promise<{ reached: number; unseen: string[]; missed: string[] }> {
  await page.evaluate(() => {
    const all = new Set<Element>();
    const nameOf = (element: Element): string =>
      `${element.tagName}.${element.className} ${(element.getAttribute("aria-label") ?? element.textContent ?? "").trim().slice(0, 40)}`;
    const roots: (Document | ShadowRoot)[] = [];
    const collect = (root: Document | ShadowRoot): void => {
      roots.push(root);
      for (const element of root.querySelectorAll<HTMLElement>("*")) {
        if (element.shadowRoot) collect(element.shadowRoot);
        if (!element.matches("a[href], button, input, select, textarea, summary, [tabindex]") || element.tabIndex < 0) continue;
        if ((element as HTMLButtonElement).disabled || !element.checkVisibility({ visibilityProperty: true })) continue;
        // Of radio buttons only the chosen one is a stop.
        if (element.matches("[type=radio]:not(:checked), [type=file]")) continue;
        all.add(element);
      }
    };
    collect(document);
    const seen = { all, reached: 0, unseen: new Set<string>(), nameOf };
    const look = (event: Event): void => {
      const element = event.composedPath()[0] as HTMLElement;
      if (!all.delete(element)) return;
      seen.reached++;
      const marks = [element, element.parentElement, element.nextElementSibling].flatMap((one) => (one ? [getComputedStyle(one)] : []));
      if (marks.every(({ outlineStyle }) => outlineStyle === "none")) seen.unseen.add(nameOf(element));
    };
    // From one element to the next within a shadow tree, the event does not leave that tree.
    for (const root of roots) root.addEventListener("focusin", look, true);
    Object.assign(window, { tabbed: seen });
    (document.activeElement as HTMLElement | null)?.blur();
    scrollTo(0, 0);
  });
  type Tabbed = { tabbed: { all: Set<Element>; reached: number; unseen: Set<string>; nameOf(element: Element): string } };
  const left = (): Promise<number> => page.evaluate(() => (window as unknown as Tabbed).tabbed.all.size);
  for (let before = await left(), now = before; now > 0; before = now) {
    for (let stop = 0; stop < 40; stop++) await page.keyboard.press("Tab");
    now = await left();
    if (now === before) break;
  }
  return page.evaluate(() => {
    const { all, reached, unseen, nameOf } = (window as unknown as Tabbed).tabbed;
    return { reached, unseen: [...unseen], missed: [...all].filter((element) => element.isConnected && element.checkVisibility()).map(nameOf) };
  });
}
