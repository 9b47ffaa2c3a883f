// `<sap-comparison>`: one world under several methods, always at the same tick.
import { expect, type Locator, type Page, test } from "@playwright/test";
import type { DemoState, SapDemo } from "sweep-and-prune-classroom/demo";
import { frames } from "./support/frames.ts";
import { complaints } from "./support/pages.ts";

const observations = process.env["TEST_LONG"] ? 300 : 15;

const statesOf = (comparison: Locator): Promise<{ tick: number; hash: string; tests: number; flagChecks: number; events: number; pairs: number; playing: boolean }[]> =>
  comparison.evaluate((element) => [...element.querySelectorAll<SapDemo>("sap-demo")].map((demo) => ({ ...demo.state, playing: demo.isPlaying })));

async function open(page: Page, id: string): Promise<Locator> {
  await page.goto(`/#${id}`);
  const comparison = page.locator(`#${id}`);
  await comparison.scrollIntoViewIfNeeded();
  await expect.poll(async () => (await statesOf(comparison).catch(() => []))[0]?.events ?? 0, { message: "it plays" }).toBeGreaterThan(2);
  return comparison;
}

const button = (comparison: Locator, name: string): Locator => comparison.getByRole("group", { name: "Controls" }).getByRole("button", { name, exact: true });

for (const [id, methods] of [["d6", 2], ["d13", 3]] as const) {
  test(`${id}: seen ${observations} times, at full speed and throttled, the tick is the same in all`, async ({ page }) => {
    const heard = complaints(page);
    const comparison = await open(page, id);
    const session = await page.context().newCDPSession(page);
    for (const rate of [1, 6]) {
      await session.send("Emulation.setCPUThrottlingRate", { rate });
      let last = 0;
      const moments = new Set<string>();
      for (let observation = 0; observation < observations; observation++) {
        const states = await statesOf(comparison);
        expect(states).toHaveLength(methods);
        expect(new Set(states.map(({ tick }) => tick)).size, JSON.stringify(states)).toBe(1);
        expect(new Set(states.map(({ hash }) => hash)).size, "one world").toBe(1);
        expect(states[0]!.tick).toBeGreaterThanOrEqual(last);
        last = states[0]!.tick;
        moments.add(`${last} ${states[0]!.events}`);
        await frames(page, 3);
      }
      expect(moments.size, "it goes on").toBeGreaterThan(3);
    }
    await session.send("Emulation.setCPUThrottlingRate", { rate: 1 });
    expect(heard).toEqual([]);
  });
}

