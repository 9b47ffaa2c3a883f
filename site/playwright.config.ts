import { once } from "node:events";
import { type AddressInfo, createServer } from "node:net";
import { defineConfig } from "@playwright/test";

/** A free port. */
async function freePort(): Promise<number> {
  const server = createServer().listen(0);
  await once(server, "listening");
  const { port } = server.address() as AddressInfo;
  server.close();
  return port;
}

// The processes of the tests read this file again and must find the same port.
const port = Number((process.env["SITE_TEST_PORT"] ??= String(await freePort())));

/** The folder of the build under test, if it is not dist. */
const folder = process.env["SITE_TEST_DIST"];

/** The built pages in the system's Chromium, which draws in software: no graphics card is needed. */
export default defineConfig({
  testDir: "test",
  // Times hold on a machine that does nothing else, and memory is measured for minutes: `./test --long` does both.
  testIgnore: process.env["TEST_LONG"] ? [] : ["responsiveness.spec.ts", "memory.spec.ts"],
  outputDir: "test-results",
  // One reference for every machine: what is compared has no fonts in it.
  snapshotPathTemplate: "{testDir}/{testFileName}-snapshots/{arg}{ext}",
  // Only what hangs is ended: a busy machine is slow.
  timeout: 600_000,
  expect: { timeout: 120_000 },
  // Two tests at a time, also of one file: most of them wait. With those of time and memory, one after the other.
  fullyParallel: true,
  workers: process.env["TEST_LONG"] ? 1 : 2,
  forbidOnly: Boolean(process.env["CI"]),
  reporter: "list",
  use: {
    baseURL: `http://localhost:${port}`,
    viewport: { width: 1280, height: 900 },
    // What is tested is the build, not what a service worker has kept; offline.spec.ts lets it work.
    serviceWorkers: "block",
    launchOptions: {
      executablePath: process.env["CHROMIUM"] ?? "/usr/bin/chromium",
      args: [
        "--no-sandbox",
        // Pages are drawn without the graphics library, twice as fast as by its software; WebGL works all the same.
        "--disable-gpu",
        "--use-angle=swiftshader",
        "--enable-unsafe-swiftshader",
        "--disable-background-networking",
        "--disable-component-update",
        "--no-first-run",
      ],
    },
  },
  webServer: {
    command: `npx vite preview --strictPort --port ${port}${folder ? ` --outDir ${folder}` : ""}`,
    port,
    reuseExistingServer: false,
    timeout: 600_000,
  },
});
