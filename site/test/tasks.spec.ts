// The five tasks: each is solved by its answer and by other good code, and each says what is wrong with a bad attempt.
import { expect, type Locator, type Page, test } from "@playwright/test";
import { complaints } from "./support/pages.ts";

test.use({ contextOptions: { reducedMotion: "reduce" } });

async function open(page: Page, name: string): Promise<{ task: Locator; verdict: Locator; said: Locator; original: string; answer: string; type(code: string): Promise<void> }> {
  await page.goto("/tasks.html");
  const task = page.locator(`#${name}`);
  const content = task.locator(".cm-content");
  const [original, answer] = await task.locator("pre code").evaluateAll((all) => all.map((code) => code.textContent!));
  await task.getByRole("button", { name: "Try it" }).click();
  await expect(task.locator(".verdict")).toBeVisible();
  return {
    task,
    verdict: task.locator(".verdict"),
    said: task.locator(".editor-said"),
    original: original!,
    answer: answer!,
    type: async (code) => {
      await content.press("Control+a");
      await page.keyboard.insertText(code);
    },
  };
}

/** Of each task: what the checker says of the code that is there, of attempts that fail, of others that do not. */
const TASKS: Record<string, { begins: RegExp; fails: (readonly [change: (code: string) => string, says: RegExp])[]; solves: ((code: string) => string)[] }> = {
  miss: {
    begins: /Not yet\. Nothing is missed: it finds all of the pairs \(0\)\./,
    fails: [
      // These overlap and are found.
      [(code) => code.replace("left: 6, top: 3", "left: 2, top: 3"), /Not yet\. Nothing is missed: it finds all of the pairs \(1\)\./],
      [(code) => code.replace("right: 4", "right: -1"), /Box A ends before it begins\./],
      [(code) => code.replace("left: 6", "left: NaN"), /Box B needs four numbers/],
      [() => "export const boxes = [];", /boxes has to be an array of 2 to 26 boxes\./],
      [() => "const boxes = [];", /no “export … boxes”/],
    ],
    // A wide box reaches back from afar.
    solves: [(code) => code.replace("left: 12, top: 0, right: 16", "left: 2, top: 0, right: 90")],
  },
  repair: {
    begins: /Not yet\. It still misses /,
    fails: [
      [(code) => code.replace("if (b.left > a.right) break;", ""), /Not yet\. It finds all pairs\. But for 200 boxes side by side it reads [\d,]+ coordinates; the limit is 20,000\./],
      // What the code adds to boxes stays where it is.
      [(code) => code.replace("const center", "for (const box of boxes) box.center = () => 0;\n  const center"), /Not yet\. It still misses /],
      [(code) => code.replace("if (overlaps(a, b)) onPair(a, b);", "onPair(a, b);"), /Not yet\. It (reports boxes that are apart|still misses)/],
      // Copies of the boxes are read no less.
      [() => "export function findPairs(boxes, onPair) {\n  boxes = boxes.map((box) => ({ ...box }));\n  for (let i = 0; i < boxes.length; i++) for (let j = i + 1; j < boxes.length; j++) if (overlaps(boxes[i], boxes[j])) onPair(boxes[i], boxes[j]);\n}", /Not yet\. It finds all pairs\. But for 200 boxes side by side it reads [\d,]+ coordinates; the limit is 20,000\./],
      [() => "export function findPairs(boxes, onPair) {\n  for (const a of boxes) for (const b of boxes) if (a !== b && overlaps(a, b)) onPair(a, b);\n}", /Not yet\. It reports this pair twice: /],
      [() => "export function findPairs() {\n  for (;;);\n}", /Ended after 2 seconds/],
    ],
    // The center can stay, if the row stops only where no half of a box reaches.
    solves: [
      (code) => code.replace("if (b.left > a.right) break;", "if (center(b) - widest / 2 > a.right) break;").replace("for (let i", "const widest = Math.max(0, ...boxes.map((box) => box.right - box.left));\n  for (let i"),
    ],
  },
  key: {
    begins: /Not yet\. In 300 frames every overlap began and ended as it should\./,
    fails: [
      // A pair stays for a while.
      [() => "export function key(a) {\n  return a.id;\n}", /Not yet\. Two pairs share a key: in frame \d+, . and . got lost\./],
      [() => "export const key = 5;", /key has to be a function\./],
      [() => "export function key(a, b) {\n  return a.id + b.id;\n}", /Not yet\. Two pairs share a key: in frame \d+, . and . got lost\./],
    ],
    solves: [() => "export function key(a, b) {\n  return Math.random();\n}"],
  },
  axis: {
    begins: /Not yet\. It takes . for “[a-z ,]+”: \d+ tests, where the other axis takes \d+\./,
    fails: [
      [() => 'export const chooseAxis = () => "x";', /It takes x for “a tower”: 190 tests, where the other axis takes \d+\./],
      [() => 'export const chooseAxis = () => "y";', /It takes y for “a side-scroller”: 190 tests/],
      // The variance of the centers.
      [() => "export function chooseAxis(boxes) {\n  const spread = (at) => { const mean = boxes.reduce((sum, box) => sum + at(box), 0) / boxes.length; return boxes.reduce((sum, box) => sum + (at(box) - mean) ** 2, 0); };\n  return spread((box) => box.left) > spread((box) => box.top) ? \"x\" : \"y\";\n}", /It takes x for “two towers”/],
      [() => "export const chooseAxis = () => 0;", /has to return "x" or "y", not 0/],
    ],
    solves: [() => "export function chooseAxis(boxes) {\n  let x = 0, y = 0;\n  for (const a of boxes) for (const b of boxes) {\n    x += a.left <= b.right && a.right >= b.left;\n    y += a.top <= b.bottom && a.bottom >= b.top;\n  }\n  return x < y ? \"x\" : \"y\";\n}"],
  },
  swaps: {
    begins: /Not yet\. 0 of 3 are what insertion sort does\./,
    fails: [
      [(code) => code.replace("  0,", "  1,"), /Not yet\. 1 of 3 are what insertion sort does\./],
      [() => "export const swaps = 1;", /swaps has to be an array of 3 numbers\./],
    ],
    solves: [],
  },
};

