// What the benchmark page needs when the site is built: the recorded results, and the alternatives, of which those that are not
// installed are left out.

import { existsSync, readdirSync, readFileSync } from "node:fs";
import type { Plugin } from "vite";
import type { Tags } from "../shell/tags.ts";
import { front } from "./front.ts";
import type { Recorded, Run } from "./results.ts";

const root = new URL("../../../", import.meta.url);

/** Where runs are kept, and whose. */
const KEPT = [
  { kind: "native", folder: "bench/results/" },
  { kind: "javascript", folder: "bench/js/results/" },
] as const;

/** The runs that were kept, first those in which most was measured, of these the newest. */
function runs(): Run[] {
  return KEPT.flatMap(({ kind, folder }) => {
    const path = new URL(folder, root);
    const names = existsSync(path) ? readdirSync(path).filter((file) => file.endsWith(".json")) : [];
    const kept = names.map((file): Run => ({ kind, ...(JSON.parse(readFileSync(new URL(file, path), "utf8")) as Recorded) }));
    const measured = ({ cases }: Run) => cases?.length ?? 0;
    return kept.sort((a, b) => measured(b) - measured(a) || b.date.localeCompare(a.date));
  });
}

export const benchmarkTags: Tags = {
  "benchmark-sentence": () => front(runs()).sentence,
  "benchmark-front": () => front(runs()).tables,
};

const NO_BUFFER = "virtual:no-buffer";

/**
 * In the place of a library whose package is not installed, one that says so; and for those
 * written when everybody used browserify, what it gave them of Node.
 */
export const alternatives = (): Plugin => ({
  name: "alternatives",
  enforce: "pre",
  resolveId: (id, importer) => (id === "buffer" && importer?.includes("typedarray-pool") ? `\0${NO_BUFFER}` : undefined),
  load: (id) => (id === `\0${NO_BUFFER}` ? "export const Buffer = { isBuffer: () => false };" : undefined),
  async transform(code, id) {
    if (!/\/bench\/js\/libraries\/[^/]+\.js$/.test(id)) return undefined;
    for (const [, specifier = ""] of code.matchAll(/^import .*? from "([^".][^"]*)";$/gm)) {
      if (await this.resolve(specifier, id)) continue;
      return { code: `export const create = () => { throw new Error("not part of this build"); };`, map: null };
    }
    return undefined;
  },
});
