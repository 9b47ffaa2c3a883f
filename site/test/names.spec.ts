// One thing, one name, one color: what a demo says, draws, lists and explains is the same.
import { expect, type Page, test } from "@playwright/test";
import type { DemoEvent, SapDemo } from "sweep-and-prune-classroom/demo";
import { Demo } from "./support/demo.ts";
import { frames } from "./support/frames.ts";

type Drawn = { texts: string[]; colors: string[] };

/** From here on, each canvas keeps what was written on it and the colors of its lines and cells. */
const watchDrawing = (page: Page): Promise<unknown> =>
  page.addInitScript(() => {
    const drawn = new WeakMap<HTMLCanvasElement, { texts: Set<string>; colors: Set<string> }>();
    const of = (canvas: HTMLCanvasElement): { texts: Set<string>; colors: Set<string> } => {
      if (!drawn.has(canvas)) drawn.set(canvas, { texts: new Set(), colors: new Set() });
      return drawn.get(canvas)!;
    };
    Object.assign(window, {
      drawnOn: (canvas: HTMLCanvasElement, isNew: boolean) => {
        const { texts, colors } = of(canvas);
        if (isNew) drawn.delete(canvas);
        return { texts: [...texts], colors: [...colors] };
      },
    });
    const prototype = CanvasRenderingContext2D.prototype;
    const { fillText, fillRect } = prototype;
    type Draw = (this: CanvasRenderingContext2D, ...values: unknown[]) => void;
    const [stroke, fill] = [prototype.stroke, prototype.fill] as unknown as [Draw, Draw];
    prototype.fillText = function (...values) {
      of(this.canvas).texts.add(values[0]);
      fillText.apply(this, values);
    };
    prototype.stroke = function (this: CanvasRenderingContext2D, ...values: unknown[]) {
      of(this.canvas).colors.add(String(this.strokeStyle));
      stroke.apply(this, values);
    } as typeof prototype.stroke;
    prototype.fill = function (this: CanvasRenderingContext2D, ...values: unknown[]) {
      of(this.canvas).colors.add(String(this.fillStyle));
      fill.apply(this, values);
    } as typeof prototype.fill;
    prototype.fillRect = function (...values) {
      of(this.canvas).colors.add(String(this.fillStyle));
      fillRect.apply(this, values);
    };
  });

/** What a demo shows in words and colors within some steps. */
interface Shown {
  id: string;
  labels: string[];
  names: readonly string[];
  picture: Drawn;
  array: Drawn | undefined;
  said: string[];
  /** The colors that its legend explains, as they are painted. */
  legend: string[];
  /** For each color of a demo, what it is called. */
  palette: Record<string, string>;
}