test("the bars of the first detection grow with it", async ({ page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  await page.goto("/#d6");
  const comparison = page.locator("#d6");
  await comparison.scrollIntoViewIfNeeded();
  await expect(button(comparison, "Step")).toBeEnabled();
  for (let step = 0; step < 3; step++) await button(comparison, "Step").click();
  await expect(comparison.locator(".totals")).toContainText("The first detection, so far:");
  const tests = (await statesOf(comparison)).map(({ tests }) => tests);
  expect(tests[0]).toBe(3);
  await expect(comparison.locator(".totals b")).toHaveText(tests.map((count) => new RegExp(`^${count} tests`)));
  const widths = await comparison.locator(".totals i").evaluateAll((all) => all.map((bar) => bar.getBoundingClientRect().width));
  expect(Math.min(...widths)).toBeGreaterThan(50);
});

test("one set of controls: step, back, the slider, reset and a new world act on all", async ({ page }) => {
  const comparison = await open(page, "d13");
  await expect(comparison.getByRole("group", { name: "Controls" })).toHaveCount(1);
  await button(comparison, "Pause").click();
  const isStill = async (): Promise<boolean> => (await statesOf(comparison)).every(({ playing }) => !playing);
  expect(await isStill()).toBe(true);
  const [forward, back] = await comparison.evaluate((element) => {
    const press = (label: string): DemoState[] => {
      element.shadowRoot!.querySelector<HTMLButtonElement>(`[aria-label="${label}"]`)!.click();
      return [...element.querySelectorAll<SapDemo>("sap-demo")].map((demo) => demo.state);
    };
    const forward = Array.from({ length: 60 }, () => press("Step"));
    return [forward, Array.from({ length: 59 }, () => press("Step back"))] as const;
  });
  expect(new Set(forward.map(([state]) => state!.tick)).size, "more than one detection").toBeGreaterThan(2);
  for (const states of forward) {
    expect(new Set(states.map(({ tick }) => tick)).size).toBe(1);
    expect(new Set(states.map(({ hash }) => hash)).size).toBe(1);
  }
  expect([...back].reverse()).toEqual(forward.slice(0, -1));
  const moment = comparison.getByLabel("Moment");
  await moment.fill((await moment.getAttribute("max")) ?? "60");
  expect((await statesOf(comparison))[0]!.tick).toBeGreaterThan(0);
  await moment.fill("3");
  expect((await statesOf(comparison)).map(({ tick }) => tick)).toEqual([0, 0, 0]);
  await button(comparison, "Reset").click();
  expect((await statesOf(comparison)).map(({ tick }) => tick)).toEqual([0, 0, 0]);
  expect(await isStill(), "a world that was paused stays paused").toBe(true);
  const { hash } = (await statesOf(comparison))[0]!;
  await button(comparison, "New world").click();
  await expect.poll(async () => (await statesOf(comparison))[0]!.hash).not.toBe(hash);
  expect(new Set((await statesOf(comparison)).map(({ hash }) => hash)).size).toBe(1);
  expect(await isStill()).toBe(true);
});

test("a ball dragged in one moves in all; the bars are the totals of the last finished detection", async ({ page }) => {
  const comparison = await open(page, "d6");
  await button(comparison, "Pause").click();
  const demos = comparison.locator("sap-demo");
  const ballOf = (at: number): Promise<number[]> => demos.nth(at).evaluate((demo: SapDemo) => [...demo.balls[0]!].map(Number));
  const [x = 0, y = 0] = await ballOf(0);
  const picture = (await demos.first().locator(".picture").boundingBox())!;
  const scale = picture.width / 600;
  await page.mouse.move(picture.x + x * scale, picture.y + y * scale);
  await page.mouse.down();
  await page.mouse.move(picture.x + 300 * scale, picture.y + 200 * scale, { steps: 6 });
  await page.mouse.up();
  expect((await ballOf(0))[0]).toBeCloseTo(300, 0);
  expect(await ballOf(1)).toEqual(await ballOf(0));

  const finished = await comparison.evaluate(async (element) => {
    const controls = element.shadowRoot!;
    const step = controls.querySelector<HTMLButtonElement>("[aria-label=Step]")!;
    const [demo, sorted] = [...element.querySelectorAll<SapDemo>("sap-demo")];
    for (let steps = 0; steps < 60; steps++) step.click();
    const { tick } = demo!.state;
    let last = [demo!.state.tests, sorted!.state.tests];
    for (let steps = 0; steps < 200; steps++) {
      step.click();
      if (demo!.state.tick !== tick) break;
      last = [demo!.state.tests, sorted!.state.tests];
    }
    await new Promise(requestAnimationFrame);
    await new Promise(requestAnimationFrame);
    return { last, shown: [...controls.querySelectorAll<HTMLElement>("[data-total]")].map(({ dataset }) => Number(dataset["total"])) };
  });
  expect(finished.shown).toEqual(finished.last);
  expect(finished.shown[0]).toBe(45);
  expect(finished.shown[1]).toBeLessThan(45);
});

test("a world in which a ball was dragged is shared as it is, the same for all methods", async ({ page }) => {
  const comparison = await open(page, "d6");
  await button(comparison, "Pause").click();
  await comparison.locator("sap-demo").first().locator(".picture").focus();
  for (const key of ["b", "Shift+ArrowRight"]) await page.keyboard.press(key);
  await button(comparison, "Share or embed").click();
  const url = await comparison.getByLabel("Link to this demo").inputValue();
  await page.goto("about:blank");
  await page.goto(url);
  const shared = page.locator("sap-comparison");
  await expect.poll(async () => (await statesOf(shared).catch(() => [])).length).toBe(2);
  await expect.poll(async () => new Set((await statesOf(shared)).map(({ tick, hash }) => `${tick} ${hash}`)).size).toBe(1);
});

test("what is shared shows all methods again", async ({ page }) => {
  const comparison = await open(page, "d13");
  await button(comparison, "Share or embed").click();
  const url = await comparison.getByLabel("Link to this demo").inputValue();
  expect(url).toContain("seed=1");
  await page.goto("about:blank");
  await page.goto(url);
  const shared = page.locator("sap-comparison");
  await expect.poll(async () => (await statesOf(shared).catch(() => [])).length).toBe(3);
  await expect.poll(async () => (await statesOf(shared))[2]!.tick).toBeGreaterThan(3);
});
