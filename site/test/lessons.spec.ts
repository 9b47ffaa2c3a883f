// The demos that are there for one lesson each: what they show is what an independent calculation says.
import { expect, type Locator, test } from "@playwright/test";
import { Demo } from "./support/demo.ts";

test.beforeEach(({ page }) => page.goto("/"));

type Ball = number[];
const interval = ([x = 0, y = 0, r = 0]: Ball, axis: number): [number, number] => (axis === 0 ? [x - r, x + r] : [y - r, y + r]);
const meet = ([a, b]: [number, number], [c, d]: [number, number]): boolean => a <= d && c <= b;
const pairsOf = (balls: Ball[], meets: (a: Ball, b: Ball) => boolean): number =>
  balls.reduce((sum, a, at) => sum + balls.slice(at + 1).filter((b) => meets(a, b)).length, 0);
const on = (axis: number) => (a: Ball, b: Ball): boolean => meet(interval(a, axis), interval(b, axis));

/** One step, and what stands below the picture when it is painted. */
async function stepped(demo: Demo): Promise<{ balls: Ball[]; pairs: number; tick: number; text: string }> {
  return demo.root.evaluate(async (element) => {
    const demo = element as unknown as { step(): void; balls: number[][]; pairs: unknown[]; state: { tick: number } };
    demo.step();
    await new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
    return { balls: demo.balls, pairs: demo.pairs.length, tick: demo.state.tick, text: element.shadowRoot!.querySelector(".said")!.textContent! };
  });
}

const group = (demo: Demo): Locator => demo.root.getByRole("group", { name: "What happens next?" });

test("tunneling: boxes miss exactly the jumps over the wall, and swept boxes find them all", async ({ page }) => {
  const demo = await new Demo(page, "tunneling").open();
  const figure = page.locator("#tunneling");
  for (const [speed, isSwept] of [["450", false], ["450", true], ["100", false]] as const) {
    await figure.getByLabel("Speed of A").fill(speed);
    await figure.getByLabel("Test swept boxes").setChecked(isSwept);
    await demo.reset();
    let last = (await demo.balls())[1]!;
    let [jumps, found] = [0, 0];
    for (let frame = 0; frame < 20; frame++) {
      let now = await stepped(demo);
      // A test is a stop, and the end of the detection another.
      if (/^Test|^Stop/.test(now.text)) now = await stepped(demo);
      expect(now.text).toContain(`Tick ${now.tick}:`);
      const [wall, ball] = now.balls as [Ball, Ball];
      const swept: [number, number] = [Math.min(interval(last, 0)[0], interval(ball, 0)[0]), Math.max(interval(last, 0)[1], interval(ball, 0)[1])];
      const here = meet(interval(wall, 0), interval(ball, 0));
      const isJump = !here && !meet(interval(wall, 0), interval(last, 0)) && meet(interval(wall, 0), swept);
      jumps += Number(isJump);
      found += now.pairs;
      expect(now.text.includes("Missed: wall and A"), `frame ${frame} at ${speed}`).toBe(isJump && !isSwept);
      expect(now.pairs).toBe(Number(isSwept ? meet(interval(wall, 0), swept) : here));
      last = ball;
    }
    if (speed === "450") expect(jumps, "it does jump").toBeGreaterThan(0);
    else expect(jumps, "a slow ball is wider than its jump").toBe(0);
    expect(found).toBeGreaterThan(0);
  }
});

test("a sweep on every axis shows each flag as it is set", async ({ page }) => {
  const demo = await new Demo(page, "every-axis-demo").open();
  await demo.reset();
  const texts: string[] = [];
  let now = await stepped(demo);
  for (const { tick } = now; now.tick === tick; now = await stepped(demo)) texts.push(now.text);
  await demo.root.evaluate((element) => (element as unknown as { back(): void }).back());
  const balls = await demo.balls();
  const [x, both] = [pairsOf(balls, on(0)), pairsOf(balls, (a, b) => on(0)(a, b) && on(1)(a, b))];
  const count = (part: string): number => texts.filter((text) => text.includes(part)).length;
  expect(count("first flag")).toBe(x);
  expect(count("have both flags")).toBe(both);
  expect(count("only one flag")).toBe(pairsOf(balls, on(1)) - both);
  // The line crosses both axes.
  expect(count("The line enters")).toBe(2 * balls.length);
});

