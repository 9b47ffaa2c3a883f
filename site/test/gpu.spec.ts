// Moving boxes on the GPU, which here is SwiftShader: it computes in software.
import { expect, type Locator, type Page, test } from "@playwright/test";
import config from "../playwright.config.ts";
import { settled } from "./support/frames.ts";
import { complaints, cutOff, overflow, tooSmall, violations } from "./support/pages.ts";

// Without the graphics library that the other tests do without, and with Vulkan in software: a canvas needs it.
const kept = (config.use?.launchOptions?.args ?? []).filter((flag) => flag !== "--disable-gpu");
const flags = ["--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader", "--ignore-gpu-blocklist", "--enable-features=Vulkan", "--use-vulkan=swiftshader"];
test.use({ launchOptions: { ...config.use?.launchOptions, args: [...kept, ...flags] }, contextOptions: { reducedMotion: "reduce" } });

const gpu = (page: Page): Locator => page.locator("gpu-boxes");
const part = (page: Page, name: string): Locator => gpu(page).locator(`[data-part="${name}"]`);
const counter = (page: Page, name: string): Locator => gpu(page).locator(`[data-counter="${name}"] dd`);
const button = (page: Page, name: string): Locator => gpu(page).getByRole("button", { name, exact: true });

/** Presses Start, for this many boxes. */
async function start(page: Page, count: number): Promise<void> {
  await gpu(page).evaluate((element, count) => element.setAttribute("count", String(count)), count);
  await page.getByRole("button", { name: "Start on the GPU" }).click();
}

/** Opens this many boxes, paused. */
async function open(page: Page, count: number): Promise<void> {
  await page.goto("/playground.html");
  await start(page, count);
  await found(page);
}

/** Waits for the first pairs. */
async function found(page: Page): Promise<void> {
  await expect(part(page, "moment")).toHaveText("Step 0");
  await expect(counter(page, "pairs")).not.toHaveText("–");
}

/** The number of pairs of a check that agrees. */
async function checked(page: Page): Promise<number> {
  await button(page, "Check against the processor").click();
  await expect(part(page, "status")).toHaveText(/agree|not/i);
  const said = (await part(page, "status").textContent()) ?? "";
  expect(said).toMatch(/^Both agree: the processor finds [\d,]+ pairs too, in the same boxes\.$/);
  return Number(said.replaceAll(/[^\d]/g, ""));
}

/** In a page: lets a test change devices as they are opened. */
async function onDevice(page: Page, change: (device: GPUDevice) => void, without: string[] = []): Promise<void> {
  await page.addInitScript(`{
    const request = GPUAdapter.prototype.requestDevice;
    GPUAdapter.prototype.requestDevice = async function (options) {
      const requiredFeatures = options.requiredFeatures.filter((name) => !${JSON.stringify(without)}.includes(name));
      const device = await request.call(this, { ...options, requiredFeatures });
      (${change})(device);
      return device;
    };
  }`);
}

test("nothing of it is loaded before the button is pressed; where less motion is wanted it is paused, works with keys, and waits out of sight", async ({ page }) => {
  const loaded: string[] = [];
  page.on("request", (request) => loaded.push(request.url()));
  const all = async (): Promise<string> => (await Promise.all(loaded.filter((url) => /\.(js|css)$/.test(url)).map(async (url) => (await page.request.get(url)).text()))).join();
  await page.goto("/playground.html");
  await expect(page.locator("box-playground")).toHaveAttribute("data-step", "0");
  const before = await all();
  expect(before).not.toMatch(/requestAdapter|gpu-numbers/);
  await start(page, 500);
  await found(page);
  expect(await all()).toMatch(/requestAdapter/);

  await expect(button(page, "Play")).toBeFocused();
  const moment = (): Promise<string | null> => part(page, "moment").textContent();
  expect(await settled(page, moment, "paused at first")).toBe("Step 0");
  await page.keyboard.press("Tab");
  await page.keyboard.press("Enter");
  await expect(part(page, "moment")).toHaveText("Step 1");
  await page.keyboard.press("Shift+Tab");
  await page.keyboard.press("Space");
  await expect(part(page, "moment")).toHaveText(/Step ([4-9]|\d\d)/);
  await page.keyboard.press("Space");
  await expect(button(page, "Play")).toBeFocused();
  await settled(page, moment, "paused");
  await button(page, "Play").click();
  await page.evaluate(() => scrollTo(0, 0));
  const unseen = await settled(page, moment, "out of sight");
  await gpu(page).scrollIntoViewIfNeeded();
  await expect(part(page, "moment")).not.toHaveText(unseen!);
});

