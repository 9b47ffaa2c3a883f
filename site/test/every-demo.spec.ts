// What holds for every demo of the article, as it stands there: the given balls, in their place.
import { expect, type Locator, test } from "@playwright/test";
import type { SapDemo } from "sweep-and-prune-classroom/demo";
import { complaints } from "./support/pages.ts";

/** All that a demo shows at a moment, and those that show the same world. */
const momentOf = (demo: Locator): Promise<unknown[]> =>
  demo.evaluate((element: SapDemo) => {
    const all = [element, ...(element.closest("sap-comparison")?.querySelectorAll<SapDemo>("sap-demo") ?? [])];
    return all.map(({ state, event, balls, pairs }) => [state, event, balls, pairs]);
  });

/** The demos are loaded when a reader comes near the first of them. */
const readyOf = (demo: Locator): Promise<void> =>
  demo.evaluate(async (element: SapDemo) => {
    await customElements.whenDefined("sap-demo");
    await element.ready;
  });

const keys = async (demo: Locator, key: string, times: number): Promise<unknown[]> => {
  const moments: unknown[] = [];
  for (let time = 0; time < times; time++) {
    await demo.page().keyboard.press(key);
    moments.push(await momentOf(demo));
  }
  return moments;
};

/** A demo, paused at a moment that nothing but time and keys may change. */
interface Paused {
  demo: Locator;
  name: string;
  moment: unknown;
}

const canvasOf = ({ demo }: Paused): Locator => demo.locator(".picture canvas");

const isFitted = (paused: Paused): Promise<boolean> =>
  canvasOf(paused).evaluate((canvas: HTMLCanvasElement) => Math.abs(canvas.width - canvas.clientWidth * devicePixelRatio) <= 1 && canvas.width > 0);

/** The sum of all that is painted, some pictures later. */
const looks = (paused: Paused): Promise<number> =>
  canvasOf(paused).evaluate(async (canvas: HTMLCanvasElement) => {
    for (let frame = 0; frame < 3; frame++) await new Promise(requestAnimationFrame);
    const { width, height } = canvas;
    const copy = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true })!;
    copy.drawImage(canvas, 0, 0);
    return copy.getImageData(0, 0, width, height).data.reduce((sum, value) => sum + value, 0);
  });

test("every demo: keys alone step it, back and forward again is the same, neither size nor theme disturbs it", async ({ page }) => {
  test.setTimeout(900_000); // three dozen demos, each for several seconds, on a machine that may be busy
  const heard = complaints(page);
  await page.emulateMedia({ colorScheme: "light" });
  await page.goto("/");
  const demos = page.locator("sap-demo");
  const count = await demos.count();
  expect(count).toBeGreaterThan(30);
  const all: Paused[] = [];
  let moving = 0;
  for (let at = 0; at < count; at++) {
    const demo = demos.nth(at);
    const name = await demo.evaluate((element) => `${element.closest("figure")?.id} ${element.getAttribute("aria-label")}`);
    await test.step(name, async () => {
      await demo.scrollIntoViewIfNeeded();
      await readyOf(demo);
      await demo.evaluate((element: SapDemo) => (element.pause(), element.reset(), element.pause()));
      const picture = demo.locator(".picture");
      await picture.focus();
      await expect(picture).toBeFocused();

      const isStatic = await demo.evaluate((element) => element.hasAttribute("static"));
      if (isStatic) {
        // Where something is asked first, it is guessed first.
        const guess = demo.locator("[part=guess] button");
        while ((await guess.count()) > 0) await guess.first().click();
        await picture.focus();
        // What stands still is moved by hand: the ball at the cursor, and the algorithm runs again.
        const before = await momentOf(demo);
        await page.keyboard.press("ArrowRight");
        const pushed = await momentOf(demo);
        expect(pushed, name).not.toEqual(before);
        await page.keyboard.press("ArrowLeft");
        expect(await demo.evaluate((element: SapDemo) => element.balls), name).toEqual((before[0] as unknown[])[2]);
      } else {
        moving++;
        const forward = await keys(demo, ".", 7);
        expect(new Set(forward.map((moment) => JSON.stringify(moment))).size, name).toBeGreaterThan(4);
        const back = await keys(demo, ",", 6);
        expect(back.reverse(), name).toEqual(forward.slice(0, -1));
        expect(await keys(demo, ".", 6), name).toEqual(forward.slice(1));
      }
      await expect(demo.locator('[role="status"]'), name).not.toBeEmpty();
      all.push({ demo, name, moment: await momentOf(demo) });
    });
  }
  expect(moving).toBeGreaterThan(15);

  // Each change of size or theme is made once for the whole page: laying it out again is what takes time.
  const inView = async (check: (paused: Paused, at: number) => Promise<void>): Promise<void> => {
    for (const [at, paused] of all.entries()) {
      await paused.demo.scrollIntoViewIfNeeded();
      await check(paused, at);
    }
  };
  for (const width of [390, 1280]) {
    await page.setViewportSize({ width, height: 900 });
    await inView((paused) => expect.poll(() => isFitted(paused), { message: `${paused.name} at ${width} pixels` }).toBe(true));
  }
  const light: number[] = [];
  await inView(async (paused) => void light.push(await looks(paused)));
  const change = async (paused: Paused, at: number): Promise<number> => Math.abs((await looks(paused)) / light[at]! - 1);
  await page.emulateMedia({ colorScheme: "dark" });
  await inView((paused, at) => expect.poll(() => change(paused, at), { message: `${paused.name} is dark` }).toBeGreaterThan(0.003));
  await page.emulateMedia({ colorScheme: "light" });
  await inView((paused, at) => expect.poll(() => change(paused, at), { message: `${paused.name} is light again` }).toBeLessThan(0.001));
  for (const { demo, name, moment } of all) expect(await momentOf(demo), `${name} after another size and theme`).toEqual(moment);
  expect(heard).toEqual([]);
});

test("every demo of the article plays", async ({ page }) => {
  test.slow();
  await page.goto("/");
  for (const demo of await page.locator("sap-demo:not([static])").all()) {
    await demo.scrollIntoViewIfNeeded();
    await readyOf(demo);
    await demo.evaluate((element: SapDemo) => element.play());
    const { tick, events } = await demo.evaluate((element: SapDemo) => element.state);
    const goesOn = (): Promise<boolean> =>
      demo.evaluate((element: SapDemo, before) => element.state.tick !== before.tick || element.state.events !== before.events, { tick, events });
    await expect.poll(goesOn, { message: (await demo.getAttribute("aria-label")) ?? "" }).toBe(true);
  }
});