for (const colorScheme of ["light", "dark"] as const) {
  test(`${colorScheme}: narration, array and picture of each demo have its names, and its legend has each of its colors`, async ({ page }) => {
    test.slow(); // three dozen demos
    await watchDrawing(page);
    await page.emulateMedia({ reducedMotion: "reduce", colorScheme });
    await page.goto("/#d2");
    await page.locator("#d2 sap-demo").scrollIntoViewIfNeeded();
    await page.evaluate(() => customElements.whenDefined("sap-demo"));
    const all = await page.locator(".sections sap-demo:not([labels=emoji])").evaluateAll(async (demos) => {
      const { drawnOn } = window as unknown as { drawnOn(canvas: HTMLCanvasElement, isNew: boolean): Drawn };
      const shown: Shown[] = [];
      for (const demo of demos as SapDemo[]) {
        await demo.ready;
        demo.scrollIntoView({ block: "center", behavior: "instant" });
        const inside = demo.shadowRoot!;
        const [picture, array] = [inside.querySelector<HTMLCanvasElement>(".picture canvas")!, inside.querySelector<HTMLCanvasElement>("canvas.array")];
        const said = new Set<string>();
        for (let step = 0; step < 90; step++) {
          if (step > 0 && !demo.hasAttribute("static")) demo.step();
          if (step % 3 === 0 || demo.hasAttribute("static")) await new Promise(requestAnimationFrame);
          said.add(inside.querySelector(".said")?.textContent ?? "");
          if (demo.hasAttribute("static") && step > 3) break;
        }
        const palette: Record<string, string> = {};
        const context = new OffscreenCanvas(1, 1).getContext("2d")!;
        for (const probe of inside.querySelectorAll<HTMLElement>("span > i")) {
          context.fillStyle = getComputedStyle(probe).color;
          palette[context.fillStyle] ??= /--_(\w+)/.exec(probe.style.color)![1]!;
        }
        const place = demo.closest("sap-comparison") ?? demo.closest(".two") ?? demo.closest("figure")!;
        const legends = [demo.closest("figure")!.querySelector(".legend"), place.nextElementSibling?.matches(".legend") ? place.nextElementSibling : null];
        const swatches = legends.flatMap((legend) => [...(legend?.querySelectorAll("svg [stroke], svg [fill], svg [style]") ?? [])]);
        const legend = swatches.flatMap((swatch) => [getComputedStyle(swatch).stroke, getComputedStyle(swatch).fill]).map((color) => ((context.fillStyle = color), String(context.fillStyle)));
        shown.push({
          id: demo.closest("figure")?.id || demo.getAttribute("aria-label")!,
          labels: demo.getAttribute("labels")?.split(",") ?? [],
          names: demo.names,
          picture: drawnOn(picture, true),
          array: array ? drawnOn(array, true) : undefined,
          said: [...said],
          legend,
          palette,
        });
        demo.reset();
        demo.pause();
      }
      return shown;
    });
    expect(all.length).toBeGreaterThan(30);
    let colored = 0;
    for (const { id, labels, names, picture, array, said, legend, palette } of all) {
      expect(names, id).toEqual(labels);
      // A wall has no label.
      expect([...picture.texts].sort(), `${id}: letters in the picture`).toEqual(labels.filter((name) => name !== "wall").sort());
      const endpoints = names.flatMap((name) => [`(${name}`, `${name})`]);
      if (array) expect([...array.texts].sort(), `${id}: cells of the array`).toEqual([...endpoints].sort());
      for (const text of said) {
        for (const [, endpoint] of text.matchAll(/(\([A-Z]|[A-Z]\))/g)) expect(endpoints, `${id}: ${text}`).toContain(endpoint);
        for (const [, name] of text.matchAll(/(?<![A-Za-z(])([A-Z])(?![a-z)])/g)) expect(names, `${id}: ${text}`).toContain(name);
      }
      // Ground, ink, outlines and balls explain themselves, and so does a cell.
      const own = new Set(["stage", "ink", "muted", "line", "ball"]);
      const drawn: string[] = [...new Set([...picture.colors, ...(array?.colors ?? [])])].filter((color) => palette[color] && !own.has(palette[color]));
      colored += drawn.length;
      expect.soft(drawn.filter((color) => !legend.includes(color)).map((color) => palette[color]), `${id}: drawn, and not in the legend`).toEqual([]);
    }
    expect(colored, "the colors were seen").toBeGreaterThan(60);
  });
}

test("no sentence names a color that another theme draws in another", async ({ page }) => {
  await page.goto("/");
  const text = await page.locator(".sections").innerText();
  expect(text.match(/.{30}\b(red|green|blue|ocher|salmon|pink|purple|orange|teal)\b.{20}/gi)).toBeNull();
});

/** The listing that follows each demo. */
const LISTINGS = { d2: "pairwise", d5: "sorted-pairwise", d11: "sweep-and-prune", d14: "quicksort", d15: "insertion-sort", d18: "swap-driven", d12: "swap-all-axes", d10: "sweep", "every-axis-demo": "sweep-all-axes" };

