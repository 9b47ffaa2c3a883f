// Builds dist/: the module with the shaders inside, and its declarations. Fails if the module is over its size budget.
import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { begin, buildDeclarations, buildModules } from "../../scripts/npm-package.mjs";

const here = fileURLToPath(new URL(".", import.meta.url));

/** The shaders, which the Rust crate has too, without their comments. */
const shaders = {
  name: "shaders",
  setup: ({ onLoad }) =>
    onLoad({ filter: /\.wgsl$/ }, ({ path }) => ({
      contents: readFileSync(path, "utf8")
        .replace(/\/\/.*$/gm, "")
        .replace(/\s*\n\s*/g, "\n"),
      loader: "text",
    })),
};

const end = begin(here);
// In bytes after gzip.
const entries = [{ name: "index", source: "src/index.ts", budget: 10_500 }];
await buildModules(here, entries, { plugins: [shaders] });
await buildDeclarations(here, entries);
end();
