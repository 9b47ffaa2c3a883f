// Which file of a folder of TypeScript or JavaScript imports which other file of it.
import { readFileSync, readdirSync } from "node:fs";
import { dirname, join, resolve } from "node:path";

const withoutComments = (source) => source.replace(/\/\*[\s\S]*?\*\/|^\s*\/\/[^\n]*/gm, "");

/** Map of file -> Map of imported file -> names. Imports of types count, and so do re-exports. */
export function typescriptImports(folder) {
  const files = readdirSync(folder, { recursive: true })
    .filter((file) => /\.(ts|js|mjs)$/.test(file) && !file.endsWith(".d.ts"))
    .map((file) => join(folder, file));
  const known = new Set(files);
  const graph = new Map();
  for (const file of files) {
    const imports = new Map();
    const source = withoutComments(readFileSync(file, "utf8"));
    const statements = source.matchAll(
      /\b(?:import|export)\b([^"'`;()]*?)\bfrom\s*["']([^"']+)["']|\bimport\s*\(?\s*["']([^"']+)["']/g,
    );
    for (const [, names = "", from, bare] of statements) {
      const specifier = from ?? bare;
      if (!specifier.startsWith(".")) continue;
      const path = resolve(dirname(file), specifier);
      const target = [path, path.replace(/\.js$/, ".ts"), `${path}.ts`].find((it) => known.has(it));
      if (!target || target === file) continue;
      if (!imports.has(target)) imports.set(target, new Set());
      for (const name of names.match(/[\w$*]+/g) ?? ["(module)"]) {
        if (name !== "type") imports.get(target).add(name);
      }
    }
    graph.set(file, imports);
  }
  return graph;
}