for (const [name, { begins, fails, solves }] of Object.entries(TASKS)) {
  test(`the task “${name}” is failed by bad code, which is told what is wrong, and solved by good code`, async ({ page }) => {
    const heard = complaints(page);
    const { verdict, said, task, original, answer, type } = await open(page, name);
    await expect(verdict).toHaveText(begins);
    for (const [change, says] of fails) {
      expect(change(original), `${says}`).not.toBe(original);
      await type(change(original));
      await expect.poll(async () => `${await said.textContent()} ${(await verdict.isVisible()) ? await verdict.textContent() : ""}`).toMatch(says);
      await expect(verdict).not.toHaveAttribute("data-solved");
    }
    for (const solution of [answer, ...solves.map((change) => change(original))]) {
      await type(solution);
      await expect(verdict).toHaveText(/^Solved\. /);
      await type(original);
      await expect(verdict).toHaveText(begins);
    }
    await task.getByRole("button", { name: "Original code" }).click();
    await expect(verdict).toHaveText(begins);
    expect(heard).toEqual([]);
  });
}

test("what shows a mistake is drawn: its boxes, and the pair that is missed", async ({ page }) => {
  const { verdict, type, answer } = await open(page, "miss");
  await expect(verdict.locator("rect")).toHaveCount(3);
  await expect(verdict.locator("line")).toHaveCount(0);
  await type(answer);
  await expect(verdict.locator("line")).toHaveCount(1);
  await expect(verdict).toContainText("A and C overlap");
});

test("the answers stand on the sheet for teachers", async ({ page }) => {
  await page.goto("/teachers.html");
  for (const name of Object.keys(TASKS)) await expect(page.locator(`dt a[href="./tasks.html#${name}"]`)).toBeVisible();
});
