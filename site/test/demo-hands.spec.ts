// `<sap-demo>` in the hands of a visitor: keys, a mouse, a finger, questions, guesses, what is shared.
import { expect, test } from "@playwright/test";
import type { SapDemo } from "sweep-and-prune-classroom/demo";
import { type Attributes, complainOfNothing, counter, open, pairwise, stateOf } from "./support/embedded.ts";
import { frames, settled } from "./support/frames.ts";

complainOfNothing();

test("keys alone: step, back, play, pause, and a ball moved", async ({ page }) => {
  const demo = await open(page, { balls: "[[150,250,50],[300,150,55],[450,275,60]]", static: "", draggable: "", labels: "A,B,C", decorations: "checks" });
  await page.keyboard.press("Tab");
  await expect(demo.locator(".picture")).toBeFocused();
  const before = await demo.evaluate((element: SapDemo) => element.balls[1]![0]);
  await page.keyboard.press("b");
  await page.keyboard.press("b");
  for (let count = 0; count < 4; count++) await page.keyboard.press("Shift+ArrowLeft");
  expect(await demo.evaluate((element: SapDemo) => element.balls[1]![0])).toBe(before - 100);
  expect(await counter(demo, "tests")).toBe("1");
  await expect(demo.locator('[role="status"]'), "it says where the ball is").toContainText("B is at 200, 150.");
  await page.keyboard.press(",");
  await expect.poll(() => demo.evaluate((element: SapDemo) => element.event?.kind)).toBeDefined();
  await expect(demo.locator('[role="status"]')).not.toBeEmpty();

  const moving = await open(page, pairwise);
  await page.keyboard.press("Tab");
  for (let count = 0; count < 3; count++) await page.keyboard.press(".");
  expect((await stateOf(moving)).tests).toBe(3);
  await page.keyboard.press("[");
  expect((await stateOf(moving)).tests).toBe(2);
  await page.keyboard.press("]");
  expect((await stateOf(moving)).tests).toBe(3);
  await expect(moving.locator('[role="status"]')).toContainText("Test");
  await page.keyboard.press("Space");
  await expect.poll(() => moving.evaluate((element: SapDemo) => element.isPlaying), { message: "space plays" }).toBe(true);
  await page.keyboard.press("Space");
  await expect.poll(() => moving.evaluate((element: SapDemo) => element.isPlaying), { message: "space pauses" }).toBe(false);
  for (const name of ["Play", "Step back", "Step", "Moment", "Speed", "Reset", "New world", "Share or embed"]) {
    await page.keyboard.press("Tab");
    await expect(moving.getByLabel(name, { exact: true })).toBeFocused();
  }
  await moving.getByRole("button", { name: "Play" }).press("Enter");
  await expect.poll(async () => (await stateOf(moving)).tick).toBeGreaterThan(5);
  await moving.getByRole("button", { name: "Pause" }).press("Enter");
  const { tick } = await stateOf(moving);
  await frames(page, 20);
  expect((await stateOf(moving)).tick).toBe(tick);
  await moving.evaluate((element: SapDemo) => {
    element.removeAttribute("paused");
    element.pause();
    element.reset();
  });
  expect(await moving.evaluate((element: SapDemo) => element.isPlaying), "reset leaves a paused demo paused").toBe(false);
});

