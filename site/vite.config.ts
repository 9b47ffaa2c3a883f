import { defineConfig, type Plugin } from "vite";
import { expandLabs } from "./src/lab/markup.ts";

/** Writes the inside of each `<ball-lab>` into the page, so that nothing moves when scripts arrive. */
const labs: Plugin = {
  name: "labs",
  transformIndexHtml: { order: "pre", handler: expandLabs },
};

export default defineConfig({
  base: "./",
  plugins: [labs],
  worker: { format: "es" },
  build: { target: "es2022", chunkSizeWarningLimit: 800 },
});
