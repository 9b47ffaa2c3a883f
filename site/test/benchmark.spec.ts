import { readdirSync, readFileSync } from "node:fs";
import { expect, type Page, test } from "@playwright/test";
import { looksOf } from "../src/benchmark/looks.ts";
import { complaints, requestsElsewhere, violations } from "./support/pages.ts";

/** The newest file of the native results, which the page opens with. */
const folder = new URL("../../bench/results/", import.meta.url);
const newest = readdirSync(folder).filter((name) => name.endsWith(".json")).sort((a, b) => b.slice(-15).localeCompare(a.slice(-15)))[0];
const kept = newest ? JSON.parse(readFileSync(new URL(newest, folder), "utf8")) : undefined;

test("one sentence and five alternatives come first, everything else is folded", async ({ page }) => {
  test.skip(!kept, "nothing was kept");
  await page.goto("/benchmark.html");
  await expect(page.locator(".lede")).toContainText(/in Rust in [\d.]+ (µs|ms), [\d.]+ times faster than the fastest alternative \(.+\), and in JavaScript in/);
  await expect(page.locator("details[open]")).toHaveCount(0);
  await expect(page.locator("#recorded-choice")).toBeHidden();
  for (const table of await page.locator(".fronts table").all()) {
    await expect(table.locator("tbody tr"), "sweep-and-prune, five alternatives, and a plain sweep").toHaveCount(7);
    await expect(table.locator("tbody tr").first()).toContainText("sweep-and-prune");
  }
  // What it says is what the file says.
  const one = kept.cases.find(({ scene, dimensions, boxes }: { scene: string; dimensions: number; boxes: number }) => scene === "uniform" && dimensions === 2 && boxes === 10_000);
  const time = (name: string): number => one.results.find((entry: { name: string }) => entry.name === name).outcome.Timed.median_ns;
  const row = page.locator(".fronts table").first().locator("tr").filter({ has: page.getByRole("rowheader", { name: "rstar", exact: true }) });
  expect(Number((await row.locator("td").last().textContent())!.replace("×", ""))).toBeCloseTo(time("rstar") / time("sweep-and-prune"), 0);
  // A link to what is folded opens it.
  await page.getByRole("link", { name: "Measure in your own browser" }).click();
  await expect(page.getByRole("button", { name: "Run" })).toBeEnabled();
});