test("d17: swaps are counted since the drag began, flashed, and told as overlaps that begin and end", async ({ page }) => {
  await page.emulateMedia({ colorScheme: "light" });
  // From here on, the page's time passes when this test says so.
  await page.clock.install({ time: 0 });
  await page.reload();
  const demo = await new Demo(page, "d17").open();
  await page.clock.pauseAt(3_600_000);
  const log = demo.root.locator("[part=swap-log]");
  const flashes = (): Promise<boolean> =>
    demo.root.locator("canvas.array").evaluate((canvas: HTMLCanvasElement) => {
      const { data } = canvas.getContext("2d")!.getImageData(0, 0, canvas.width, canvas.height);
      // The color of a swap, #0059b8.
      for (let at = 0; at < data.length; at += 4) if (data[at] === 0 && data[at + 1] === 0x59 && data[at + 2] === 0xb8) return true;
      return false;
    });
  expect(await flashes()).toBe(false);
  await demo.drag(0, 160);
  await page.clock.runFor(50);
  expect(await flashes()).toBe(true);
  // Its right endpoint goes from 170 to 330: past the left ones of B (215) and C (285), and the right one of B (285).
  await expect(log).toContainText("Since the drag began: 3 swaps, 2 overlaps on one axis begun, 0 ended.");
  await expect(log.locator("li")).toHaveText(["A begins to overlap C on x", "A begins to overlap B on x"]);
  await page.clock.runFor(2000);
  expect(await flashes(), "only for a moment").toBe(false);
  await demo.drag(0, -160);
  await expect(log).toContainText("Since the drag began: 3 swaps, 0 overlaps on one axis begun, 2 ended.");
  await expect(log.locator("li")).toHaveText(["A ceases to overlap B on x", "A ceases to overlap C on x"]);
  // By keys: four times 25 to the right is past the left endpoint of B.
  await demo.root.locator(".picture").focus();
  await page.keyboard.press("b");
  for (let press = 0; press < 4; press++) await page.keyboard.press("Shift+ArrowRight");
  await expect(log).toContainText("1 swap, 1 overlap on one axis begun, 0 ended.");
});

test("d5 and d16 can be guessed: what is right is what is drawn, and a wrong guess is explained", async ({ page }) => {
  const d5 = await new Demo(page, "d5").open();
  const names = (await d5.root.getAttribute("labels"))!.split(",");
  await page.locator("#d5").getByLabel("Guess each step").check();
  for (let guess = 0; guess < 4; guess++) {
    const next = group(d5).getByRole("button", { name: "Next detection" });
    if (await next.isVisible()) await next.click();
    const [, a = "", b = ""] = /for (\w) comes (\w)/.exec((await group(d5).textContent())!)!;
    const balls = await d5.balls();
    const [one, two] = [a, b].map((name) => balls[names.indexOf(name)]!) as [Ball, Ball];
    await group(d5).getByRole("button", { name: on(0)(one, two) ? "tested" : "skipped" }).click();
    await expect(group(d5)).toContainText("Right.");
  }
  await page.locator("#d5").getByLabel("Guess each step").uncheck();
  await expect(group(d5)).toHaveCount(0);

  const d16 = await new Demo(page, "d16").open();
  await page.getByLabel("Guess what each swap tells us").check();
  const answers = ["one begins", "one ends", "nothing"];
  for (let guess = 0; guess < 3; guess++) {
    const next = group(d16).getByRole("button", { name: "Next detection" });
    if (await next.isVisible()) await next.click();
    await expect(group(d16).getByRole("button")).toHaveText(answers);
    const [, first = "", second = ""] = /(\(?\w\)?) and (\(?\w\)?) swap\./.exec((await group(d16).textContent())!)!;
    const right = first.startsWith("(") === second.startsWith("(") ? 2 : first.startsWith("(") ? 1 : 0;
    const choice = guess === 2 ? (right + 1) % 3 : right;
    // What was there before the question is not what it is about: nothing is said of it.
    await expect(d16.root.locator(".said")).toBeEmpty();
    // By keys as well as by hand.
    await d16.root.locator(".picture").focus();
    await page.keyboard.press(String(choice + 1));
    await expect(group(d16)).toContainText(guess === 2 ? `No: ${answers[right]}. Swap` : "Right.");
  }
});

