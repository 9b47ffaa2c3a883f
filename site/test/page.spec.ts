import { readFileSync } from "node:fs";
import { gzipSync } from "node:zlib";
import { expect, test } from "@playwright/test";
import { complaints, cutOff, MOVED, overflow, PAGES, requestsElsewhere, scrolledThrough, tabbedThrough, tooSmall, violations, watchShifts } from "./support/pages.ts";
import { RETRIED } from "./support/retried.ts";

// What holds on every page of the site, whichever there are.

/** What is most often asked of a color, and what else may differ between light and dark. */
const COLOR_RULES = ["color-contrast", "link-in-text-block"];

for (const path of PAGES.map((path) => MOVED[path] ?? path)) {
  test.describe(path, () => {
    test("is light, loads and runs at any width without a complaint or a request to another host, and nothing jumps or is cut off", async ({ page, baseURL }) => {
      test.slow(); // the whole page at three widths
      const heard = complaints(page);
      const elsewhere = requestsElsewhere(page, baseURL ?? "");
      const sizes: Promise<number>[] = [];
      page.on("response", (response) => sizes.push(response.body().then((body) => gzipSync(body).length, () => 0)));
      for (const width of [1280, 820, 390]) {
        await page.setViewportSize({ width, height: 900 });
        await page.goto("about:blank");
        await page.goto(path);
        const shifts = await watchShifts(page);
        if (width === 1280) {
          await page.waitForLoadState("networkidle");
          // Balls that fall need a second compiled module, that of their motion.
          const most = path === "/index.html" ? 250_000 : path === MOVED["/falling.html"] ? 400_000 : 300_000;
          const bytes = (await Promise.all(sizes)).reduce((sum, size) => sum + size, 0);
          expect(bytes, "gzipped, before it is scrolled").toBeLessThan(most);
        }
        await scrolledThrough(page);
        const { sum, what } = await shifts();
        expect(sum, `at ${width} pixels:${what}`).toBeLessThan(0.005);
        expect(await overflow(page), `at ${width} pixels`).toBeLessThanOrEqual(0);
        expect(await cutOff(page), `at ${width} pixels`).toEqual([]);
      }
      expect(await tooSmall(page), "for a finger, or for the eyes").toEqual([]);
      await page.setViewportSize({ width: 320, height: 900 });
      await expect.poll(() => overflow(page), { message: "at 320 pixels" }).toBeLessThanOrEqual(0);
      expect(await cutOff(page), "at 320 pixels").toEqual([]);
      // A window of 1280 by 900 pixels that is zoomed to 200 % has room for 640 by 450.
      await page.setViewportSize({ width: 640, height: 450 });
      await expect.poll(() => overflow(page), { message: "zoomed to 200 %" }).toBeLessThanOrEqual(0);
      expect(await cutOff(page), "zoomed to 200 %").toEqual([]);
      expect(heard).toEqual([]);
      expect(elsewhere).toEqual([]);
    });

    test("axe finds nothing in light and dark; Tab reaches every control, and the focus is visible", async ({ page }) => {
      test.slow(); // hundreds of controls in the article
      await page.emulateMedia({ colorScheme: "light", reducedMotion: "reduce" });
      await page.goto(path);
      await scrolledThrough(page);
      expect(await violations(page), "light").toEqual([]);
      await page.emulateMedia({ colorScheme: "dark", reducedMotion: "reduce" });
      expect(await violations(page, COLOR_RULES), "dark").toEqual([]);
      const { reached, unseen, missed } = await tabbedThrough(page);
      expect(reached, "controls").toBeGreaterThan(path === "/embed.html" ? 1 : 9);
      expect(unseen, "without a visible focus").toEqual([]);
      expect(missed, "never reached").toEqual([]);
    });
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
      if (!(await request.get(pathname, RETRIED)).ok()) broken.push(`${path}: ${pathname}`);
    }
  }
  expect(broken).toEqual([]);
});

test("the documentation of each language that there is can be reached, and is of this library", async ({ page }) => {
  const heard = complaints(page);
  await page.goto("/api.html");
  for (const [language, said] of [["rust", "find_pairs"], ["javascript", "findPairs"], ["python", "find_pairs_between"]] as const) {
    const link = page.locator(`section[aria-labelledby=${language}]`).getByRole("link", { name: "Documentation of the" });
    const [tab] = await Promise.all([page.waitForEvent("load"), link.click()]);
    await expect(tab.locator("body")).toContainText(said);
    await page.waitForLoadState("networkidle");
    await page.getByRole("link", { name: "← sweep-and-prune" }).click();
    await expect(page).toHaveURL(/\/api\.html$/);
  }
  expect(heard).toEqual([]);
});