/** Lines at work for what the code itself does not report to a demo, by the kind of event. */
const WORDING: Readonly<Record<string, RegExp>> = {
  enter: /if \(isLeft\)|sweep\(endpoints/,
  leave: /touching\.delete|sweep\(endpoints/,
  skip: /break;/,
  swap: /endpoints\[(j( \+ 1)?|i\+\+|j--)\] = /,
  flag: /flags\.set/,
  start: /quicksort\(endpoints\)|sweep\(endpoints/,
};

interface Stop {
  event: DemoEvent | undefined;
  lines: { number: number; text: string }[];
}

test("at each stop of each algorithm, the highlighted line is the one that runs", async ({ page }) => {
  test.slow(); // each demo twice
  await page.emulateMedia({ reducedMotion: "reduce" });
  await page.goto("/#d2");
  for (const [id, name] of Object.entries(LISTINGS)) {
    const demo = await new Demo(page, id).open();
    const listing = page.locator(`.listing[data-follows="${id}"]`);
    await listing.evaluate((element) => element.closest("details")?.setAttribute("open", ""));
    const walk = (steps: number): Promise<Stop[]> =>
      demo.root.evaluate(async (element, [steps, id]) => {
        const demo = element as SapDemo;
        demo.reset();
        demo.pause();
        // Edited code runs in a worker, which may take its time.
        await demo.settled;
        const stops: Stop[] = [];
        for (let step = 0; step < steps; step++) {
          demo.step();
          await demo.settled;
          for (let frame = 0; frame < 2; frame++) await new Promise(requestAnimationFrame);
          const lines = [...document.querySelectorAll(`.listing[data-follows="${id}"] pre .line`)];
          const atWork = lines.flatMap((line, at) => (line.classList.contains("at-work") ? [{ number: at + 1, text: line.textContent! }] : []));
          stops.push({ event: demo.event, lines: atWork });
        }
        return stops;
      }, [steps, id] as const);
    const stops = await walk(110);
    const kinds = new Set(stops.map(({ event }) => event?.kind ?? "none"));
    expect(kinds.size, `${id} shows ${[...kinds].join(", ")}`).toBeGreaterThan(1);
    for (const { event, lines } of stops) {
      if (!event) expect(lines, `${id}: nothing is at work`).toEqual([]);
      else expect(lines.length, `${id}: ${event.kind} has a line`).toBeGreaterThan(0);
      if (event && WORDING[event.kind]) for (const { text } of lines) expect(text, `${id}: ${event.kind}`).toMatch(WORDING[event.kind]!);
    }
    // The code itself, line by line, in the place of the compiled algorithm.
    await listing.scrollIntoViewIfNeeded();
    await listing.getByRole("button", { name: "Edit" }).click();
    await expect(listing.locator(".editor-said")).toHaveText("The demo runs this code. Change it.");
    const ran = (await walk(110)).flatMap(({ event }) => (event?.line === undefined ? [] : [event]));
    await listing.getByRole("button", { name: "Done" }).click();
    for (const kind of ["test", "compare", "overlap"] as const) {
      const mine = ran.filter((event) => event.kind === kind);
      const shown = stops.filter(({ event }) => event?.kind === kind);
      const key = ({ a, b }: DemoEvent): string => [a, b].sort((a, b) => a - b).join();
      // What both did in the same order, from the start on; a full sweep at the start is no stop of the compiled one.
      const count = Math.min(mine.length, shown.length);
      let compared = 0;
      for (let at = 0; at < count && key(mine[at]!) === key(shown[at]!.event!); at++, compared++) {
        expect(shown[at]!.lines.map(({ number }) => number), `${id}: ${kind} ${at}`).toContain(mine[at]!.line);
        if (name === "quicksort") expect(shown[at]!.lines).toHaveLength(1);
      }
      if (["pairwise", "sorted-pairwise", "quicksort"].includes(name) && count > 0) expect(compared, `${id}: ${kind}`).toBe(count);
    }
    if (name === "quicksort") expect(new Set(stops.flatMap(({ event, lines }) => (event?.kind === "compare" ? lines.map(({ text }) => text.trim()) : []))).size, "both loops").toBe(2);
  }
});

test("swap-driven demos begin sorted: their first detection is one stop that says so, and no comparison of it is shown", async ({ page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  await page.goto("/#d12");
  for (const id of ["d12", "d16", "d18"]) {
    const demo = await new Demo(page, id).open();
    const texts = await demo.root.evaluate(async (element) => {
      const demo = element as SapDemo;
      demo.reset();
      demo.pause();
      const texts: string[] = [];
      for (let step = 0; step < 120; step++) {
        demo.step();
        await new Promise(requestAnimationFrame);
        texts.push(demo.shadowRoot!.querySelector(".said")!.textContent!);
      }
      return texts;
    });
    expect(texts[0], id).toContain("Once, at the start");
    expect(texts.filter((text) => text.includes("Once, at the start")), id).toHaveLength(1);
    for (const text of texts) {
      const [, p, q] = /^(?:Swap|Compare) (\S+) (?:and|with) ([^\s:.]+)/.exec(text) ?? [];
      if (p && text.startsWith("Swap")) expect(p.replace(/\W/g, ""), `${id}: two ends of one ball never swap: ${text}`).not.toBe(q!.replace(/\W/g, ""));
    }
    expect(texts.some((text) => /^(Swap|Compare)/.test(text)), id).toBe(true);
  }
});

test("what the pointer or the focus is on lights up with all that belongs to it", async ({ page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  await page.goto("/#d2");
  const demo = await new Demo(page, "d2").open();
  const unit = page.locator(".beside", { has: page.locator("#d2") });
  const marked = (): Promise<unknown> => demo.root.evaluate((element) => (element as SapDemo).marked);
  const entry = unit.locator(".legend li", { hasText: "tested" });
  // What follows the pointer and the focus is loaded after the demo.
  await expect(async () => {
    await entry.blur();
    await entry.focus();
    expect(await marked()).toEqual({ color: "check" });
  }).toPass();
  await expect(unit.locator("figcaption .is-test").first()).toHaveClass(/marked/);
  await expect(unit.locator(".listing .line.marked")).toHaveText(/overlaps\(a, b\)/);
  await expect(unit.locator(".is-overlap.marked")).toHaveCount(0);
  await page.keyboard.press("ArrowRight");
  await expect.poll(marked).toEqual({ color: "overlap" });
  await unit.locator("figcaption .is-test").first().hover();
  await expect.poll(marked).toEqual({ color: "check" });
  await page.mouse.move(0, 0);
  await expect.poll(marked).toBeUndefined();
  await unit.locator(".listing .line", { hasText: "overlaps(a, b)" }).hover();
  await expect.poll(marked).toEqual({ color: "check" });

  // A ball and its two endpoints.
  const of = await new Demo(page, "d7").open();
  const array = of.root.locator("canvas.array");
  /** How much of each canvas has the color of what is chosen. */
  const chosen = (): Promise<number[]> =>
    of.root.evaluate(async (element) => {
      for (let frame = 0; frame < 2; frame++) await new Promise(requestAnimationFrame);
      const probe = element.shadowRoot!.querySelector<HTMLElement>('span > i[style*="--_chosen"]')!;
      const [red, green, blue] = getComputedStyle(probe).color.match(/\d+/g)!.map(Number);
      return [...element.shadowRoot!.querySelectorAll("canvas")].map((canvas) => {
        const { data } = canvas.getContext("2d")!.getImageData(0, 0, canvas.width, canvas.height);
        let count = 0;
        for (let at = 0; at < data.length; at += 4) count += Number(data[at] === red && data[at + 1] === green && data[at + 2] === blue);
        return count;
      });
    });
  await page.mouse.move(0, 0);
  await expect.poll(chosen).toEqual([0, 0]);
  await array.hover({ position: { x: 20, y: 15 } });
  const [ring = 0, cells = 0] = await chosen();
  expect(ring, "the ball").toBeGreaterThan(50);
  expect(cells, "its cells").toBeGreaterThan(50);
  await page.mouse.move(0, 0);
  const picture = (await of.root.locator(".picture").boundingBox())!;
  const [x = 0, y = 0] = (await of.balls())[2]!;
  await page.mouse.move(picture.x + (x * picture.width) / 600, picture.y + (y * picture.width) / 600);
  expect((await chosen()).every((count) => count > 50)).toBe(true);
  await frames(page, 1);
});