test("the one-to-n scan is guessed before anything of it is shown, and then it can be dragged", async ({ page }) => {
  const demo = await new Demo(page, "one-to-n-misses").open();
  const said = demo.root.locator("[part=said]");
  const wanted: [string, string][] = [["B", "no"], ["C", "no"], ["D", "yes"]];
  const before = await demo.balls();
  for (const [at, [name, answer]] of wanted.entries()) {
    await expect(group(demo)).toContainText(`Does the scan from A find ${name}?`);
    expect(await demo.state()).toMatchObject({ pairs: 0, tests: 0 });
    await expect(said).toHaveText("Nothing has been tested yet.");
    await demo.drag(0, -40);
    expect(await demo.balls(), "it stays as it is until it has been guessed").toEqual(before);
    await group(demo).getByRole("button", { name: at === 0 ? "yes" : answer }).click();
    await expect(group(demo)).toContainText(at === 0 ? "No: no. No endpoint of B lies between (A and A): B begins before A and ends after it" : "Right.");
  }
  await expect(said).toHaveText("1 of 6 pairs tested, 1 overlaps. Missed: A and B.");
  expect((await demo.state()).pairs).toBe(1);
  await demo.drag(0, -150);
  await expect(said).not.toContainText("Missed");
});

test("sweep, grid and tree find the pairs of brute force, and the tests of the sweep are the overlaps on x", async ({ page }) => {
  type Structures = HTMLElement & { rows: number[][]; found: number[][][]; place(id: number, x: number, y: number): void };
  const figure = page.locator("three-structures");
  await figure.scrollIntoViewIfNeeded();
  await expect(figure).toHaveAttribute("data-ready");
  const rows = (): Promise<number[][]> => figure.evaluate((element) => (element as Structures).rows);
  const meets = (axis: number) => (a: number[], b: number[]): boolean => a[axis]! <= b[axis + 2]! && b[axis]! <= a[axis + 2]!;
  for (const name of ["even", "long", "one large"]) {
    await figure.getByLabel("World").selectOption(name);
    // Boxes are moved everywhere, also to the rims and onto the lines of the grid.
    const wrong = await figure.evaluate((element) => {
      const structures = element as Structures;
      const wrong: string[] = [];
      for (let round = 0; round < 30; round++) {
        structures.place((7 * round) % 80, (40 * round) % 560, (20 * round) % 280);
        const { rows } = structures;
        const all = rows.flatMap((a, i) => rows.flatMap((b, j) => (i < j && [0, 1].every((axis) => a[axis]! <= b[axis + 2]! && b[axis]! <= a[axis + 2]!) ? [`${i} ${j}`] : [])));
        for (const [at, pairs] of structures.found.entries()) if (pairs.map((pair) => pair.join(" ")).sort().join() !== all.sort().join()) wrong.push(`structure ${at} in round ${round}`);
      }
      return wrong;
    });
    expect(wrong, name).toEqual([]);
    const boxes = await rows();
    await expect(figure.locator("[data-part=tests]").first()).toHaveText(String(pairsOf(boxes, meets(0))));
    await expect(figure.locator("[data-part=pairs]")).toHaveText(String(pairsOf(boxes, (a, b) => meets(0)(a, b) && meets(1)(a, b))));
  }
  // By keys: the next box, to the right.
  const before = await rows();
  await figure.locator(".structures").focus();
  await page.keyboard.press("b");
  await page.keyboard.press("Shift+ArrowLeft");
  expect((await rows())[1]![0]).toBe(Math.max(before[1]![0]! - 25, 0));
  // By hand, in the second picture.
  const [left = 0, top = 0, right = 0, bottom = 0] = (await rows())[1]!;
  const picture = (await figure.locator("svg").nth(1).boundingBox())!;
  const scale = picture.width / 480;
  await page.mouse.move(picture.x + ((left + right) / 2) * scale, picture.y + ((top + bottom) / 2) * scale);
  await page.mouse.down();
  await page.mouse.move(picture.x + 10, picture.y + 10, { steps: 4 });
  await page.mouse.up();
  expect((await rows()).some(([x = 9, y = 9]) => x < 3 && y < 3)).toBe(true);
});

