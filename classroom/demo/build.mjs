// Builds dist/: the compiled algorithms and balls, the modules, their declarations. Fails if a file is over its size budget.
import { copyFileSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { begin, buildDeclarations, buildModules, compile, writeCore } from "../../scripts/npm-package.mjs";

const here = fileURLToPath(new URL(".", import.meta.url));
const dist = join(here, "dist");

const small = { all: "s", core: "s", flags: [] };

/** Styles of elements without their comments and indentation. */
const leanStyles = {
  name: "lean styles",
  setup: ({ onLoad }) =>
    onLoad({ filter: /src.element.(styles|comparison)\.ts$/ }, ({ path }) => ({
      contents: readFileSync(path, "utf8").replace(/css`[^`]*`/g, (css) => css.replace(/\/\*.*?\*\//gs, "").replace(/\s+/g, " ")),
      loader: "ts",
    })),
};

const end = begin(here);
const [algorithms, simulation] = await Promise.all([
  compile("sweep-and-prune-algorithms-wasm", { directory: "wasm-scalar/algorithms", levels: small }),
  compile("sweep-and-prune-simulation-wasm", { directory: "wasm-demo", levels: small }),
]);
// Budgets in bytes after gzip: what a page downloads before the first step.
writeCore(join(dist, "algorithms.wasm"), algorithms, { budget: 47_000, simd: false });
writeCore(join(dist, "simulation.wasm"), simulation, { budget: 125_000, simd: false });

const entries = [
  { name: "index", source: "src/index.ts", budget: 8_500 },
  { name: "variants", source: "src/variants.ts", budget: 1_500 },
  // With Lit, which it draws its controls by, and 1 KB of messages that name what is wrong with boxes.
  { name: "demo", source: "src/demo.ts", budget: 42_000 },
];
// What goes wrong in a demo is shown in its place: short names are 4 KB less to download.
await buildModules(here, [...entries, { name: "inline", source: "inline:src/index.ts" }], { plugins: [leanStyles], hasShortNames: true });
await buildDeclarations(here, entries);
copyFileSync(join(here, "src/element/demo.css"), join(dist, "demo.css"));
end();
