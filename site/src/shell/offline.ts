// Writes the service worker with the list of everything that was built.

import { createHash } from "node:crypto";
import { readdirSync, readFileSync } from "node:fs";
import type { Plugin } from "vite";

const publicFiles = new URL("../../public/", import.meta.url);

/** What is larger, the engines of the benchmark page, is fetched when it is needed. */
const LARGE = 1_000_000;

export const offline: Plugin = {
  name: "offline",
  apply: "build",
  generateBundle: {
    order: "post",
    handler(_, bundle) {
      const hash = createHash("sha256");
      const files: string[] = [];
      for (const output of Object.values(bundle)) {
        const content = output.type === "chunk" ? output.code : output.source;
        if (content.length > LARGE) continue;
        files.push(output.fileName);
        hash.update(output.fileName).update(content);
      }
      // Beside what is built, the single files that are copied as they are; folders of
      // documentation are too large to fetch unasked.
      for (const entry of readdirSync(publicFiles, { withFileTypes: true })) {
        if (!entry.isFile()) continue;
        files.push(entry.name);
        hash.update(readFileSync(new URL(entry.name, publicFiles)));
      }
      const source = readFileSync(new URL("./service-worker.js", import.meta.url), "utf8")
        .replace("__NAME__", `pages-${hash.digest("hex").slice(0, 16)}`)
        .replace("__FILES__", JSON.stringify(files.sort()));
      this.emitFile({ type: "asset", fileName: "service-worker.js", source });
    },
  },
};