test("in 2D and 3D, with more pairs than there is space for at first, the processor agrees; the stages have times", async ({ page }) => {
  await open(page, 4000);
  await expect(part(page, "dimensions")).toHaveValue("2");
  for (const dimensions of ["2", "3"]) {
    if (dimensions === "3") await part(page, "dimensions").selectOption("3");
    await found(page);
    const before = await checked(page);
    for (let step = 1; step <= 5; step++) {
      await button(page, "Step").click();
      await expect(part(page, "moment")).toHaveText(`Step ${step}`);
    }
    const after = await checked(page);
    expect(Math.min(before, after), `in ${dimensions}D`).toBeGreaterThan(256);
    await expect(counter(page, "pairs")).toHaveText(String(after));
    await button(page, "Play").click();
    await expect(part(page, "moment")).not.toHaveText("Step 5");
    await checked(page);
    await button(page, "Pause").click();
    // One of five overlaps another, give or take.
    const share = Number.parseFloat((await counter(page, "overlapping").textContent())!);
    expect(share, `in ${dimensions}D`).toBeGreaterThan(15);
    expect(share, `in ${dimensions}D`).toBeLessThan(25);
    for (const stage of ["read boxes", "order boxes", "build the tree", "count the pairs", "sum the numbers up", "write the pairs"]) {
      await expect(counter(page, stage)).toHaveText(/^\d+\.\d ms$/);
    }
  }
});

test("a GPU that gives no times says so; one that is lost says so, and is opened again", async ({ page }) => {
  await onDevice(page, (device) => Object.assign(globalThis, { device }), ["timestamp-query"]);
  await open(page, 500);
  await expect(part(page, "times")).toHaveText("Your browser gives no times");
  await expect(counter(page, "read boxes")).toHaveText("–");

  await page.evaluate(() => (globalThis as unknown as { device: GPUDevice }).device.destroy());
  await expect(part(page, "message")).toContainText("The GPU was lost.");
  await button(page, "Check against the processor").click();
  await expect(part(page, "status")).toHaveText("There are no boxes yet.");
  await button(page, "Try again").click();
  await found(page);
  await expect(part(page, "message")).toHaveText("");
  await checked(page);
});

test("without WebGPU, without a GPU, and with a small one, a sentence says so", async ({ page }) => {
  await page.addInitScript(() => {
    const gpu = navigator.gpu;
    const { hash } = location;
    if (hash === "#none") Object.defineProperty(navigator, "gpu", { value: undefined });
    if (hash === "#adapter") Object.defineProperty(navigator, "gpu", { value: { requestAdapter: async () => null } });
    Object.assign(globalThis, { restore: () => Object.defineProperty(Navigator.prototype, "gpu", { value: gpu }) });
  });
  await page.goto("/playground.html#none");
  await page.getByRole("button", { name: "Start on the GPU" }).click();
  await expect(part(page, "message")).toHaveText("This needs WebGPU, which this browser does not have, or has only on secure pages (https or localhost).");
  await page.goto("about:blank");
  await page.goto("/playground.html#adapter");
  await page.getByRole("button", { name: "Start on the GPU" }).click();
  await expect(part(page, "message")).toContainText("found no GPU that it may use.");
  await expect(button(page, "Try again")).toBeVisible();
  await onDevice(page, (device) => Object.defineProperty(device, "limits", { value: { maxStorageBufferBindingSize: 65_536, maxBufferSize: 65_536 } }));
  await page.goto("about:blank");
  await page.goto("/playground.html");
  await start(page, 5000);
  await expect(part(page, "message")).toContainText("This GPU cannot hold this many boxes in one buffer. Choose fewer.");
});