test("a ball is dragged by a mouse, and goes no further than the wall", async ({ page }) => {
  const demo = await open(page, { balls: "[[150,250,50],[300,150,55]]", static: "", draggable: "", decorations: "checks" });
  const reported = await demo.evaluateHandle((element: SapDemo) => {
    const balls: number[] = [];
    element.addEventListener("sap-drag", ({ detail }) => balls.push(detail.ball));
    return balls;
  });
  const box = (await demo.locator(".picture").boundingBox())!;
  const scale = box.width / 600;
  await page.mouse.move(box.x + 150 * scale, box.y + 250 * scale);
  await page.mouse.down();
  await page.mouse.move(box.x + 250 * scale, box.y + 160 * scale, { steps: 5 });
  await page.mouse.move(-50, box.y + 160 * scale, { steps: 5 });
  await page.mouse.up();
  const [x, y] = await demo.evaluate((element: SapDemo) => element.balls[0]!);
  expect(x, "held outside the picture, stopped by the wall").toBe(50);
  expect(y).toBeCloseTo(160, 0);
  expect(await reported.evaluate((balls) => [...new Set(balls)])).toEqual([0]);
  await demo.evaluate((element: SapDemo) => element.seek(0));
  expect((await demo.evaluate((element: SapDemo) => element.balls[0]!))[0], "a drag can be undone").toBe(150);
});

test("a finger drags a ball without scrolling, and scrolls where there is none", async ({ browser, baseURL }) => {
  const context = await browser.newContext({ baseURL: baseURL!, hasTouch: true, viewport: { width: 390, height: 700 } });
  const page = await context.newPage();
  const demo = await open(page, { balls: "[[300,200,60]]", static: "", draggable: "" });
  await page.evaluate(() => (document.body.style.minHeight = "3000px"));
  const box = (await demo.locator(".picture").boundingBox())!;
  const client = await context.newCDPSession(page);
  const swipe = async (x: number, y: number, dy: number): Promise<void> => {
    const at = (y: number): { touchPoints: { x: number; y: number }[] } => ({ touchPoints: [{ x, y }] });
    await client.send("Input.dispatchTouchEvent", { type: "touchStart", ...at(y) });
    for (let share = 1; share <= 10; share++) {
      await client.send("Input.dispatchTouchEvent", { type: "touchMove", ...at(y + (dy * share) / 10) });
      await frames(page, 1);
    }
    await client.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
  };
  await swipe(box.x + box.width / 2, box.y + box.height / 2, -60);
  expect((await demo.evaluate((element: SapDemo) => element.balls[0]!))[1]).toBeCloseTo(200 - (60 * 600) / box.width, 0);
  expect(await page.evaluate(() => scrollY)).toBe(0);
  await swipe(box.x + 20, box.y + box.height - 10, -150);
  await expect.poll(() => page.evaluate(() => scrollY)).toBeGreaterThan(50);
  await context.close();
});

test("why a pair was tested or skipped, with the numbers", async ({ page }) => {
  const demo = await open(page, { balls: "[[100,200,50],[300,200,50],[500,200,50],[320,120,60]]", static: "", explain: "", labels: "A,B,C,D" });
  const said = demo.locator('[part="said"]');
  const picture = (await demo.locator(".picture").boundingBox())!;
  const scale = picture.width / 600;
  const click = (x: number, y: number): Promise<void> => page.mouse.click(picture.x + x * scale, picture.y + y * scale);
  await click(100, 200);
  await click(300, 210);
  await expect(said).toHaveText("A and B were skipped: A’s right 150 < B’s left 250, and the scan from A stopped here.");
  await click(100, 200);
  await click(500, 200);
  await expect(said).toHaveText("A and C were skipped: the scan from A had stopped at B, A’s right 150 < B’s left 250, and C begins later still, at 450.");
  await click(300, 210);
  await click(320, 90);
  await expect(said).toContainText("were tested, and their boxes overlap: on x D’s left 260 ≤ B’s right 350, on y B’s top 150 ≤ D’s bottom 180.");
  await expect(demo.locator('[role="status"]')).toContainText("were tested");
  // By keys: Tab, then B until the ball is reached, and Enter.
  await page.keyboard.press("Escape");
  for (const key of ["b", "Enter", "b", "b", "Enter"]) await page.keyboard.press(key);
  await expect(said).toContainText("A and C were skipped");
});

