import { expect, test } from "@playwright/test";

// The parts of the site that do not move and do not hang on the fonts of the machine: the shapes of
// the figures, their words hidden. Anything else would fail on the next machine.

const FIGURES = ["all-pairs", "box-test", "transitivity", "endpoint-array", "sweep-line", "space-time", "columns", "measured", "measured-narrow"];

for (const colorScheme of ["light", "dark"] as const) {
  test(`figures in ${colorScheme} look as they did`, async ({ page }) => {
    await page.emulateMedia({ colorScheme, reducedMotion: "reduce" });
    await page.goto("/");
    await page.addStyleTag({ content: ".figure text { visibility: hidden }" });
    await expect(page.locator(".figure")).toHaveCount(FIGURES.length);
    for (const name of FIGURES) {
      // By itself, at its own size and on whole pixels, whatever the page around it.
      const figure = page.locator(`[data-figure=${name}]`);
      await figure.evaluate((svg) => {
        document.querySelector("#shown")?.remove();
        const shown = document.createElement("div");
        shown.id = "shown";
        shown.style.cssText = "position: fixed; inset: 0; z-index: 10; padding: 10px; background: var(--paper)";
        const copy = svg.cloneNode(true) as SVGElement;
        copy.style.display = "block";
        shown.append(copy);
        document.body.append(shown);
      });
      await expect(page.locator("#shown svg")).toHaveScreenshot(`${name}-${colorScheme}.png`, { maxDiffPixelRatio: 0.01 });
    }
  });
}