test("the figure of three structures can be embedded, and nothing of it is cut off", async ({ page, baseURL }) => {
  const snippet = await page.locator(".embed-code textarea").inputValue();
  for (const width of [320, 1000]) {
    await page.setViewportSize({ width, height: 900 });
    await page.goto("/teachers.html");
    await page.setContent(`<body style="margin:0">${snippet.replace(/https:[^"]*(?=embed)/, `${baseURL}/`)}</body>`);
    const frame = (await (await page.locator("iframe").elementHandle())!.contentFrame())!;
    await expect(frame.locator("three-structures svg")).toHaveCount(3);
    await expect.poll(() => frame.evaluate(() => document.documentElement.scrollHeight - innerHeight)).toBeLessThanOrEqual(0);
    expect(await frame.evaluate(() => document.documentElement.scrollWidth - innerWidth)).toBeLessThanOrEqual(0);
    expect(await frame.locator(".box").first().evaluate((box) => getComputedStyle(box).stroke), "its colors are there").not.toBe("none");
  }
});

test("broad and narrow phase: the boxes of A and B overlap while their balls do not touch, until A is dragged to B", async ({ page }) => {
  const demo = await new Demo(page, "broad-narrow").open();
  const touch = ([ax = 0, ay = 0, ar = 0]: Ball, [bx = 0, by = 0, br = 0]: Ball): boolean => Math.hypot(ax - bx, ay - by) <= ar + br;
  const found = (): Promise<[number, number][]> => demo.root.evaluate((element) => (element as unknown as { pairs: [number, number][] }).pairs);
  const onlyBoxes = async (): Promise<string[]> => {
    const balls = await demo.balls();
    return (await found()).filter(([a, b]) => !touch(balls[a]!, balls[b]!)).map(String);
  };
  expect(await onlyBoxes()).toContain("0,1");
  const balls = await demo.balls();
  expect((await found()).length).toBe(pairsOf(balls, (a, b) => on(0)(a, b) && on(1)(a, b)));
  await demo.drag(0, 30, 30);
  await expect.poll(onlyBoxes).not.toContain("0,1");
  expect((await found()).map(String)).toContain("0,1");
});

test("d14 in play: the sentence is of the comparison or swap that is highlighted, and nothing is compared with itself", async ({ page }) => {
  const demo = await new Demo(page, "d14").open();
  await demo.play();
  const seen = await demo.root.evaluate(async (element) => {
    const demo = element as unknown as { event: { kind: string; a: number; b: number } | undefined };
    const said = element.shadowRoot!.querySelector(".said")!;
    const seen: { kind: string; names: string[]; text: string }[] = [];
    while (seen.length < 100) {
      // After all callbacks of the frame, when it is painted.
      await new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
      const { event } = demo;
      if (event) seen.push({ kind: event.kind, names: [event.a, event.b].map((ball) => "ABCDEF"[ball]!), text: said.textContent! });
    }
    return seen;
  });
  expect(new Set(seen.map(({ text }) => text)).size).toBeGreaterThan(3);
  for (const { kind, names, text } of seen) {
    for (const name of names) expect(text, `${kind} of ${names.join(" and ")}`).toMatch(new RegExp(`\\(${name}|${name}\\)`));
    expect(text.startsWith(kind === "swap" ? "Swap" : "Compare") || text.endsWith("is the pivot itself: the scan stops here."), text).toBe(true);
    expect(text).not.toMatch(/Compare (\S+) with \1\./);
  }
});

test("a side-scroller: along x few tests, along y nearly every pair, as the bodies lie", async ({ page }) => {
  const [x, y] = [await new Demo(page, "side-scroller-x").open(), await new Demo(page, "side-scroller-y").open()];
  await x.pause();
  const { tests: alongX, balls } = await x.finish();
  const { tests: alongY } = await y.finish();
  expect(balls).toHaveLength(20);
  expect(alongX).toBe(pairsOf(balls, on(0)));
  expect(alongX).toBeLessThan(20);
  expect(alongY).toBeGreaterThan(5 * Math.max(alongX, 10));
});