test.describe("the recorded results", () => {
  test.skip(!kept, "nothing was kept");

  test.beforeEach(async ({ page }) => {
    await page.goto("/benchmark.html#recorded-heading");
    await expect(page.locator("#plot-time svg").first()).toBeVisible();
  });

  test("are shown for the scene chosen: plots and the numbers of the file", async ({ page }) => {
    await expect(page.locator("#recorded-machine")).toContainText(kept.machine.cpu);
    await expect(page.locator("#recorded-machine")).toContainText(kept.date);
    const scene = kept.cases.find(({ boxes }: { boxes: number }) => boxes > 100);
    await page.locator("#recorded-scene").selectOption(`${scene.scene} ${scene.dimensions}D`);
    await page.getByText("The numbers of this scene").click();
    const rows = page.locator("#recorded-table tbody tr");
    for (const { name, outcome } of scene.results) {
      const row = rows.filter({ has: page.getByRole("rowheader", { name, exact: true }) });
      const expected = outcome.Timed ? /\d (ns|µs|ms|s)\b/ : outcome.Untimed.why;
      await expect(row.locator("td").first()).toContainText(expected);
    }
    const before = await page.locator("#plot-time > svg").getAttribute("aria-label");
    await page.locator("#recorded-scene").selectOption({ index: 1 });
    await expect(page.locator("#plot-time > svg")).not.toHaveAttribute("aria-label", before ?? "");
    await expect(page.locator("#plot-ratio > svg")).toHaveAttribute("aria-label", /fastest alternative takes at least [\d.]+ times/);
  });

  test("show the libraries that a user would choose between, and the others when ticked", async ({ page }) => {
    const shown = page.locator("#plot-time > svg");
    const text = async (): Promise<string[]> => (await shown.locator("text").allTextContents()).map((name) => name.replace(/, to \d+[KM]$/, ""));
    expect(await text()).toEqual(expect.arrayContaining(["sweep-and-prune", "sweep-and-prune, 2 threads", "plain sweep", "parry"]));
    for (const aside of ["sweep-and-prune, again", "sweep-and-prune, fresh", "sweep-and-prune, two at once"]) expect(await text()).not.toContain(aside);

    await page.getByText("Libraries: which ones are shown").click();
    await page.getByLabel("sweep-and-prune, again").check();
    await expect.poll(text).toContain("sweep-and-prune, again");
    await page.getByLabel("parry", { exact: true }).uncheck();
    await expect.poll(text).not.toContain("parry");
    await expect(page.locator("#recorded-libraries")).toContainText(kept.how["sweep-and-prune, again"].replaceAll("`", ""));
    expect(await violations(page)).toEqual([]);

    // Where there is no room beside the lines, their names stand beneath.
    await page.setViewportSize({ width: 390, height: 844 });
    await expect(page.locator("#plot-time .key li").filter({ hasText: /^sweep-and-prune, again$/ })).toBeVisible();
  });

  test("names do not cover each other, and no two lines look the same", async ({ page }) => {
    for (const scene of await page.locator("#recorded-scene option").evaluateAll((all) => all.map((option) => (option as HTMLOptionElement).value))) {
      await page.locator("#recorded-scene").selectOption(scene);
      await expect(page.locator("#plot-time > svg")).toBeVisible();
      const names = await page.locator("#plot-time > svg g[text-anchor=start] text").evaluateAll((all) => all.map((name) => name.getBoundingClientRect()).map(({ top, bottom }) => ({ top, bottom })));
      expect(names.length, scene).toBeGreaterThan(3);
      names.sort((a, b) => a.top - b.top);
      names.slice(1).forEach(({ top }, at) => expect(top, scene).toBeGreaterThanOrEqual((names[at]?.bottom ?? 0) - 2));
    }
    const entries: { name: string; alternative: boolean }[] = kept.cases.flatMap(({ results }: { results: { name: string; alternative: boolean }[] }) => results);
    const look = looksOf(entries);
    const names = [...new Set(entries.map(({ name }) => name))];
    expect(new Set(names.map((name) => JSON.stringify(look(name)))).size).toBe(names.length);
  });

  test("are offered as the file that was kept", async ({ page, request }) => {
    const address = await page.getByRole("link", { name: /JSON/ }).getAttribute("href");
    expect(await (await request.get(`/${address}`)).json()).toEqual(kept);
  });
});

/** Chooses few boxes and these alternatives only. */
async function choose(page: Page, alternatives: readonly string[], sizes = ["1000"]): Promise<void> {
  await page.goto("/benchmark.html#here-heading");
  await expect(page.getByRole("button", { name: "Run" })).toBeEnabled();
  for (const box of await page.locator("#here input[name=size]").all()) await box.setChecked(sizes.includes(await box.inputValue()));
  for (const box of await page.locator("#here input[name=alternative]").all()) await box.setChecked(alternatives.includes(await box.inputValue()));
}

const row = (page: Page, name: string) =>
  page.locator("#here-table tbody tr").filter({ has: page.getByRole("rowheader", { name, exact: true }) });

