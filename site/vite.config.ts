import { defineConfig, type Rolldown } from "vite";
import { apiTags } from "./src/api/build.ts";
import { articleTags } from "./src/article/build.ts";
import { alternatives, benchmarkTags } from "./src/benchmark/build.ts";
import { listings, sandboxWorker } from "./src/edit/build.ts";
import { hero } from "./src/hero/build.ts";
import { playgroundTags } from "./src/playground/markup.ts";
import { offline } from "./src/shell/offline.ts";
import { pages, shell } from "./src/shell/pages.ts";
import { fillIn } from "./src/shell/tags.ts";
import { taskTags } from "./src/tasks/build.ts";

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
  plugins: [hero, shell, fillIn({ ...articleTags, ...taskTags, ...apiTags, ...playgroundTags, ...benchmarkTags }), listings, sandboxWorker, offline],
  worker: { format: "es", plugins: () => [alternatives()], rolldownOptions: quiet },
  build: {
    target: "es2022",
    chunkSizeWarningLimit: 800,
    rolldownOptions: { ...quiet, input: pages() },
  },
});
