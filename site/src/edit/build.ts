// What runs a reader's code, made when the site is built: the script of the sandbox's worker as text, and listings as functions.

import { fileURLToPath } from "node:url";
import { build, type Plugin, type Rolldown } from "vite";
import { readListing } from "../code/listing.ts";
import { helpers } from "./helpers.ts";
import { withLines } from "./lines.ts";

const LISTING = "virtual:listing/";
const WORKER = "virtual:sandbox-worker";

/** A listing as a function of the names that it uses. */
function listingModule(name: string): string {
  const { code } = readListing(name);
  const exported = [...code.matchAll(/^export function (\w+)/gm)].map(([, name]) => name);
  const used = Object.keys(helpers).filter((name) => !exported.includes(name));
  return `export const compile = ({ $line, ${used.join(", ")} }) => {\n${withLines(code).replaceAll("export ", "")}\nreturn { ${exported.join(", ")} };\n};`;
}

export const listings: Plugin = {
  name: "listings",
  resolveId: (id) => (id.startsWith(LISTING) ? `\0${id}` : undefined),
  load: (id) => (id.startsWith(`\0${LISTING}`) ? listingModule(id.slice(LISTING.length + 1)) : undefined),
};

export const sandboxWorker: Plugin = {
  name: "sandbox-worker",
  resolveId: (id) => (id === WORKER ? `\0${WORKER}` : undefined),
  async load(id) {
    if (id !== `\0${WORKER}`) return undefined;
    const entry = fileURLToPath(new URL("./worker.ts", import.meta.url));
    const built = await build({
      configFile: false,
      logLevel: "error",
      plugins: [listings],
      build: { write: false, minify: true, target: "es2022", lib: { entry, formats: ["iife"], name: "worker" } },
    });
    const [{ output }] = built as Rolldown.RolldownOutput[] as [Rolldown.RolldownOutput];
    return `export default ${JSON.stringify(output[0].code)};`;
  },
};
