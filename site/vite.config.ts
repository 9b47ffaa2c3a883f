import { defineConfig, type Plugin, type Rolldown } from "vite";
import { api } from "./src/api/build.ts";
import { article } from "./src/article/build.ts";
import { benchmark, alternatives } from "./src/benchmark/build.ts";
import { listings, sandboxWorker } from "./src/edit/build.ts";
import { hero } from "./src/hero/build.ts";
import { expandPlayground } from "./src/playground/markup.ts";
import { offline } from "./src/shell/offline.ts";
import { pages, shell } from "./src/shell/pages.ts";
import { tasks } from "./src/tasks/build.ts";

/** Writes the inside of `<box-playground>` into the page, so that nothing moves when scripts arrive. */
const panels: Plugin = {
  name: "panels",
  transformIndexHtml: { order: "pre", handler: (page) => expandPlayground(page) },
};

/** Warnings about the packages of the alternatives are not for this project to fix. */
const quiet: Rolldown.InputOptions = {
  checks: { pluginTimings: false },
  onLog(level, log, report) {
    if (level !== "warn" || !`${log.id} ${log.message}`.includes("bench/js/node_modules")) report(level, log);
  },
};

export default defineConfig({
  base: "./",
  appType: "mpa",
  plugins: [hero, shell, article, tasks, listings, sandboxWorker, api, panels, benchmark, offline],
  worker: { format: "es", plugins: () => [alternatives()], rolldownOptions: quiet },
  build: {
    target: "es2022",
    chunkSizeWarningLimit: 800,
    rolldownOptions: { ...quiet, input: pages() },
  },
});