test("a file that does not load is said, and can be tried again", async ({ page }) => {
  await page.route(/gpu-boxes[^/]*\.js/, (route) => route.abort());
  await page.goto("/playground.html");
  await page.getByRole("button", { name: "Start on the GPU" }).click();
  const failure = page.locator("section[aria-labelledby=gpu-heading] .load-failure");
  await expect(failure).toContainText("A file of this page did not load");
  await page.unroute(/gpu-boxes[^/]*\.js/);
  await failure.getByRole("button", { name: "Try again" }).click();
  await expect(page.getByRole("button", { name: "Start on the GPU" })).toBeEnabled();
});

/** How many pixels of the picture have each of two colors of the page. */
async function painted(page: Page): Promise<{ overlap: number; ground: number }> {
  const picture = (await part(page, "picture").screenshot()).toString("base64");
  return gpu(page).evaluate(async (element, picture) => {
    const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${picture}`)).blob());
    const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d")!;
    context.drawImage(bitmap, 0, 0);
    const pixels = context.getImageData(0, 0, bitmap.width, bitmap.height).data;
    const of = (name: string): number => {
      const probe = element.appendChild(document.createElement("i"));
      probe.style.forcedColorAdjust = "none";
      probe.style.color = `var(--${name})`;
      const wanted = getComputedStyle(probe).color.match(/\d+/g)!.map(Number);
      probe.remove();
      let count = 0;
      for (let at = 0; at < pixels.length; at += 4) if (wanted.every((value, channel) => pixels[at + channel] === value)) count++;
      return count;
    };
    return { overlap: of("sap-overlap"), ground: of("stage") };
  }, picture);
}

test("light and dark, with forced colors and without: overlapping boxes have the color of overlaps, and the page is as others are", async ({ page }) => {
  const heard = complaints(page);
  // It is opened with the first colors, and changes to the others.
  await page.emulateMedia({ colorScheme: "dark", forcedColors: "active", reducedMotion: "reduce" });
  await open(page, 500);
  for (const colorScheme of ["dark", "light"] as const) {
    for (const forcedColors of ["active", "none"] as const) {
      const look = `${colorScheme}, forced colors ${forcedColors}`;
      await page.setViewportSize({ width: 1280, height: 900 });
      await page.emulateMedia({ colorScheme, forcedColors, reducedMotion: "reduce" });
      await expect(async () => {
        const { overlap, ground } = await painted(page);
        expect(overlap, look).toBeGreaterThan(500);
        expect(ground, look).toBeGreaterThan(10 * overlap);
      }).toPass();
      if (forcedColors === "none") expect(await violations(page), look).toEqual([]);
      for (const width of [1280, 390, 320]) {
        await page.setViewportSize({ width, height: 900 });
        await expect.poll(() => overflow(page), { message: `${look}, at ${width} pixels` }).toBeLessThanOrEqual(0);
        expect(await cutOff(page), `${look}, at ${width} pixels`).toEqual([]);
        const lefts = await page.locator(":is(box-playground, gpu-boxes) .panel-stage").evaluateAll((stages) => stages.map((stage) => stage.getBoundingClientRect().left));
        expect(lefts[1], `as far from the edge as the playground, ${look}, at ${width} pixels`).toBe(lefts[0]);
      }
      expect(await tooSmall(page), look).toEqual([]);
    }
  }
  // What Chromium says of a shader that it compiles is not the page's fault.
  expect(heard.filter((said) => !said.startsWith("Compilation log"))).toEqual([]);
});
