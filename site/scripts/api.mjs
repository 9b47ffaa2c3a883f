// Documentation of the library in each language, made by that language's own tool, into public/api,
// from where the site's build takes it. Quick when nothing has changed. Where a tool fails it says
// why, and the pages are built without a link to what is not there.

import { spawnSync } from "node:child_process";
import { cpSync, existsSync, readdirSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { dirname, join, relative, resolve } from "node:path";
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

/** What each page of the documentation has in addition: the way back to the site. */
const BACK = "back-to-the-site";

/**
 * Adds the way back, once, and mends what makes browsers complain: an icon that is missing, and fonts that rustdoc
 * preloads and then does not use.
 */
function finish(file) {
  const page = readFileSync(file, "utf8");
  if (page.includes(BACK)) return;
  const style = "position:fixed;right:12px;bottom:12px;z-index:999;padding:12px 16px;border-radius:8px;background:#0e6670;color:#fff;font:600 15px/20px system-ui,sans-serif;text-decoration:none";
  const link = `<a id="${BACK}" href="${relative(dirname(file), join(output, "../api.html"))}" style="${style}">← sweep-and-prune</a>`;
  const preload = /<script>if\(window\.location\.protocol!=="file:"\)document\.head\.insertAdjacentHTML\("beforeend",.*?<\/script>/s;
  const icon = /rel="(alternate )?icon"/.test(page) ? "" : `<link rel="icon" href="${relative(dirname(file), join(output, "../icon.svg"))}" type="image/svg+xml">`;
  // At the end: the first thing that a keyboard reaches stays what the tool has made it.
  writeFileSync(file, page.replace(preload, "").replace(/<\/head>/i, (end) => icon + end).replace(/<\/body>/i, (end) => link + end));
}

// The folder of the crate's documentation has no page of its own: it leads to the first one.
if (existsSync(join(output, "rust"))) {
  writeFileSync(join(output, "rust/index.html"), `<!doctype html><html lang="en"><title>sweep_and_prune</title><meta http-equiv="refresh" content="0; url=sweep_and_prune/index.html"><body><a href="sweep_and_prune/index.html">Documentation of the crate</a></body></html>\n`);
}

for (const { parentPath, name } of existsSync(output) ? readdirSync(output, { withFileTypes: true, recursive: true }) : []) {
  if (name.endsWith(".html")) finish(join(parentPath, name));
}