test("users of other libraries find their page from the API page, with what the documents say", async ({ page }) => {
  const read = (file: string): string => readFileSync(new URL(`../../${file}`, import.meta.url), "utf8");
  for (const [link, name] of [["In the place of the broad phase of matter, cannon, Excalibur or Phaser", "matter"], ["In the place of the broad phase of Avian", "avian"], ["In the place of the broad phase of Bullet", "bullet"], ["In the place of a manager of FCL", "fcl"], ["For users of bedtools", "bedtools"]] as const) {
    await page.goto("/api.html");
    await page.getByRole("link", { name: link }).click();
    await expect(page.locator(`#${name}`)).toBeInViewport();
  }
  const documents = ["js/docs/physics.md", "integrations/bevy/README.md", "c/adapters/bullet/README.md", "c/adapters/fcl/README.md"].map(read).join("\n").replaceAll(/^# [^a-z].*\n/gm, "");
  const codes = await page.locator("pre code").evaluateAll((all) => all.map((code) => code.textContent!));
  expect(codes).toHaveLength(7);
  for (const code of codes) expect(documents).toContain(code);
  const section = read("docs/guide/from-other-libraries.md").split("## bedtools")[1]!.split("\n## ")[0]!;
  const table = section.split("\n").filter((line) => line.startsWith("| ")).join("\n");
  const cells = await page.locator("tbody td code").allTextContents();
  expect(cells.length).toBeGreaterThan(20);
  expect(cells).toEqual([...table.matchAll(/`([^`]*)`/g)].map(([, code]) => code));
  expect(cells.filter((cell) => cell.startsWith("bedtools "))).toHaveLength(table.split("\n| `bedtools").length - 1);
});

test("the API page has what the READMEs begin with, and says as they do whether the packages are on the registries", async ({ page }) => {
  const read = (file: string): string => readFileSync(new URL(`../../${file}`, import.meta.url), "utf8");
  await page.goto("/api.html");
  const [says = ""] = /^Version .* not on the registries.*$/m.exec(read("README.md")) ?? [];
  await expect(page.locator(".lede")).toContainText(`nothing is changed. ${says.replace(/\[(.*?)\]\(.*?\)/, "$1")}`.trim());
  for (const [section, file] of [["rust", "core/README.md"], ["javascript", "js/README.md"], ["python", "python/README.md"]] as const) {
    const codes = [...read(file).matchAll(/^```\w+\n(.*?)\n```$/gms)].slice(0, 2).map(([, code]) => code);
    expect(await page.locator(`section[aria-labelledby=${section}] pre code`).allTextContents()).toEqual(codes);
  }
});

test("the guide, and the folder of the crate's documentation, can be reached", async ({ page }) => {
  await page.goto("/api.html");
  await page.getByRole("link", { name: "Guide: detections" }).click();
  await expect(page).toHaveURL(/guide\.html$/);
  await page.goto("/");
  await page.locator("footer").getByRole("link", { name: "guide" }).click();
  await expect(page.locator("body")).toContainText("detections");
  await page.goto("/api/rust/");
  await expect(page).toHaveURL(/sweep_and_prune\/index\.html$/);
});

test("what is installed, and each example, can be copied", async ({ page, context }) => {
  await context.grantPermissions(["clipboard-read", "clipboard-write"]);
  await page.goto("/api.html");
  for (const line of ["cargo add sweep-and-prune", "npm install sweep-and-prune", "pip install sweep-and-prune"]) {
    await page.getByRole("button", { name: `Copy ${line}` }).click();
    await expect.poll(() => page.evaluate(() => navigator.clipboard.readText())).toBe(`${line}\n`);
  }
  const example = page.locator("section[aria-labelledby=python]");
  await example.getByRole("button", { name: "Copy the example" }).click();
  const code = await example.locator("code").filter({ hasText: "import numpy" }).textContent();
  await expect.poll(() => page.evaluate(() => navigator.clipboard.readText())).toBe(`${code}\n`);
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
    await page.goto("/playground.html");
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

  // What each page says and shows where nothing moves.
  const SAID: Readonly<Record<string, readonly string[]>> = {
    "/index.html": [".hero-stage img", "sap-demo svg.poster", "text=Four hundred boxes make 79,800 pairs"],
    "/falling.html": ["text=Falling discs and spheres are now a scene"],
    "/race.html": ["text=The race is now a part of the"],
    "/playground.html": ["box-playground img.still", "text=Make a world of your own"],
    "/benchmark.html": [".fronts table", "text=finds all overlapping pairs among 10,000 boxes"],
    "/api.html": ["text=cargo add sweep-and-prune", "text=pip install sweep-and-prune"],
    "/tasks.html": ["#miss pre", "#swaps .ask summary"],
    "/from-other-libraries.html": ["#matter ~ .listing pre, section pre", "text=bedtools cluster"],
    "/teachers.html": ["text=A lesson of 45 minutes"],
    "/embed.html": ["noscript p"],
  };

  for (const path of PAGES) {
    test(`${path} says what it would show, with its pictures`, async ({ page }) => {
      await page.goto(path);
      await expect(page.locator("main h1")).not.toBeEmpty();
      for (const what of SAID[path] ?? ["nothing is said about this page in the test"]) {
        const first = page.locator(what).first();
        await first.scrollIntoViewIfNeeded();
        await expect(first, what).toBeVisible();
        expect((await first.boundingBox())!.height, what).toBeGreaterThan(10);
      }
      for (const picture of await page.locator("img.still").all()) {
        await picture.scrollIntoViewIfNeeded();
        await expect.poll(() => picture.evaluate((image: HTMLImageElement) => image.naturalWidth)).toBeGreaterThan(300);
      }
    });
  }
});
