// A listing of the article is changed by the reader, and its demo runs it.
import { expect, type Locator, type Page, test } from "@playwright/test";
import { withLines } from "../src/edit/lines.ts";
import { Demo } from "./support/demo.ts";
import { complaints } from "./support/pages.ts";

/** Opens the editor of a listing; its demo is paused at the end of a detection. */
async function edit(page: Page, id: string, name: string): Promise<{ demo: Demo; listing: Locator; said: Locator; type(code: string): Promise<void>; code(): Promise<string> }> {
  await page.goto(`/#${id}`);
  const demo = await new Demo(page, id).open();
  await demo.reset();
  const listing = page.locator(`.listing[data-listing="${name}"]`);
  await listing.getByRole("button", { name: "Edit" }).click();
  const content = listing.locator(".cm-content");
  await expect(content).toBeFocused();
  return {
    demo,
    listing,
    said: listing.locator(".editor-said"),
    type: async (code) => {
      await content.press("Control+a");
      await page.keyboard.insertText(code);
    },
    code: () => listing.locator("pre code").evaluate((code) => code.textContent!),
  };
}

test.use({ contextOptions: { reducedMotion: "reduce" } });

test("the number of a line is told before calls alone: not before methods, nor where a function is defined", () => {
  const said = "if ($line(1, overlaps)(a, b)) $line(1, onPair)(a, b);\n\n$line(3, precedes)(p, q)";
  expect(withLines("if (overlaps(a, b)) onPair(a, b);\n\nprecedes(p, q)")).toBe(said);
  for (const code of [
    "rows[i].overlaps(b)", "this.#overlaps(b)", "a?.overlaps(b)", "onOverlap(a, b)",
    "class Row {\n  overlaps(b) {\n  }\n  #precedes(b) { }\n}", "const row = { onPair(a, b) { } };", "export function precedes(p, q) {", "function overlaps(\n  a,\n  b,\n) {",
  ]) {
    expect(withLines(code)).toBe(code);
  }
  // A line before may end without a semicolon.
  expect(() => new Function("$line", "overlaps", `const a = [1]\n${withLines("overlaps(a)")}`)((_: number, report: unknown) => report, () => true)).not.toThrow();
});

test("the editor is not loaded before it is asked for", async ({ page }) => {
  const scripts: string[] = [];
  page.on("request", (request) => scripts.push(request.url()));
  await page.goto("/#d2");
  await new Demo(page, "d2").open();
  await page.waitForLoadState("networkidle");
  expect(scripts.filter((url) => /editor/.test(url))).toEqual([]);
  await page.locator(".listing[data-listing=pairwise]").getByRole("button", { name: "Edit" }).click();
  await expect(page.locator(".cm-content")).toBeVisible();
  expect(scripts.filter((url) => /editor/.test(url)).length).toBeGreaterThan(0);
});

test("changed code runs in the demo: its tests, its pairs, what it misses; time goes back as before", async ({ page }) => {
  const heard = complaints(page);
  const { demo, listing, said, type, code } = await edit(page, "d2", "pairwise");
  const compiled = await demo.finish();
  expect(compiled.tests).toBe(10);
  const original = await code();
  await expect(said).toHaveText("The demo runs this code. Change it.");
  expect((await demo.finish()).tests).toBe(10);

  // Only neighbors in the list: 4 tests.
  await type(original.replace("j < boxes.length", "j < Math.min(boxes.length, i + 2)"));
  await expect(said).toHaveText("The demo runs your code.");
  await expect.poll(async () => (await demo.finish()).tests).toBe(4);
  const moments = await demo.root.evaluate((element) => {
    const demo = element as unknown as { state: unknown; settled: Promise<void>; step(): void; back(): void };
    const states = async (count: number, act: () => void): Promise<string[]> => {
      const states: string[] = [];
      while (states.length < count) {
        act();
        await demo.settled;
        states.push(JSON.stringify(demo.state));
      }
      return states;
    };
    return states(12, () => demo.step()).then(async (forward) => ({ forward, back: await states(11, () => demo.back()) }));
  });
  expect(moments.back.reverse()).toEqual(moments.forward.slice(0, -1));

  // A pair that is never reported is missed, and the demo says so.
  await demo.root.evaluate((element) => {
    element.setAttribute("balls", "[[200,200,60],[260,200,60],[500,100,30]]");
    element.setAttribute("decorations", "");
    element.setAttribute("static", "");
  });
  await type(original.replace("if (overlaps(a, b)) onPair(a, b);", "overlaps(a, b);"));
  await expect(demo.root.locator(".said")).toHaveText("3 of 3 pairs tested, 0 overlap. Missed: A and B.");
  await demo.root.evaluate((element) => element.removeAttribute("static"));

  // Done: the compiled algorithm is at work again, in the same world.
  await listing.getByRole("button", { name: "Done" }).click();
  await expect(listing.locator("pre")).toBeVisible();
  await expect.poll(async () => (await demo.finish()).pairs).toBeGreaterThan(0);
  expect(heard).toEqual([]);
});

