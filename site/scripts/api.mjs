// Documentation of the library in each language, made by that language's own tool, into public/api,
// from where the site's build takes it. Quick when nothing has changed. Where a tool fails it says
// why, and the pages are built without a link to what is not there.

import { spawnSync } from "node:child_process";
import { cpSync, existsSync, readdirSync, rmSync, statSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const root = resolve(dirname(fileURLToPath(import.meta.url)), "../..");
const output = join(root, "site/public/api");
// A folder of its own: the usual one may hold the documentation of every crate there is.
const target = join(resolve(root, process.env.CARGO_TARGET_DIR ?? "target"), "api");

const cargo = ["doc", "--quiet", "--no-deps", "--package", "sweep-and-prune", "--target-dir", target];
// The environment that ./run and ./test set up.
const python = join(root, ".tools/python/bin/python");
const pythonPages = join(target, "python");
const languages = [
  { name: "rust", sources: ["core"], tool: ["cargo", cargo], made: join(target, "doc"), first: "sweep_and_prune/index.html" },
  {
    name: "js",
    sources: ["js/src", "js/README.md", "js/docs/api"],
    tool: ["npm", ["run", "--silent", "docs", "--workspace", "js"]],
    made: join(root, "js/dist-docs"),
    first: "index.html",
  },
  {
    name: "python",
    sources: ["python/src", "python/docs.py", "docs/guide"],
    tool: [python, [join(root, "python/docs.py"), pythonPages]],
    made: pythonPages,
    first: "sweep_and_prune.html",
  },
];

/** When the newest file below a path was written. */
function newest(path) {
  const stat = statSync(path);
  if (!stat.isDirectory()) return stat.mtimeMs;
  const inside = readdirSync(path).filter((name) => !/^(node_modules|__pycache__|_native\..*(so|pyd))$/.test(name));
  return Math.max(0, ...inside.map((name) => newest(join(path, name))));
}

for (const { name, sources, tool, made, first } of languages) {
  const folder = join(output, name);
  const written = existsSync(join(folder, first)) ? statSync(join(folder, first)).mtimeMs : 0;
  if (Math.max(...sources.map((path) => newest(join(root, path)))) < written) continue;
  const { status, error } = spawnSync(...tool, { cwd: root, stdio: "inherit" });
  rmSync(folder, { recursive: true, force: true });
  if (status === 0) cpSync(made, folder, { recursive: true });
  else console.error(`The documentation for ${name} is left out: ${error?.message ?? `${tool[0]} failed`}.`);
}
