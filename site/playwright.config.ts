import { defineConfig } from "@playwright/test";

const port = Number(process.env["PORT"] ?? 4273);

/** The built page in the system's Chromium, which draws in software: no graphics card is needed. */
export default defineConfig({
  testDir: "test",
  outputDir: "test-results",
  timeout: 120_000,
  expect: { timeout: 30_000 },
  workers: 1,
  forbidOnly: Boolean(process.env["CI"]),
  reporter: "list",
  use: {
    baseURL: `http://localhost:${port}`,
    viewport: { width: 1280, height: 900 },
    launchOptions: {
      executablePath: process.env["CHROMIUM"] ?? "/usr/bin/chromium",
      args: [
        "--no-sandbox",
        "--use-angle=swiftshader",
        "--enable-unsafe-swiftshader",
        "--disable-background-networking",
        "--disable-component-update",
        "--no-first-run",
      ],
    },
  },
  webServer: {
    command: `npx vite preview --strictPort --port ${port}`,
    port,
    reuseExistingServer: false,
  },
});
