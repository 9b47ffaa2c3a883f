// Prints the import cycles of the sources, and with `--all` what each file imports. tests/imports.test.mjs
// says what counts as an import.
import { existsSync } from "node:fs";
import { dirname, join, relative } from "node:path";
import { fileURLToPath } from "node:url";

import { cyclicGroups, shortestCycle } from "./support/cycles.mjs";
import { crateRoot, rustImports } from "./support/rust-imports.mjs";
import { typescriptImports } from "./support/typescript-imports.mjs";

export const root = dirname(dirname(fileURLToPath(import.meta.url)));

/** The folders that must be without cycles, and the fewest files that they have: finding fewer, the test would test nothing. */
export const FOLDERS = {
  "core/src": 90,
  "scenes/src": 8,
  "fuzz/src": 7,
  "classroom/algorithms/src": 18,
  "classroom/algorithms/wasm/src": 4,
  "classroom/simulation/src": 14,
  "classroom/simulation/wasm/src": 3,
  "classroom/demo/src": 45,
  "bindings/src": 9,
  "bindings/wasm/src": 4,
  "js/src": 30,
  "js/wasm/src": 6,
  "gpu/src": 11,
  "gpu/js/src": 12,
  "integrations/bevy/src": 3,
  "bench/src": 30,
  "bench/complexity/src": 6,
  "bench/js/src": 10,
  "bench/js/frames": 9,
  "bench/js/libraries": 20,
  "python/extension": 8,
  "c/src": 11,
  "site/src": 90,
  "site/wasm/src": 4,
};

/** Which file of a folder imports which: file -> imported file -> names. */
export const importsOf = (folder) => {
  const path = join(root, folder);
  return existsSync(join(path, "lib.rs")) || existsSync(join(path, "main.rs")) ? rustImports(crateRoot(path)) : typescriptImports(path);
};

/** A group of files that import each other, for people: one shortest cycle, and who else is in it. */
export function report(graph, group) {
  const name = (file) => relative(root, file);
  const cycle = shortestCycle(graph, group);
  const steps = cycle.slice(1).map((to, at) => {
    const names = [...graph.get(cycle[at]).get(to)].sort().join(", ");
    return `    ${name(cycle[at])} imports ${names} of ${name(to)}`;
  });
  const others = group.filter((file) => !cycle.includes(file)).map(name);
  const rest = others.length > 0 ? `\n  in cycles with these: ${others.join(", ")}` : "";
  return `  a cycle:\n${steps.join("\n")}${rest}`;
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  for (const folder of Object.keys(FOLDERS)) {
    const graph = importsOf(folder);
    console.log(`${folder}: ${graph.size} files`);
    for (const group of cyclicGroups(graph)) console.log(report(graph, group));
    if (!process.argv.includes("--all")) continue;
    for (const [file, imports] of graph) {
      console.log(`  ${relative(root, file)}`);
      for (const [to, names] of imports) console.log(`    ${relative(root, to)}: ${[...names].join(", ")}`);
    }
  }
}