test("a guess is asked for before each event, and counted", async ({ page }) => {
  const demo = await open(page, { ...pairwise, predict: "" });
  const group = demo.getByRole("group", { name: "What happens next?" });
  await expect(group).toContainText("are tested next");
  let right = 0;
  for (let made = 1; made <= 10; made++) {
    await group.getByRole("button", { name: "are apart" }).click();
    expect((await stateOf(demo)).tests).toBe(made);
    if (!(await group.textContent())!.includes("No:")) right++;
    await expect(group).toContainText(`${right} of ${made} right`);
  }
  expect(right).toBe(10 - (await demo.evaluate((element: SapDemo) => element.pairs.length)));
});

test("steps without a question are skipped, and a wrong guess is explained; also of a method that stops early", async ({ page }) => {
  for (const attributes of [{ strategy: "sweep", sort: "insertion", decorations: "edges:array" }, { strategy: "sorted-pairwise" }, { strategy: "swap", decorations: "edges:array", motion: "drift" }] as Attributes[]) {
    const demo = await open(page, { ...attributes, balls: "5", "skip-interval": "9", predict: "", labels: "A,B,C,D,E" });
    const group = demo.getByRole("group", { name: "What happens next?" });
    let wrong = 0;
    for (let made = 1; made <= 12; made++) {
      if (await group.getByRole("button", { name: "Next detection" }).isVisible()) {
        await expect(group).toContainText("That was all of this detection");
        const { tick } = await stateOf(demo);
        await group.getByRole("button").click();
        expect((await stateOf(demo)).tick).toBeGreaterThan(tick);
      }
      const choices = attributes["strategy"] === "swap" ? 3 : 2;
      await expect(group.getByRole("button"), `guess ${made} with ${JSON.stringify(attributes)}`).toHaveCount(choices);
      await group.getByRole("button").first().click();
      const text = (await group.textContent())!;
      if (text.includes("No:")) {
        wrong++;
        expect(text).toMatch(/No: (stay|swap|skipped|tested|are apart|overlap|enter a ball|leave one|one ends|nothing)\. .*(is at -?[\d.]+|<|overlap|Stop|Test|The line)/);
      }
    }
    expect(wrong, "so that the reason is seen").toBeGreaterThan(0);
  }
});

test("what is asked of a sort is not always answered by stay, and never of the two ends of one ball", async ({ page }) => {
  const demo = await open(page, { strategy: "sweep", sort: "insertion", balls: "4", seed: "7", "skip-interval": "9", decorations: "edges:array", predict: "", labels: "A,B,C,D" });
  const asked = await demo.evaluate(async (element: SapDemo) => {
    const group = element.shadowRoot!.querySelector(".guess")!;
    const asked: { text: string; isSwap: boolean; tick: number }[] = [];
    for (let press = 0; press < 200 && asked.length < 40; press++) {
      await new Promise(requestAnimationFrame);
      const [first] = group.querySelectorAll("button");
      const text = group.querySelector("p")!.textContent!;
      const { tick } = element.state;
      first!.click();
      await new Promise(requestAnimationFrame);
      if (text.includes("is compared with")) asked.push({ text, isSwap: group.textContent!.includes("Right."), tick });
    }
    return asked;
  });
  const later = asked.filter(({ tick }) => tick >= 10);
  expect(later.length).toBeGreaterThan(20);
  const swaps = later.filter(({ isSwap }) => isSwap).length / later.length;
  expect(swaps).toBeGreaterThan(0.3);
  expect(swaps).toBeLessThan(0.8);
  for (const { text } of asked) {
    const [, p = "", q = ""] = /(\S+) is compared with ([^\s.]+)/.exec(text)!;
    expect(p.replace(/\W/g, ""), text).not.toBe(q.replace(/\W/g, ""));
  }
});

