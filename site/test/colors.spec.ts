// Every state of a demo can be shown from the ground and from the others, also where the visitor forces colors.
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
    expect(new Set(lines).size, "shown apart without color").toBe(5);
  }
});

test("what a sentence names has its name in the picture, from left to right where the text says so", async ({ page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  await page.goto("/");
  await page.locator("sap-demo").first().scrollIntoViewIfNeeded();
  await page.evaluate(() => customElements.whenDefined("sap-demo"));
  const demos = await page.locator("sap-demo:not([labels=emoji])").evaluateAll(async (all) => {
    const shown: { of: string; labels: string[]; names: string[]; order: string[] }[] = [];
    for (const demo of all as (HTMLElement & { ready: Promise<void>; balls: number[][]; step(): void; reset(): void })[]) {
      await demo.ready;
      const labels = demo.getAttribute("labels")?.split(",") ?? [];
      const leftOf = (ball: number): number => demo.balls[ball]![0]! - demo.balls[ball]![2]!;
      const order = labels.map((_, ball) => ball).sort((a, b) => leftOf(a) - leftOf(b)).map((ball) => labels[ball]!);
      const names = new Set<string>();
      for (let step = 0; step < 60; step++) {
        // Painted, with its sentence, in the next frame.
        if (step % 6 === 0) await new Promise(requestAnimationFrame);
        for (const [, name] of (demo.shadowRoot!.querySelector(".said")?.textContent ?? "").matchAll(/(?<![A-Za-z])([A-Z])(?![a-z])/g)) names.add(name!);
        if (!demo.hasAttribute("static")) demo.step();
      }
      demo.reset();
      shown.push({ of: `${demo.closest("figure")?.id} ${demo.getAttribute("aria-label")}`, labels, names: [...names], order });
    }
    return shown;
  });
  expect(demos.length).toBeGreaterThan(30);
  for (const { of, labels, names } of demos) expect(names.filter((name) => !labels.includes(name)), of).toEqual([]);
  expect(demos.filter(({ names }) => names.length > 1).length, "sentences with names").toBeGreaterThan(12);
  // "Let us always call the leftmost ball A."
  for (const start of ["d5 ", "d9 ", "d10 ", "d11 ", "every-axis-demo ", "d14 ", "d15 ", "d18 ", "d12 "]) {
    const { labels, order } = demos.find(({ of }) => of.startsWith(start))!;
    expect(order, start).toEqual([...labels].sort());
  }
});

for (const colorScheme of ["light", "dark"] as const) {
  test(`${colorScheme}: a sweep line and an overlap look the same in figures, words, the first picture and the playground`, async ({ page }) => {
    await page.emulateMedia({ colorScheme, reducedMotion: "reduce" });
    await page.goto("/");
    const colors = await page.evaluate(() => {
      const of = (selector: string, property: "stroke" | "color" | "fill"): string => getComputedStyle(document.querySelector(selector)!)[property];
      return {
        sweep: [of(".figure .sweep", "stroke"), of("hero-boxes .is-sweep", "color"), of(".sections .is-sweep", "color")],
        overlap: [of("[data-figure=columns] .hit", "stroke"), of("hero-boxes .is-overlap", "color"), of(".sections .is-overlap", "color")],
      };
    });
    expect(new Set(colors.sweep).size, colors.sweep.join()).toBe(1);
    expect(new Set(colors.overlap).size, colors.overlap.join()).toBe(1);
    // Two boxes that overlap, and one that overlaps nothing.
    await page.goto("/playground.html?own=0,0,4,4;3,3,7,7;8,0,10,2&motion=still");
    await expect(page.locator("box-playground")).toHaveAttribute("data-step", "0");
    const painted = await page.locator("[data-part=picture]").evaluate((canvas: HTMLCanvasElement) => {
      const { width, height } = canvas;
      const scale = 0.94 * Math.min(width / 10, height / 7);
      const { data } = canvas.getContext("2d")!.getImageData(0, 0, width, height);
      return [[1, 1], [6, 6], [9, 1]].map(([x = 0, y = 0]) => {
        const at = 4 * (Math.round(height / 2 - (y - 3.5) * scale) * width + Math.round(width / 2 + (x - 5) * scale));
        return `rgb(${[...data.slice(at, at + 3)].join(", ")})`;
      });
    });
    expect(painted.slice(0, 2)).toEqual([colors.overlap[0], colors.overlap[0]]);
    expect(painted[2]).not.toBe(colors.overlap[0]);
  });
}

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
