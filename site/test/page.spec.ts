import { gzipSync } from "node:zlib";
import { expect, test } from "@playwright/test";
import { complaints, PAGES, requestsElsewhere, scrolledThrough, shifts, violations } from "./support/pages.ts";

// What holds on every page of the site, whichever there are.

for (const path of PAGES) {
  test.describe(path, () => {
    test("loads and runs without a complaint or a request to another host", async ({ page, baseURL }) => {
      const heard = complaints(page);
      const elsewhere = requestsElsewhere(page, baseURL ?? "");
      await page.goto(path);
      await scrolledThrough(page);
      expect(heard).toEqual([]);
      expect(elsewhere).toEqual([]);
    });

    test("is light before it is scrolled", async ({ page }) => {
      let bytes = 0;
      page.on("response", async (response) => {
        bytes += gzipSync(await response.body().catch(() => Buffer.alloc(0))).length;
      });
      await page.goto(path);
      await page.waitForLoadState("networkidle");
      expect(bytes, "gzipped").toBeLessThan(path === "/index.html" ? 250_000 : 300_000);
    });

    test("nothing jumps while it loads and runs", async ({ page }) => {
      test.slow(); // the whole page at three widths
      for (const width of [1280, 820, 390]) {
        await page.setViewportSize({ width, height: 900 });
        const { sum, what } = await shifts(page, path);
        expect(sum, `at ${width} pixels:${what}`).toBeLessThan(0.005);
      }
    });

    test("fits phones, tablets and desktops", async ({ page }) => {
      for (const width of [320, 390, 820, 1280]) {
        await page.setViewportSize({ width, height: 844 });
        await page.goto(path);
        await scrolledThrough(page);
        const over = await page.evaluate(
          () => document.documentElement.scrollWidth - document.documentElement.clientWidth,
        );
        expect(over, `at ${width} pixels`).toBeLessThanOrEqual(0);
      }
    });

    for (const colorScheme of ["light", "dark"] as const) {
      test(`axe finds nothing in ${colorScheme}`, async ({ page }) => {
        await page.emulateMedia({ colorScheme, reducedMotion: "reduce" });
        await page.goto(path);
        await scrolledThrough(page);
        expect(await violations(page)).toEqual([]);
      });
    }
  });
}

test("the navigation leads to every page and says where one is", async ({ page }) => {
  await page.goto("/");
  const navigation = page.getByRole("navigation", { name: "Site" });
  const names = await navigation.getByRole("link").allTextContents();
  expect(names.length).toBeGreaterThan(4);
  for (const name of names) {
    await navigation.getByRole("link", { name }).click();
    await expect(navigation.getByRole("link", { name })).toHaveAttribute("aria-current", "page");
    await expect(page.locator("main h1")).toBeVisible();
  }
});

test("every link of every page leads somewhere", async ({ page, request }) => {
  const broken: string[] = [];
  const seen = new Set<string>();
  for (const path of PAGES) {
    await page.goto(path);
    const links = await page.locator("a[href]").evaluateAll((all) => all.map((link) => (link as HTMLAnchorElement).href));
    for (const link of new Set(links)) {
      const { origin, pathname, hash } = new URL(link);
      if (origin !== new URL(page.url()).origin) continue;
      if (hash && pathname === new URL(page.url()).pathname && (await page.locator(hash).count()) !== 1) {
        broken.push(`${path}: ${hash}`);
      }
      if (seen.has(pathname)) continue;
      seen.add(pathname);
      if (!(await request.get(pathname)).ok()) broken.push(`${path}: ${pathname}`);
    }
  }
  expect(broken).toEqual([]);
});

test("the documentation of each language that there is can be reached, and is of this library", async ({ page }) => {
  await page.goto("/api.html");
  for (const [language, said] of [["rust", "find_pairs"], ["javascript", "findPairs"], ["python", "find_pairs_between"]] as const) {
    const link = page.locator(`section[aria-labelledby=${language}]`).getByRole("link", { name: "Documentation of the" });
    const [tab] = await Promise.all([page.waitForEvent("load"), link.click()]);
    await expect(tab.locator("body")).toContainText(said);
    await page.goto("/api.html");
  }
});

test.describe("light and dark", () => {
  const paper = `getComputedStyle(document.body).backgroundColor`;

  test("follows the system until one is chosen, and keeps the choice from page to page", async ({ page }) => {
    await page.emulateMedia({ colorScheme: "light" });
    await page.goto("/");
    const light = await page.evaluate(paper);
    await page.emulateMedia({ colorScheme: "dark" });
    const dark = await page.evaluate(paper);
    expect(dark).not.toBe(light);

    const choice = page.getByLabel("Light or dark");
    await choice.selectOption("light");
    expect(await page.evaluate(paper)).toBe(light);
    await page.goto("/race.html");
    expect(await page.evaluate(paper)).toBe(light);
    await expect(choice).toHaveValue("light");
    await choice.selectOption("auto");
    expect(await page.evaluate(paper)).toBe(dark);
  });

  test("a choice does not flash: the first picture already has it", async ({ page }) => {
    await page.emulateMedia({ colorScheme: "light" });
    await page.goto("/");
    const light = await page.evaluate(paper);
    await page.getByLabel("Light or dark").selectOption("dark");
    const dark = await page.evaluate(paper);
    expect(dark).not.toBe(light);
    // No script but the one in the page's head: what that leaves is the first picture.
    await page.route(/\.js$/, (route) => route.abort());
    await page.reload({ waitUntil: "domcontentloaded" });
    expect(await page.evaluate(paper)).toBe(dark);
  });
});

test.describe("without scripts", () => {
  test.use({ javaScriptEnabled: false });

  for (const path of PAGES) {
    test(`${path} still says what it is about`, async ({ page }) => {
      await page.goto(path);
      await expect(page.locator("main h1")).not.toBeEmpty();
    });
  }
});
