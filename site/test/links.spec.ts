// What a link to a page shows of it elsewhere, what search engines are told, and what there is without scripts.
import { expect, test } from "@playwright/test";
import type { SapDemo } from "sweep-and-prune-classroom/demo";
import { MOVED, PAGES } from "./support/pages.ts";
import { RETRIED } from "./support/retried.ts";

// An embedded demo is a part of another page, and the old addresses lead to the playground.
const LINKED = PAGES.filter((path) => path !== "/embed.html" && !(path in MOVED));

test("every page has a title, a description, an address and a picture of its own kind", async ({ page, request }) => {
  const titles = new Set<string>();
  const map = await (await request.get("/sitemap.xml", RETRIED)).text();
  for (const path of LINKED) {
    const html = await (await request.get(path, RETRIED)).text();
    await page.setContent(html.replace(/<script[\s\S]*?<\/script>/g, ""));
    const content = (selector: string): Promise<string | null> => page.locator(selector).getAttribute(selector.startsWith("link") ? "href" : "content");
    const title = await page.title();
    expect(titles.has(title), title).toBe(false);
    titles.add(title);
    expect(await content('meta[property="og:title"]')).toBe(title);
    expect(await content('meta[property="og:description"]')).toBe(await content('meta[name="description"]'));
    const canonical = (await content('link[rel="canonical"]'))!;
    expect(canonical).toMatch(/^https:\/\//);
    expect(new URL(canonical).pathname.replace(/\/$/, "/index.html").endsWith(path)).toBe(true);
    expect(map).toContain(`<loc>${canonical}</loc>`);
    expect(await content('meta[property="og:image"]')).toMatch(/^https:\/\/.*\/preview\.png$/);
  }
  const picture = await (await request.get("/preview.png", RETRIED)).body();
  expect([picture.readUInt32BE(16), picture.readUInt32BE(20)], "width and height of the picture").toEqual([1200, 630]);
  expect(picture.length).toBeLessThan(300_000);
});

test("the drawing in place of a demo is its first picture", async ({ page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  await page.goto("/");
  const drawn = await page.locator("sap-demo").evaluateAll((all) => all.map((demo) => [...demo.querySelectorAll("svg.poster circle")].map((circle) => ["cx", "cy", "r"].map((name) => Number(circle.getAttribute(name))))));
  await page.locator("sap-demo").first().scrollIntoViewIfNeeded();
  await page.evaluate(() => customElements.whenDefined("sap-demo"));
  const balls = await page.locator("sap-demo").evaluateAll((all) =>
    Promise.all((all as SapDemo[]).map(async (demo) => {
      await demo.ready;
      // A wall is drawn as what it is.
      const walls = (demo.getAttribute("walls") ?? "").split(",").filter(Boolean).map(Number);
      return demo.state.tick === 0 ? demo.balls.filter((_, at) => !walls.includes(at)).map((row) => row.map((value) => Math.round(Number(value) * 10) / 10)) : undefined;
    })),
  );
  expect(balls.length).toBeGreaterThan(30);
  balls.forEach((rows, at) => rows && expect(drawn[at], `demo ${at}`).toEqual(rows));
  expect(balls.filter((rows) => rows).length).toBeGreaterThan(30);
});

test("a link to a demo begins that demo first, then the others one after another", async ({ page }) => {
  // The order in which they begin, and how many begin in one task.
  await page.addInitScript(() => {
    const began = ((globalThis as unknown as { began: { of: Element; task: number }[] }).began = []) as { of: Element; task: number }[];
    let task = 0;
    addEventListener("simulate", ({ target }) => {
      if (!began.some(({ of }) => of === target)) began.push({ of: target as Element, task });
      setTimeout(() => task++);
    });
  });
  await page.goto("/#d17");
  await page.evaluate(() => customElements.whenDefined("sap-demo"));
  await page.locator("sap-demo").evaluateAll((all) => Promise.all((all as SapDemo[]).map(({ ready }) => ready)));
  const { first, tasks } = await page.evaluate(() => {
    const { began } = globalThis as unknown as { began: { of: Element; task: number }[] };
    return { first: began[0]!.of.closest("[id]")!.id, tasks: new Set(began.map(({ task }) => task)).size };
  });
  expect(first).not.toBe("d1");
  const nearest = await page.evaluate((id) => Math.abs(document.getElementById(id)!.getBoundingClientRect().top), first);
  expect(nearest, `${first} is in view`).toBeLessThan(1000);
  // Those of a comparison begin together, and so do those in view.
  expect(tasks).toBeGreaterThan(20);
});

test.describe("without scripts", () => {
  test.use({ javaScriptEnabled: false });

  test("each demo has its drawing, and the first picture a photograph of it", async ({ page }) => {
    await page.goto("/");
    expect(await page.locator("sap-demo svg.poster").count()).toBe(await page.locator("sap-demo").count());
    const [poster, place] = [page.locator("#d2 svg.poster"), page.locator("#d2 sap-demo")];
    const box = (await poster.boundingBox())!;
    expect(box.width).toBeCloseTo((await place.boundingBox())!.width, 0);
    expect(box.height).toBeCloseTo((box.width * 2) / 3, 0);
    await expect(page.locator(".hero-stage img")).toBeVisible();
    await page.goto("/embed.html#strategy=sweep");
    await expect(page.locator("noscript p")).toBeVisible();
  });
});
