// The snippets that a reader copies, on a page that has nothing else: nothing in a frame is cut off.
import { expect, test } from "@playwright/test";
import type { SapDemo } from "sweep-and-prune-classroom/demo";

test("nothing in an embedded demo is cut off, with and without the script of its snippet", async ({ page }) => {
  test.slow();
  await page.setViewportSize({ width: 1280, height: 900 });
  await page.goto("/#d2");
  const snippets = await page.evaluate(async () => {
    await customElements.whenDefined("sap-demo");
    const demos = [...document.querySelectorAll<SapDemo>("sap-demo")];
    await Promise.all(demos.map(({ ready }) => ready));
    return demos.map((demo) => demo.embedCode());
  });
  expect(snippets.length).toBeGreaterThan(30);
  const some = process.env["TEST_LONG"] ? snippets : snippets.filter((_, at) => at % 12 === 1);
  for (const width of [320, 632, 1200]) {
    await page.setViewportSize({ width, height: 900 });
    for (const snippet of some) {
      for (const hasScript of [false, true]) {
        await page.goto("/teachers.html");
        await page.setContent(`<body style="margin:0">${hasScript ? snippet : snippet.replace(/<script>.*<\/script>/s, "")}</body>`);
        const frame = await (await page.locator("iframe").elementHandle())!.contentFrame();
        await frame!.locator("sap-demo [part=counters], sap-demo [part=controls]").first().waitFor();
        const over = (): Promise<number> => frame!.evaluate(() => document.documentElement.scrollHeight - innerHeight);
        await expect.poll(over, { message: `${width} px, ${hasScript ? "with" : "without"} the script: ${snippet.slice(0, 200)}` }).toBeLessThanOrEqual(0);
        const main = (await frame!.locator("main").boundingBox())!;
        const shown = (await page.locator("iframe").boundingBox())!;
        expect(main.width).toBeLessThanOrEqual(shown.width);
        if (hasScript) await expect.poll(async () => (await page.locator("iframe").boundingBox())!.height - (await frame!.locator("main").boundingBox())!.height).toBeLessThanOrEqual(1);
      }
    }
  }
  await page.goto("/embed.html#strategy=pairwise");
  await expect(page.getByRole("link", { name: "Which boxes overlap? ↗" })).toHaveAttribute("target", "_blank");
});
