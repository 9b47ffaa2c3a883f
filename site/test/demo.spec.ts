// `<sap-demo>` in a page: its attributes, its life, its looks.
import { expect, test } from "@playwright/test";
import type { SapDemo } from "sweep-and-prune-classroom/demo";
import { type Attributes, complainOfNothing, open, pairwise, stateOf, step } from "./support/embedded.ts";
import { frames, settled } from "./support/frames.ts";
import { violations } from "./support/pages.ts";

complainOfNothing();

test("bad attributes are said in its place, once, and can be mended", async ({ page }) => {
  for (const [attributes, message] of [
    [{ balls: "many" }, /balls="many"/],
    [{ balls: "[[1,2],[3]]" }, /number 0/],
    [{ balls: "[[50,50,20],[590,50,20]]" }, /number 1/],
    [{ balls: "[[" }, /not valid JSON/],
    [{ balls: "401" }, /from 0 to 400/],
    [{ strategy: "magic" }, /use one of pairwise/],
    [{ sort: "bogo" }, /quicksort/],
    [{ axis: "z" }, /widest/],
    [{ decorations: "glitter" }, /glitter/],
    [{ decorations: "checks:nocolor" }, /nocolor/],
    [{ focus: "5", balls: "5" }, /there are 5 balls/],
    [{ seed: "-1" }, /seed/],
    [{ speed: "0" }, /speed/],
    [{ variant: "bench" }, /one-to-n/],
  ] as [Attributes, RegExp][]) {
    const demo = await open(page, attributes);
    await expect(demo.getByRole("alert")).toHaveText(message);
    await demo.evaluate((element: SapDemo) => {
      for (const { name } of [...element.attributes]) element.removeAttribute(name);
    });
    await expect(demo.getByRole("alert")).toHaveCount(0);
    await expect.poll(async () => (await stateOf(demo)).tick).toBeGreaterThan(1);
  }
});

test("attributes change while it runs, and the world goes on where it was", async ({ page }) => {
  const demo = await open(page, { strategy: "pairwise", balls: "12" });
  await expect.poll(async () => (await stateOf(demo)).tick).toBeGreaterThan(10);
  const { tick } = await stateOf(demo);
  await demo.evaluate((element: SapDemo) => element.setAttribute("strategy", "sweep"));
  await expect.poll(async () => (await stateOf(demo)).comparisons).toBeGreaterThan(0);
  expect((await stateOf(demo)).tick).toBeGreaterThanOrEqual(tick);
  await demo.evaluate((element: SapDemo) => Object.assign(element, { paused: true }));
  await expect(demo.getByRole("button", { name: "Play" })).toBeVisible();
  await demo.evaluate((element: SapDemo) => (element.balls = 3));
  await expect.poll(() => demo.evaluate((element: SapDemo) => element.balls.length)).toBe(3);
});

test("what has run for more than a minute is shared as it is, at an address that can be opened", async ({ page }) => {
  const demo = await open(page, { strategy: "sweep", paused: "" });
  await expect.poll(() => demo.evaluate((element: SapDemo) => element.balls.length)).toBeGreaterThan(0);
  const address = await demo.evaluate((element: SapDemo) => {
    while (element.state.tick <= 3600) for (let step = 0; step < 500; step++) element.step();
    return element.share();
  });
  expect(new URLSearchParams(new URL(address).hash.slice(1)).get("start")).toBeNull();
  await page.goto(address);
  await expect(page.locator("sap-demo").getByRole("button", { name: "Step", exact: true })).toBeEnabled();
  await expect(page.locator("sap-demo").getByRole("alert")).toHaveCount(0);
});

