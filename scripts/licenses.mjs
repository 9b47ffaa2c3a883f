// The license texts of what other projects wrote and a package contains, compiled: their condition is that they go with it.
//
//   node scripts/licenses.mjs MANIFEST     prints the texts of the crates that are linked into a crate, on any platform
import { execFileSync } from "node:child_process";
import { readFileSync, readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

/** The texts of the crates of registries that are linked into what `options` of `cargo tree` choose in a workspace. */
export function textsOfCrates(manifest, ...options) {
  const cargo = (...command) => execFileSync("cargo", [...command, "--manifest-path", manifest], { encoding: "utf8", maxBuffer: 2 ** 28 });
  const { packages } = JSON.parse(cargo("metadata", "--locked", "--format-version=1"));
  const linked = new Set(cargo("tree", "--locked", "--edges=normal,no-proc-macro", "--prefix=none", "--no-dedupe", "--format={p}", ...options).split("\n"));
  return packages
    .filter(({ name, version, source }) => source !== null && linked.has(`${name} v${version}`))
    .map(({ name, version, manifest_path }) => textOf(`${name} ${version}`, dirname(manifest_path)));
}

/** The texts of the npm packages that modules belong to; modules of our own belong to none. */
export function textsOfModules(paths) {
  const folders = new Set(paths.flatMap((path) => path.match(/^.*node_modules\/(@[^/]+\/)?[^/]+/)?.[0] ?? []));
  return [...folders].map((folder) => {
    const { name, version } = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
    return textOf(`${name} ${version}`, folder);
  });
}

/** The text of a package that lies in a folder. If it may be used under one of several licenses, MIT, which is the shortest. */
function textOf(name, folder) {
  const all = readdirSync(folder).filter((file) => /^licen[cs]e/i.test(file));
  const [file] = all.length > 1 ? all.filter((file) => /MIT/.test(file)) : all;
  if (file === undefined) throw new Error(`which of the files ${all} is the license text of ${name}?`);
  return `${name}\n\n${readFileSync(join(folder, file), "utf8").trim()}\n`;
}

/** One file of such texts. */
export const joined = (texts) => [...new Set(texts)].sort().join(`\n${"-".repeat(80)}\n\n`);

if (process.argv[1] === fileURLToPath(import.meta.url)) process.stdout.write(joined(textsOfCrates(process.argv[2], "--target=all")));
