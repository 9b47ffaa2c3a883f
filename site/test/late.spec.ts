import { expect, type Page, test } from "@playwright/test";
import { watchShifts } from "./support/pages.ts";

// Scripts and compiled modules that come late move nothing: each demo is as high before it has begun as after.

/** Lets the requests that match wait, until they are let through. */
async function hold(page: Page, which: RegExp): Promise<() => void> {
  let release = (): void => undefined;
  const released = new Promise<void>((resolve) => (release = resolve));
  await page.route(which, async (route) => {
    await released;
    await route.continue();
  });
  return release;
}

/** Where the parts of the article begin, from its top, and where it ends. */
const places = (page: Page): Promise<{ name: string; top: number }[]> =>
  page.locator("main :is(h2, h3, figure, figcaption, sap-demo, sap-comparison), footer").evaluateAll((all) =>
    all.map((element) => ({
      name: `${element.tagName} ${element.closest("[id]")?.id}`,
      top: element.getBoundingClientRect().top + scrollY,
    })),
  );

type Tops = Awaited<ReturnType<typeof places>>;

/** What stands elsewhere now, and by how many pixels. */
const moved = (before: Tops, now: Tops): string[] =>
  now.flatMap(({ name, top }, index) => (Math.abs(top - before[index]!.top) > 1 ? [`${name}: ${top - before[index]!.top}`] : []));

for (const width of [390, 560, 1280]) {
  test(`at ${width} pixels, nothing moves when scripts come late, nor when compiled modules do`, async ({ page }) => {
    await page.setViewportSize({ width, height: 900 });
    const letScripts = await hold(page, /\/demos-[^/]*\.js/);
    const letModules = await hold(page, /\.wasm/);
    await page.goto("/#endpoints");
    const shifts = await watchShifts(page);
    await page.evaluate(() => document.fonts.ready);
    const atFirst = await places(page);
    letScripts();
    await page.waitForFunction(() => customElements.get("sap-demo") && customElements.get("three-structures"));
    await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
    expect.soft(moved(atFirst, await places(page)), "with scripts").toEqual([]);
    letModules();
    await page.evaluate(() => Promise.all([...document.querySelectorAll("sap-demo")].map((demo) => (demo as HTMLElement & { ready: Promise<void> }).ready)));
    await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
    expect(moved(atFirst, await places(page)), "with everything").toEqual([]);
    const { sum, what } = await shifts();
    expect(sum, what).toBe(0);
  });
}