test("it can be moved, removed and added; many live on one page", async ({ page }) => {
  const demo = await open(page, { strategy: "sweep" });
  await expect.poll(async () => (await stateOf(demo)).tick).toBeGreaterThan(5);
  const ticks = await demo.evaluate(async (element: SapDemo) => {
    const before = element.state.tick;
    const place = document.createElement("section");
    document.querySelector("main")!.append(place);
    place.append(element);
    const moved = element.state.tick;
    // It goes on.
    while (element.state.tick <= moved) await new Promise(requestAnimationFrame);
    element.remove();
    for (let frame = 0; frame < 5; frame++) await new Promise(requestAnimationFrame);
    place.append(element);
    return [moved - before, element.state.tick];
  });
  expect(ticks).toEqual([0, 0]);
  await expect.poll(async () => (await stateOf(demo)).tick, "started again").toBeGreaterThan(2);
  const count = await page.evaluate(async () => {
    const all = Array.from({ length: 30 }, (_, index) => {
      const element = document.createElement("sap-demo");
      element.setAttribute("balls", String(index));
      document.querySelector("main")!.append(element);
      return element;
    });
    await Promise.all(all.map((element) => element.ready));
    for (let frame = 0; frame < 60; frame++) await new Promise(requestAnimationFrame);
    const ran = all.filter(({ state }) => state.tick > 0).length;
    for (const element of all) element.remove();
    return ran;
  });
  expect(count, "only those on the screen run").toBeLessThan(10);
  await demo.evaluate((element: SapDemo) => element.scrollIntoView());
});

test("it sleeps while it cannot be seen", async ({ page }) => {
  const demo = await open(page, {});
  await demo.evaluate((element: SapDemo) => ((element as HTMLElement).style.marginTop = "5000px"));
  const tick = await settled(page, async () => (await stateOf(demo)).tick, "it sleeps");
  await demo.evaluate((element: SapDemo) => element.scrollIntoView());
  await expect.poll(async () => (await stateOf(demo)).tick).toBeGreaterThan(tick);
});

test("with reduced motion it begins still, and can be stepped", async ({ page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  const demo = await open(page, pairwise);
  await frames(page, 20);
  expect((await stateOf(demo)).tick).toBe(0);
  await step(demo);
  expect((await stateOf(demo)).tests).toBe(1);
});

test("colors follow the page, also when it changes", async ({ page }) => {
  await page.emulateMedia({ colorScheme: "light" });
  const demo = await open(page, { paused: "", balls: "[[300,200,150]]" });
  const center = (): Promise<number> =>
    demo.locator(".picture canvas").evaluate((canvas: HTMLCanvasElement) => {
      const copy = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true })!;
      copy.drawImage(canvas, canvas.width / 2, canvas.height / 2, 1, 1, 0, 0, 1, 1);
      const [red = 0, green = 0, blue = 0] = copy.getImageData(0, 0, 1, 1).data;
      return red + green + blue;
    });
  await expect.poll(center).toBeGreaterThan(500);
  await page.emulateMedia({ colorScheme: "dark" });
  await expect.poll(center).toBeLessThan(300);
  await demo.evaluate((element: SapDemo) => element.style.setProperty("--sap-ball", "white"));
  await expect.poll(center).toBe(765);
});

test("the picture is as fine as the screen, at any width", async ({ browser }) => {
  const context = await browser.newContext({ deviceScaleFactor: 2, viewport: { width: 390, height: 800 } });
  const page = await context.newPage();
  const demo = await open(page, { paused: "", decorations: "checks,edges:array", balls: "12" });
  for (const width of [390, 320, 700]) {
    await page.setViewportSize({ width, height: 800 });
    const fits = (): Promise<boolean> =>
      demo.locator(".picture canvas").evaluate((canvas: HTMLCanvasElement) => canvas.width === canvas.clientWidth * 2 && canvas.height === canvas.clientHeight * 2);
    await expect.poll(fits).toBe(true);
    expect(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `${width}`).toBe(true);
    const { x, width: shown } = (await demo.boundingBox())!;
    for (const button of await demo.getByRole("button").all()) {
      const box = (await button.boundingBox())!;
      expect(box.x + box.width).toBeLessThanOrEqual(x + shown + 0.5);
    }
  }
  await context.close();
});

test("axe finds nothing", async ({ page }) => {
  for (const attributes of [
    pairwise,
    { static: "", draggable: "", explain: "", decorations: "edges:array", heading: "Six balls", balls: "6" },
    { ...pairwise, predict: "" },
    { balls: "wrong" },
  ] as Attributes[]) {
    for (const colorScheme of ["light", "dark"] as const) {
      await page.emulateMedia({ colorScheme });
      await open(page, attributes);
      expect(await violations(page)).toEqual([]);
    }
  }
});