test.describe("run it here", () => {
  test("every light alternative is checked and timed, in its worker, without a request to anybody else", async ({ page, baseURL }) => {
    const heard = complaints(page);
    const elsewhere = requestsElsewhere(page, baseURL ?? "");
    for (const [scene, dimensions] of [["mixed", "2"], ["drift", "3"]] as const) {
      await page.goto("/benchmark.html#here-heading");
      await expect(page.getByRole("button", { name: "Run" })).toBeEnabled();
      await page.locator("#here-scene").selectOption(scene);
      await page.locator("#here-dimensions").selectOption(dimensions);
      await page.getByLabel("10,000", { exact: true }).uncheck();
      const alternatives = await page.locator("#here input[name=alternative]:checked").evaluateAll((all) => all.map((box) => (box as HTMLInputElement).value));
      expect(alternatives.length).toBeGreaterThan(3);
      await page.getByRole("button", { name: "Run" }).click();
      await expect(page.locator("#here-status")).toContainText("Done.", { timeout: 600_000 });
      for (const name of ["sweep-and-prune", ...alternatives]) await expect(row(page, name).locator("td")).toHaveText(/\d (µs|ms)/);
      // The sentence and the table agree on which library is the fastest.
      const status = (await page.locator("#here-status").textContent())!;
      const marked = page.locator("#here-table tbody tr").filter({ has: page.locator("td.fastest") });
      await expect(marked).toHaveCount(1);
      expect(status).toContain(`${await marked.getByRole("rowheader").textContent()} is the fastest.`);
      const times = await page.locator("#here-table tbody tr").evaluateAll((rows) => rows.map((row) => {
        const [, value, unit] = /([\d.]+) (µs|ms)/.exec(row.querySelector("td")!.textContent!) ?? [];
        return { name: row.querySelector("th")!.textContent!, ns: Number(value) * (unit === "ms" ? 1e6 : 1e3), isMarked: row.querySelector(".fastest") !== null };
      }));
      const least = Math.min(...times.map(({ ns }) => ns));
      expect(times.find(({ isMarked }) => isMarked)!.ns).toBe(least);
      const others = times.filter(({ name }) => !/^(sweep-and-prune|plain)/.test(name)).sort((a, b) => a.ns - b.ns);
      expect(status).toMatch(/the fastest alternative, .*, takes [\d.]+ times as long/);
      expect(others.filter(({ ns }) => ns === others[0]!.ns).map(({ name }) => name)).toContain(/the fastest alternative, (.*?), takes/.exec(status)![1]);
      await expect(page.locator("#plot-here > svg")).toBeVisible();
    }
    expect(await violations(page)).toEqual([]);
    expect(heard).toEqual([]);
    expect(elsewhere).toEqual([]);
  });

  test("a library that finds other pairs is not timed", async ({ page, context }) => {
    await context.route(/\/flatbush-[^/]*\.js/, (route) =>
      route.fulfill({
        contentType: "text/javascript",
        body: "export const create = async () => ({ find: () => new Uint32Array([0, 1]) });",
      }),
    );
    await choose(page, ["flatbush", "rbush"]);
    await page.getByRole("button", { name: "Run" }).click();
    await expect(page.locator("#here-status")).toContainText("Done.", { timeout: 600_000 });
    await expect(row(page, "flatbush").locator("td")).toHaveText("wrong pairs, 1 of them");
    await expect(row(page, "rbush").locator("td")).toHaveText(/\d (µs|ms)/);
  });

  test("is started and cancelled by keyboard, and can be started again", async ({ page }) => {
    await choose(page, ["plain sweep", "box-intersect", "flatbush", "rbush", "planck"], ["1000", "10000", "100000"]);
    await page.getByRole("button", { name: "Run" }).focus();
    await page.keyboard.press("Enter");
    await expect(page.locator("#here-status")).toContainText("Measuring");
    await expect(page.getByRole("button", { name: "Cancel" })).toBeFocused();
    await page.keyboard.press("Enter");
    await expect(page.locator("#here-status")).toHaveText("Cancelled.");
    await expect(page.getByRole("button", { name: "Run" })).toBeFocused();
    expect(page.workers()).toEqual([]);

    await choose(page, []);
    await page.getByRole("button", { name: "Run" }).click();
    await expect(page.locator("#here-status")).toContainText("Done.", { timeout: 600_000 });
  });

  test("says so if nothing is chosen", async ({ page }) => {
    await choose(page, [], []);
    await page.getByRole("button", { name: "Run" }).click();
    await expect(page.locator("#here-status")).toContainText("at least one number of boxes");
  });
});
