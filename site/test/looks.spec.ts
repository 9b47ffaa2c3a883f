import { readFileSync } from "node:fs";
import { expect, type Page, test } from "@playwright/test";
import type { SapDemo } from "sweep-and-prune-classroom/demo";

// How the pages lie on a phone, a tablet and a desktop: each part of each page beside the picture of it that was looked at
// and kept. Light and dark differ in colors alone, so dark is compared on a desktop. What moves or is measured is left blank.
// Words are set in a font of blocks, so that they take the same room on every machine. Pictures are
// kept at half size: --update-snapshots draws them again.

const BLOCKS = readFileSync(new URL("./support/blocks.ttf", import.meta.url)).toString("base64");

const STYLE = `
  @font-face { font-family: Blocks; src: url(data:font/ttf;base64,${BLOCKS}); }
  :root, sap-demo { --serif: Blocks; --sans: Blocks; --mono: Blocks; --sap-font: Blocks; }
  /* Widths as the font has them, not rounded to pixels as the machine would; and where lines are broken for beauty, browsers differ. */
  * { text-rendering: geometricPrecision !important; text-wrap: wrap !important; }
  /* Moving pictures, and figures that are measured in each run. */
  canvas, sap-demo::part(picture), sap-demo::part(array), [data-counter="ms"] dd, [data-counter="drawing"] dd, .trial-result, .here { visibility: hidden !important; }
  /* editing.spec.ts presses it. */
  .listing [data-part=edit] { display: none; }
`;

/** What each page is cut into, and what says that it has come to rest. */
const PAGES: Readonly<Record<string, { parts: string; rest(page: Page): Promise<unknown> }>> = {
  index: {
    parts: "main > header, .contents, .sections > section",
    rest: async (page) => {
      // The demos are loaded when a reader comes near the first of them.
      await page.locator("sap-demo").first().scrollIntoViewIfNeeded();
      await page.evaluate(() => customElements.whenDefined("sap-demo"));
      await page.locator("sap-demo").evaluateAll((all) => Promise.all(all.map((demo) => (demo as SapDemo).ready)));
      await page.locator("box-playground").scrollIntoViewIfNeeded();
      await expect(page.locator("box-playground")).toHaveAttribute("data-step", "0");
    },
  },
  playground: { parts: "main > *", rest: (page) => expect(page.locator("box-playground")).toHaveAttribute("data-step", "0") },
  benchmark: {
    parts: "main > *",
    rest: async (page) => {
      // What is folded is shown too.
      await page.locator("main > details").evaluateAll((all) => all.forEach((details) => ((details as HTMLDetailsElement).open = true)));
      await expect(page.locator("#here-run")).toBeEnabled();
    },
  },
  api: { parts: "main > *", rest: async () => {} },
  embed: { parts: "main", rest: (page) => page.locator("sap-demo").evaluate((demo) => (demo as SapDemo).ready) },
};

const WIDTHS = { phone: 390, tablet: 768, desktop: 1280 };

test.use({ deviceScaleFactor: 0.5, contextOptions: { reducedMotion: "reduce" } });

for (const [name, { parts, rest }] of Object.entries(PAGES)) {
  for (const [device, width] of Object.entries(WIDTHS)) {
    test(`${name} on a ${device} looks as it did`, async ({ page }) => {
      test.slow(); // dozens of pictures of the article
      await page.setViewportSize({ width, height: 1000 });
      await page.goto(`/${name}.html`);
      await page.addStyleTag({ content: STYLE });
      await page.evaluate(() => document.fonts.load("16px Blocks"));
      await rest(page);
      const all = await page.locator(parts).all();
      expect(all.length).toBeGreaterThan(0);
      for (const colorScheme of device === "desktop" ? (["light", "dark"] as const) : (["light"] as const)) {
        await page.emulateMedia({ colorScheme, reducedMotion: "reduce" });
        for (const [at, part] of all.entries()) {
          const picture = await part.screenshot({ scale: "device", animations: "disabled" });
          expect.soft(picture).toMatchSnapshot(`${name}-${at}-${device}-${colorScheme}.png`, { threshold: 0.1, maxDiffPixels: 100 });
        }
      }
    });
  }
}
