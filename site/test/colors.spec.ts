// Every state of a demo can be told from the ground and from the others, also where the visitor forces colors.
import { expect, test } from "@playwright/test";

test("words for what a demo shows have its color, another mark beside it, and stand in the legend", async ({ page }) => {
  for (const colorScheme of ["light", "dark"] as const) {
    await page.emulateMedia({ colorScheme, reducedMotion: "reduce" });
    await page.goto("/");
    const found = await page.evaluate(() => {
      const painted = (color: string): number[] => {
        const context = new OffscreenCanvas(1, 1).getContext("2d")!;
        context.fillStyle = color;
        context.fillRect(0, 0, 1, 1);
        return [...context.getImageData(0, 0, 1, 1).data];
      };
      const luminance = (color: number[]): number => {
        const [red = 0, green = 0, blue = 0] = color.map((value) => (value <= 0.04045 * 255 ? value / 255 / 12.92 : ((value / 255 + 0.055) / 1.055) ** 2.4));
        return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
      };
      /** The first ground behind an element that is not transparent. */
      const groundOf = (element: Element): number[] => {
        const color = painted(getComputedStyle(element).backgroundColor);
        return color[3] === 255 || !element.parentElement ? color : groundOf(element.parentElement);
      };
      const wrong: string[] = [];
      const marks = new Map<string, string>();
      const words = [...document.querySelectorAll<HTMLElement>('.sections [class^="is-"]')].filter(({ className }) => /^is-\w+$/.test(className));
      for (const word of words) {
        const style = getComputedStyle(word);
        const [low = 0, high = 0] = [luminance(painted(style.color)), luminance(groundOf(word))].sort((a, b) => a - b);
        const contrast = (high + 0.05) / (low + 0.05);
        if (contrast < 4.5) wrong.push(`${word.className} "${word.textContent}": contrast ${contrast.toFixed(2)}`);
        const mark = style.textDecorationLine === "none" ? `${style.borderTopStyle} ${style.borderRadius}` : `${style.textDecorationStyle} ${style.textDecorationThickness}`;
        if (/^none 0px/.test(mark)) wrong.push(`${word.className} has no mark but its color`);
        marks.set(word.className, mark);
        const figure = word.closest("figure.demo, .beside");
        if (word.closest("figcaption") && !figure?.querySelector(`.legend .${word.className}`)) wrong.push(`${word.className} "${word.textContent}" is not in the legend of ${figure?.id}`);
      }
      const bare = [...document.querySelectorAll(".sections sap-demo[decorations], .sections sap-demo[variant]")].filter((demo) => {
        const figure = demo.closest("sap-comparison, .two") ?? demo;
        const after = demo.closest("sap-comparison") ?? figure;
        return !demo.closest("figure")?.querySelector(".legend") && !after.nextElementSibling?.matches(".legend");
      });
      return { count: words.length, wrong, marks: [...marks], bare: bare.map((demo) => demo.getAttribute("aria-label")) };
    });
    expect(found.count).toBeGreaterThan(60);
    expect(found.wrong).toEqual([]);
    expect(found.bare, "demos without a legend").toEqual([]);
    const lines = found.marks.filter(([kind]) => ["is-test", "is-overlap", "is-skip", "is-missed", "is-swap"].includes(kind)).map(([, mark]) => mark);
    expect(new Set(lines).size, "told apart without color").toBe(5);
  }
});

/** Drawn as thin lines, rings and cells: 3 to 1 is what WCAG asks of graphics. */
const LINES = ["ink", "muted", "check", "overlap", "skip", "sweep", "edge", "comparison", "swap", "chosen"];

for (const colorScheme of ["light", "dark"] as const) {
  for (const forcedColors of ["none", "active"] as const) {
    test(`${colorScheme}, forced colors ${forcedColors}: every line, ring and cell stands out from its ground`, async ({ page }) => {
      await page.emulateMedia({ colorScheme, forcedColors, reducedMotion: "reduce" });
      await page.goto("/#d14");
      await page.locator("#d14 sap-demo").scrollIntoViewIfNeeded();
      await page.evaluate(() => customElements.whenDefined("sap-demo"));
      const found = await page.locator("#d14 sap-demo").evaluate(async (demo: HTMLElement & { ready: Promise<void> }, names) => {
        await demo.ready;
        const inside = demo.shadowRoot!;
        /** Red, green, blue from 0 to 1, as they are painted. */
        const painted = (color: string): number[] => {
          const context = new OffscreenCanvas(1, 1).getContext("2d")!;
          context.fillStyle = color;
          context.fillRect(0, 0, 1, 1);
          return [...context.getImageData(0, 0, 1, 1).data.slice(0, 3)].map((value) => value / 255);
        };
        const luminance = (color: string): number => {
          const [red = 0, green = 0, blue = 0] = painted(color).map((value) => (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4));
          return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
        };
        const contrast = (a: string, b: string): number => {
          const [low = 0, high = 0] = [luminance(a), luminance(b)].sort((x, y) => x - y);
          return (high + 0.05) / (low + 0.05);
        };
        const ground = (selector: string): string => getComputedStyle(inside.querySelector(selector)!).backgroundColor;
        const probes = new Map([...inside.querySelectorAll<HTMLElement>("span > i")].map((probe) => [/--_(\w+)/.exec(probe.style.color)?.[1] ?? "", getComputedStyle(probe).color]));
        const swatch = document.querySelector("#d14 .legend svg")!;
        return {
          grounds: [ground(".picture"), ground(".array")],
          stage: probes.get("stage")!,
          contrasts: names.map((name) => [name, contrast(probes.get(name)!, ground(".picture"))] as const),
          legend: contrast(getComputedStyle(swatch.querySelector("rect")!).fill, getComputedStyle(swatch).backgroundColor === "rgba(0, 0, 0, 0)" ? getComputedStyle(document.body).backgroundColor : getComputedStyle(swatch).backgroundColor),
        };
      }, LINES);
      // The ground of a canvas is its own, and not the system's.
      expect(found.grounds).toEqual([found.stage, found.stage]);
      for (const [name, contrast] of found.contrasts) expect(contrast, name).toBeGreaterThanOrEqual(3);
      expect(found.legend).toBeGreaterThanOrEqual(3);
      const hero = await page.locator("hero-boxes").evaluate((element) => ["overlap", "test", "sweep"].map((name) => getComputedStyle(element.querySelector(`.is-${name}`)!).color));
      expect(new Set(hero).size, "the first picture takes its colors from these words").toBe(3);
    });
  }
}
