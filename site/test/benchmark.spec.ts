import { readdirSync, readFileSync } from "node:fs";
import { expect, type Page, test } from "@playwright/test";
import { complaints, requestsElsewhere, violations } from "./support/pages.ts";

/** Of the native results those in which most was measured, which the page opens with. */
const folder = new URL("../../bench/results/", import.meta.url);
const results = readdirSync(folder).filter((name) => name.endsWith(".json")).map((name) => JSON.parse(readFileSync(new URL(name, folder), "utf8")));
const kept = results.sort((a, b) => b.cases.length - a.cases.length || b.date.localeCompare(a.date))[0];

test("one sentence and five alternatives come first, everything else is folded", async ({ page }) => {
  test.skip(!kept, "nothing was kept");
  await page.goto("/benchmark.html");
  await expect(page.locator(".lede")).toContainText(/in Rust in [\d.]+ (µs|ms), [\d.]+ times faster than the fastest alternative \(.+\), and in JavaScript in/);
  await expect(page.locator("details[open]")).toHaveCount(0);
  for (const table of await page.locator(".fronts table").all()) {
    const rows = await table.locator("tbody tr").count();
    expect(rows, "sweep-and-prune, five alternatives, a plain sweep, and the fastest of all others").toBeGreaterThanOrEqual(7);
    expect(rows).toBeLessThanOrEqual(8);
    const widths = await table.locator(".bar span").evaluateAll((all) => all.map((bar) => bar.getBoundingClientRect().width));
    expect(Math.min(...widths), "every bar can be read").toBeGreaterThan(8);
    // The sentence names the fastest of the table that is not sweep-and-prune.
    // One that was not timed says why instead.
    const times = await table.locator("tbody tr:not(:has(.why))").evaluateAll((rows) => rows.map((row) => {
      const [, value, unit] = /([\d.]+) (µs|ms)/.exec(row.textContent!)!;
      return { name: (row as HTMLElement).dataset["library"]!, ns: Number(value) * (unit === "ms" ? 1e6 : 1e3) };
    }));
    for (const why of await table.locator(".why").all()) await expect(why).toHaveText(/\w/);
    const [own, ...others] = times;
    const least = others.reduce((a, b) => (b.ns < a.ns ? b : a));
    expect(own!.name).toBe("sweep-and-prune");
    await expect(page.locator(".lede")).toContainText(`(${least.name})`);
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

/** Opens the part that measures, for these numbers of boxes. */
async function open(page: Page, sizes = ["1000"]): Promise<void> {
  await page.goto("/benchmark.html#here-heading");
  await expect(page.getByRole("button", { name: "Run" })).toBeEnabled();
  for (const box of await page.locator("#here input[name=size]").all()) await box.setChecked(sizes.includes(await box.inputValue()));
}

const row = (page: Page, name: string) => page.locator(`#here-results tr[data-library="${name}"]`);

test.describe("run it here", () => {
  test("the libraries are checked and timed, in its worker, without a request to anybody else", async ({ page, baseURL }) => {
    const heard = complaints(page);
    const elsewhere = requestsElsewhere(page, baseURL ?? "");
    for (const [scene, dimensions] of [["mixed", "2"], ["drift", "3"]] as const) {
      await open(page);
      await page.locator("#here-scene").selectOption(scene);
      await page.locator("#here-dimensions").selectOption(dimensions);
      const said = (await page.locator("#here-alternatives").textContent())!;
      const alternatives = said.replace(/^Measured: |\.$/g, "").split(", ").filter((name) => !/^(sweep-and-prune|BroadPhase)/.test(name));
      expect(alternatives.length, "five libraries with sweep-and-prune, or six").toBeGreaterThanOrEqual(4);
      await page.getByRole("button", { name: "Run" }).click();
      await expect(page.locator("#here-status")).toContainText("Done.", { timeout: 600_000 });
      for (const name of ["sweep-and-prune", ...alternatives]) await expect(row(page, name)).toContainText(/\d (µs|ms)/);
      // The sentence and the table agree on which library is the fastest, and which alternative.
      const status = (await page.locator("#here-status").textContent())!;
      const times = await page.locator("#here-results tbody tr").evaluateAll((rows) => rows.map((row) => {
        const [, value, unit] = /([\d.]+) (µs|ms)/.exec(row.textContent!)!;
        return { name: (row as HTMLElement).dataset["library"]!, ns: Number(value) * (unit === "ms" ? 1e6 : 1e3), isMarked: row.textContent!.includes("fastest") };
      }));
      const marked = times.filter(({ isMarked }) => isMarked);
      expect(marked).toHaveLength(1);
      expect(status).toContain(`${marked[0]!.name} is the fastest.`);
      expect(marked[0]!.ns).toBe(Math.min(...times.map(({ ns }) => ns)));
      const others = times.filter(({ name }) => !name.startsWith("sweep-and-prune")).sort((a, b) => a.ns - b.ns);
      expect(others.filter(({ ns }) => ns === others[0]!.ns).map(({ name }) => name)).toContain(/the fastest alternative, (.*?), takes/.exec(status)![1]);
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
    await open(page);
    await page.getByRole("button", { name: "Run" }).click();
    await expect(page.locator("#here-status")).toContainText("Done.", { timeout: 600_000 });
    await expect(row(page, "flatbush")).toContainText("wrong pairs, 1 of them");
    await expect(row(page, "rbush")).toContainText(/\d (µs|ms)/);
  });

  test("is started and cancelled by keyboard, and can be started again", async ({ page }) => {
    await open(page, ["1000", "10000", "100000"]);
    await page.getByRole("button", { name: "Run" }).focus();
    await page.keyboard.press("Enter");
    await expect(page.locator("#here-status")).toContainText("Measuring");
    await expect(page.getByRole("button", { name: "Cancel" })).toBeFocused();
    await page.keyboard.press("Enter");
    await expect(page.locator("#here-status")).toHaveText("Cancelled.");
    await expect(page.getByRole("button", { name: "Run" })).toBeFocused();
    await expect.poll(() => page.workers(), "a worker that was ended goes a little later").toEqual([]);

    await open(page);
    await page.getByRole("button", { name: "Run" }).click();
    await expect(page.locator("#here-status")).toContainText("Done.", { timeout: 600_000 });
  });

  test("says so if nothing is chosen", async ({ page }) => {
    await open(page, []);
    await page.getByRole("button", { name: "Run" }).click();
    await expect(page.locator("#here-status")).toContainText("at least one number of boxes");
  });
});
