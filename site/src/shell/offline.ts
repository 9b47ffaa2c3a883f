// Writes the service worker with the list of everything that was built, and of what the article needs.

import { createHash } from "node:crypto";
import { readdirSync, readFileSync } from "node:fs";
import type { Plugin, Rolldown } from "vite";

const publicFiles = new URL("../../public/", import.meta.url);

/** What is larger is stored once it has been loaded: the experiment of the playground, the engines of the benchmark page, the drawing in 3D, the editor of listings. */
const LARGE = 350_000;

export const offline: Plugin = {
  name: "offline",
  apply: "build",
  generateBundle: {
    order: "post",
    handler(_, bundle) {
      const hash = createHash("sha256");
      const files = Object.values(bundle).map((output) => output.fileName);
      for (const output of Object.values(bundle)) hash.update(output.fileName).update(contentOf(output));
      // Beside what is built, the single files that are copied as they are; folders of documentation are not stored.
      const copied = readdirSync(publicFiles, { withFileTypes: true }).filter((entry) => entry.isFile());
      for (const { name } of copied) hash.update(readFileSync(new URL(name, publicFiles)));
      const article = neededBy("index.html", bundle).filter((name) => contentOf(bundle[name]!).length <= LARGE);
      const source = readFileSync(new URL("./service-worker.js", import.meta.url), "utf8")
        .replace("__NAME__", `pages-${hash.digest("hex").slice(0, 16)}`)
        .replace("__FILES__", JSON.stringify([...files, ...copied.map(({ name }) => name)].sort()))
        .replace("__ARTICLE__", JSON.stringify(["index.html", "icon.svg", ...article].sort()));
      this.emitFile({ type: "asset", fileName: "service-worker.js", source });
    },
  },
};

const contentOf = (output: Rolldown.OutputChunk | Rolldown.OutputAsset): string | Uint8Array => (output.type === "chunk" ? output.code : output.source);

/** What the scripts and styles of a page load, and what those load; workers and WebAssembly by their names in the code. */
function neededBy(page: string, bundle: Rolldown.OutputBundle): string[] {
  const found = new Set<string>();
  const visit = (name: string): void => {
    const output = bundle[name];
    if (!output || found.has(name)) return;
    found.add(name);
    const content = contentOf(output);
    const text = typeof content === "string" ? content : "";
    for (const other of Object.keys(bundle)) if (!other.endsWith(".html") && text.includes(other.replace(/^assets\//, ""))) visit(other);
  };
  visit(page);
  found.delete(page);
  return [...found];
}
