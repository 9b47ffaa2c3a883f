// What the benchmark page needs when the site is built: the recorded results, as the page reads
// them and as files to download, and the alternatives, of which those that are not installed are left out.

import { readdirSync, readFileSync } from "node:fs";
import type { Plugin } from "vite";
import { insertFront } from "./front.ts";
import type { Case, Outcome, Recorded, Run } from "./results.ts";

const root = new URL("../../../", import.meta.url);

/** Where runs are kept, and whose. */
const KEPT = [
  { kind: "native", name: "Rust and C++", folder: "bench/results/" },
  { kind: "javascript", name: "JavaScript, in Node", folder: "bench/js/results/" },
] as const;

const MODULE = "virtual:benchmark-results";

/** The files of results: the address that each is offered at, and its text. */
function files(): { kind: Run["kind"]; name: string; address: string; text: string }[] {
  return KEPT.flatMap(({ kind, name, folder }) => {
    const path = new URL(folder, root);
    const names = list(path).filter((file) => file.endsWith(".json"));
    // The newest first: the date is at the end of the name.
    names.sort((a, b) => b.slice(-15).localeCompare(a.slice(-15)));
    return names.map((file) => ({
      kind,
      name,
      address: `results/${kind}/${file}`,
      text: readFileSync(new URL(file, path), "utf8"),
    }));
  });
}

function list(folder: URL): string[] {
  try {
    return readdirSync(folder);
  } catch {
    return []; // nothing was kept yet
  }
}

/** The runs without what the page does not show: half the size. */
export function runs(): Run[] {
  return files().map(({ kind, name, address, text }) => {
    const { date, machine, node, rustc, versions = {}, how = {}, cases = [], worlds = [] } = JSON.parse(text) as Recorded;
    const tools = node ?? rustc ?? "";
    return { kind, name, address, date, machine, tools, versions, how, cases: cases.map(slim), worlds: worlds.map(slim) };
  });
}

function slim({ scene, dimensions, boxes, pairs, reference, load = null, results }: Case): Case {
  const kept = results.map(({ name, alternative, outcome }) => ({ name, alternative, outcome: slimOutcome(outcome) }));
  return { scene, dimensions, boxes, pairs, reference, load, results: kept };
}

function slimOutcome(outcome: Outcome): Outcome {
  if (!("Timed" in outcome)) return outcome;
  const { median_ns, ratio, peak_bytes } = outcome.Timed;
  return { Timed: { median_ns: Math.round(median_ns), ratio: ratio && Number(ratio.toPrecision(4)), peak_bytes } };
}

/** The most scenes of a run: the plot that has a row for each is as high from the start. */
const rows = (): number =>
  Math.max(0, ...runs().flatMap(({ cases, worlds }) => [cases, worlds].map((of) => new Set(of.map(({ scene, dimensions }) => `${scene} ${dimensions}`)).size)));

export const benchmark: Plugin = {
  name: "benchmark",
  transformIndexHtml: (page) =>
    insertFront(page, runs()).replace('id="plot-ratio"', `id="plot-ratio" style="--rows: ${rows()}"`),
  resolveId: (id) => (id === MODULE ? `\0${MODULE}` : undefined),
  load: (id) => (id === `\0${MODULE}` ? `export default ${JSON.stringify(runs())}` : undefined),
  generateBundle() {
    for (const { address, text } of files()) this.emitFile({ type: "asset", fileName: address, source: text });
  },
  configureServer(server) {
    server.middlewares.use((request, response, next) => {
      const file = files().find(({ address }) => request.url === `/${address}`);
      if (!file) return next();
      response.setHeader("content-type", "application/json");
      response.end(file.text);
    });
  },
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