test("code runs without document, storage and network", async ({ page }) => {
  const heard: string[] = [];
  page.on("request", (request) => heard.push(request.url()));
  const { said, type } = await edit(page, "d2", "pairwise");
  await expect(said).toHaveText("The demo runs this code. Change it.");
  heard.length = 0;
  /** What an expression gives, told as an error. */
  let asked = 0;
  const result = async (expression: string): Promise<string> => {
    await type(`const says = ${expression};\nexport function globalPairwise() { throw new Error("No. ${++asked}: It is " + says); }`);
    await expect(said).toContainText(`No. ${asked}: `);
    return (await said.textContent())!;
  };
  const attempt = (expression: string): string => `(() => { try { return String(${expression}); } catch (error) { return error.name; } })()`;
  expect(await result("typeof document + typeof localStorage + typeof window")).toContain("It is undefinedundefinedundefined");
  expect(await result(attempt("self.origin"))).toContain("It is null");
  expect(await result(attempt('(indexedDB.open("x"), "open")'))).toContain("It is SecurityError");
  expect(await result(attempt('new XMLHttpRequest().open("GET", "/icon.svg") ?? (() => { const request = new XMLHttpRequest(); request.open("GET", "data:,x", false); request.send(); return request.responseText; })()'))).toMatch(/It is (NetworkError|SyntaxError)/);
  expect(await result(attempt(`importScripts("${new URL(page.url()).origin}/service-worker.js")`))).toContain("It is NetworkError");
  expect(await result(attempt(`(fetch("${new URL(page.url()).origin}/icon.svg"), new WebSocket("ws://localhost:9"), "sent")`))).toMatch(/It is (sent|SecurityError)/);
  expect(heard.filter((url) => !url.startsWith("blob:")), "nothing has been asked for").toEqual([]);
});

test("errors are shown at their line; a loop that never ends is stopped; the demo goes on", async ({ page }) => {
  const heard = complaints(page);
  const { demo, listing, said, type, code } = await edit(page, "d5", "sorted-pairwise");
  const original = await code();
  const lineAtFault = async (): Promise<number> => {
    const lines = await listing.locator(".cm-line").evaluateAll((all) => all.map((line) => line.classList.contains("at-fault")));
    return lines.indexOf(true) + 1;
  };
  await type(original.replace("const b = boxes[j];", "const b = boxes[j]].left;"));
  await expect(said).toContainText(/^Line 6: /);
  expect(await lineAtFault()).toBe(6);
  await type(original.replace("b.left > a.right", "c.left > a.right"));
  await expect(said).toHaveText("Line 7: c is not defined");
  expect(await lineAtFault()).toBe(7);
  await type(original.replace("j < boxes.length", "true").replace("if (b.left > a.right) break;", ""));
  await expect(said).toContainText(/Cannot read properties of undefined|b is undefined/);
  await type(original.replace("for (let i = 0;", "while (true) ;\n  for (let i = 0;"));
  await expect(said).toHaveText("Ended after 2 seconds: does a loop never end?");
  // Not only loops that can be counted: here the engine itself does not come back.
  await type(original.replace("for (let i = 0;", '/(a+)+$/.test("a".repeat(40) + "b");\n  for (let i = 0;'));
  await expect(said).toHaveText("Ended after 2 seconds: does a loop never end?");
  await type(original.replace("const a = boxes[i];", "const a = boxes[i]; onPair({ id: () => i }, a);"));
  await expect(said).toContainText("could not be cloned");
  await type("export function mine() {}");
  await expect(said).toHaveText("The demo calls sortedPairwise(), and there is no such function any more.");
  await listing.getByRole("button", { name: "Original code" }).click();
  await expect(said).toHaveText("The demo runs this code. Change it.");
  await expect.poll(async () => (await demo.finish()).pairs >= 0 && (await demo.finish()).tests > 0).toBe(true);
  expect(heard).toEqual([]);
});