test("what is shared paused opens paused, at the same stop", async ({ page }) => {
  const shown = (demo: SapDemo): string => JSON.stringify([demo.state, demo.event?.kind, demo.isPlaying, demo.shadowRoot?.querySelector(".said")?.textContent]);
  for (const attributes of [
    { strategy: "pairwise", balls: "6", "skip-interval": "4", decorations: "checks" },
    { strategy: "swap", balls: "5", "skip-interval": "2", decorations: "checks, edges:array" },
    { strategy: "sorted-pairwise", balls: "[[150,250,50],[180,150,55],[450,275,60]]", static: "", decorations: "checks" },
  ] as Attributes[]) {
    for (const steps of [0, 1, 31]) {
      const demo = await open(page, attributes);
      await demo.evaluate((element: SapDemo, steps) => {
        element.pause();
        element.reset();
        for (let step = 0; step < steps; step++) element.step();
      }, steps);
      // The sentence comes with a frame, on a busy machine a late one.
      const before = await settled(page, () => demo.evaluate(shown), "it has come to rest");
      const url = await demo.evaluate((element: SapDemo) => element.share());
      await page.goto("about:blank");
      await page.goto(url);
      await page.evaluate(() => customElements.whenDefined("sap-demo"));
      await demo.evaluate((element: SapDemo) => element.ready);
      await expect.poll(() => demo.evaluate(shown), { message: url }).toBe(before);
      await frames(page, 30);
      expect(await demo.evaluate(shown), "and it stays there").toBe(before);
    }
  }
});

test("what is shared with balls at the walls can be opened", async ({ page }) => {
  // Rounded, these would end outside: the first in numbers of any precision, the others of single or of double precision only.
  const demo = await open(page, { balls: "[[300,150,20.045],[150,300,32.08],[450,300,32.09],[300,200,200]]", static: "", draggable: "" });
  await demo.locator(".picture").focus();
  for (const [key, times] of [["ArrowRight", 12], ["ArrowDown", 4], ["ArrowDown", 4]] as const) {
    await page.keyboard.press("b");
    for (let press = 0; press < times; press++) await page.keyboard.press(`Shift+${key}`);
  }
  const balls = (): Promise<number[][]> => demo.evaluate((element: SapDemo) => element.balls.map((row) => row.map(Number)));
  const before = await balls();
  expect(before[0]![0]).toBeCloseTo(600 - 20.045, 3);
  const url = await demo.evaluate((element: SapDemo) => element.share());
  await page.goto("about:blank");
  await page.goto(url);
  await demo.evaluate((element: SapDemo) => element.ready);
  await expect(demo.getByRole("alert")).toHaveCount(0);
  const after = await balls();
  expect(after).toHaveLength(before.length);
  for (const [ball, row] of after.entries()) for (const [at, value] of row.entries()) expect(Math.abs(value - before[ball]![at]!)).toBeLessThan(0.02);
});

test("what is shared opens as it was", async ({ page }) => {
  const demo = await open(page, { strategy: "swap", balls: "7", seed: "42", decorations: "checks:#4c8", paused: "" });
  await demo.evaluate((element: SapDemo) => {
    while (element.state.tick < 20) element.step();
  });
  const { hash, tick } = await stateOf(demo);
  const [url, code] = await demo.evaluate((element: SapDemo) => [element.share(), element.embedCode()]);
  expect(code!.split("\n").length).toBeLessThanOrEqual(5);
  expect(code).toContain("<iframe");
  await page.goto("about:blank");
  await page.goto(url!);
  await page.evaluate(() => customElements.whenDefined("sap-demo"));
  await demo.evaluate((element: SapDemo) => (element.pause(), element.ready));
  await expect.poll(async () => (await stateOf(demo)).tick).toBeGreaterThanOrEqual(tick);
  await demo.evaluate((element: SapDemo) => element.seek(0));
  await demo.evaluate((element: SapDemo) => {
    while (element.state.tick < 20) element.step();
  });
  expect(await stateOf(demo)).toMatchObject({ tick, hash });
  await demo.getByRole("button", { name: "Share or embed" }).click();
  await expect(demo.getByLabel("Link to this demo")).toHaveValue(/embed\.html#/);
});