/** What the compiled algorithm finds, the unchanged listing finds too, in each demo that has one. */
const LISTINGS = { d2: "pairwise", d5: "sorted-pairwise", d8: "one-to-n", d10: "sweep", d11: "sweep-and-prune", "every-axis-demo": "sweep-all-axes", d14: "quicksort", d15: "insertion-sort", d18: "swap-driven", d12: "swap-all-axes" };

test("each listing, unchanged, finds what the compiled algorithm finds", async ({ page }) => {
  const heard = complaints(page);
  test.slow(); // ten demos and ten editors
  await page.goto("/#d2");
  for (const [id, name] of Object.entries(LISTINGS)) {
    const demo = await new Demo(page, id).open();
    const listing = page.locator(`.listing[data-listing="${name}"]`);
    await demo.reset();
    /** The pairs of the same detections, and the most that was counted in one. */
    const run = (): Promise<{ pairs: string[]; most: Record<string, number> }> =>
      demo.root.evaluate(async (element) => {
        const demo = element as unknown as { state: Record<string, number>; settled: Promise<void>; pairs: number[][]; step(): void; reset(): void; pause(): void };
        demo.reset();
        demo.pause();
        await demo.settled;
        const pairs = new Map<number, string>();
        const most: Record<string, number> = {};
        const look = (): void => {
          const { tick, ...counts } = demo.state;
          pairs.set(tick!, demo.pairs.map((pair) => [...pair].sort((a, b) => a - b).join(" ")).sort().join(", "));
          for (const [key, count] of Object.entries(counts)) if (key !== "hash" && key !== "events") most[key] = Math.max(most[key] ?? 0, count);
        };
        // What stands still has shown all of its one detection.
        if (element.hasAttribute("static")) return look(), { pairs: [...pairs.values()], most };
        for (let steps = 0; steps < 400 && pairs.size < 3; steps++) {
          demo.step();
          await demo.settled;
          look();
        }
        return { pairs: [...pairs.values()].slice(0, -1), most };
      });
    const compiled = await run();
    // One of them is folded.
    await listing.evaluate((element) => element.closest("details")?.setAttribute("open", ""));
    await listing.scrollIntoViewIfNeeded();
    await listing.getByRole("button", { name: "Edit" }).click();
    await expect(listing.locator(".editor-said")).toHaveText("The demo runs this code. Change it.");
    const mine = await run();
    expect(mine.pairs, id).toEqual(compiled.pairs);
    if (name === "insertion-sort") expect(mine.most["swaps"], id).toBeGreaterThan(0);
    if (name.endsWith("sort") || name.startsWith("swap")) expect(mine.most["comparisons"], id).toBeGreaterThan(8);
    if (!/all-axes/.test(name)) expect(mine.most["tests"], id).toBe(compiled.most["tests"]);
    await listing.getByRole("button", { name: "Done" }).click();
  }
  expect(heard).toEqual([]);
});
