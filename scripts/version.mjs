// All packages have one version number and one minimum Rust version. This says where they stand.
//
//   node scripts/version.mjs           prints the version; fails if two places differ
//   node scripts/version.mjs 0.2.0     writes a new version to every place, and to the lock files
//   node scripts/version.mjs --tag v0.2.0
//       prints what the changelog says of this release; fails if the tag names another version than the files
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const root = dirname(dirname(fileURLToPath(import.meta.url)));
const read = (file) => readFileSync(join(root, file), "utf8");

/** Where the version stands: a pattern with three groups, the second of which is the version. Each matches once. */
export const VERSIONS = [
  ["Cargo.toml", /^(version = ")(.*?)(")/m],
  ["Cargo.toml", /^(sweep-and-prune = .*version = ")(.*?)(")/m],
  ["Cargo.toml", /^(sweep-and-prune-scenes = .*version = ")(.*?)(")/m],
  ["python/Cargo.toml", /^(version = ")(.*?)(")/m],
  ["gpu/Cargo.toml", /^(version = ")(.*?)(")/m],
  ["gpu/Cargo.toml", /^(sweep-and-prune = .*version = ")(.*?)(")/m],
  ["integrations/bevy/Cargo.toml", /^(version = ")(.*?)(")/m],
  ["integrations/bevy/Cargo.toml", /^(sweep-and-prune = .*version = ")(.*?)(")/m],
  ["python/conda/recipe.yaml", /^( *version: ")(.*?)(")/m],
  ["c/Cargo.toml", /^(version = ")(.*?)(")/m],
  ["js/package.json", /^( *"version": ")(.*?)(")/m],
  ["js/README.md", /(npm\/sweep-and-prune@)(.*?)(\/)/],
  ["classroom/demo/package.json", /^( *"version": ")(.*?)(")/m],
  ["gpu/js/package.json", /^( *"version": ")(.*?)(")/m],
  ["site/package.json", /^( *"version": ")(.*?)(")/m],
  ["site/package.json", /^( *"sweep-and-prune": ")(.*?)(")/m],
  ["site/package.json", /^( *"sweep-and-prune-classroom": ")(.*?)(")/m],
  ["site/package.json", /^( *"sweep-and-prune-gpu": ")(.*?)(")/m],
  ["CHANGELOG.md", /^(## (?:Unreleased \()?)(\d[^ )\n]*)(\)?.*)$/m],
];

/** Where its first two numbers stand: versions that agree in them are compatible. */
export const SHORT_VERSIONS = [
  ["c/README.md", /(find_package\(SweepAndPrune )(.*?)( )/],
  ["integrations/bevy/README.md", /^(bevy_sweep_and_prune = ")(.*?)(")/m],
];

/** Where the minimum Rust version stands. */
export const RUST_VERSIONS = [
  ["Cargo.toml", /^(rust-version = ")(.*?)(")/m],
  ["gpu/Cargo.toml", /^(rust-version = ")(.*?)(")/m],
  ["gpu/README.md", /(Rust )([\d.]+)( or\s+later)/],
  ["python/Cargo.toml", /^(rust-version = ")(.*?)(")/m],
  ["python/conda/recipe.yaml", /(rust >=)(.*?)($)/m],
  ["c/Cargo.toml", /^(rust-version = ")(.*?)(")/m],
  ["README.md", /(Rust )([\d.]+)( or later)/],
  ["core/README.md", /(Rust )([\d.]+)( or newer)/],
  ["python/README.md", /(Rust )([\d.]+)( or later)/],
];

/** The lock files of cargo. */
export const LOCKS = execFileSync("git", ["ls-files", "*Cargo.lock"], { cwd: root, encoding: "utf8" }).trim().split("\n");

/** The first two numbers of a version. */
export const short = (version) => version.replace(/\.\d+$/, "");

/** The value of each place, by a name of the place. */
export const valuesOf = (places) =>
  new Map(places.map(([file, pattern]) => [`${file} ${pattern.source}`, read(file).match(pattern)?.[2]]));

/** The one version number. */
export function version() {
  const values = valuesOf(VERSIONS);
  const [first] = values.values();
  const check = (places, wanted) => {
    for (const [place, value] of places) if (value !== wanted) throw new Error(`${place} has ${value}, not ${wanted}`);
  };
  check(values, first);
  check(valuesOf(SHORT_VERSIONS), short(first));
  return first;
}

/** What the changelog says of a released version. */
export function notes(changelog, released) {
  const [, ...sections] = changelog.split(/^## /m);
  const section = sections.find((text) => text.startsWith(`${released} (`));
  if (!section) throw new Error(`CHANGELOG.md has no heading "## ${released} (DATE)"`);
  return section.slice(section.indexOf("\n")).trim();
}

/** The changelog with a section for the next version: a released section, whose heading has a date, keeps its heading. */
export const withSection = (changelog, next) =>
  changelog.replace(/^## .*/m, (heading) => `## Unreleased (${next})${heading.includes("Unreleased") ? "" : `\n\n${heading}`}`);

function write(next) {
  if (!/^\d+\.\d+\.\d+$/.test(next)) throw new Error(`${next} is not of the form 1.2.3`);
  const change = (file, changed) => writeFileSync(join(root, file), changed(read(file)));
  change("CHANGELOG.md", (changelog) => withSection(changelog, next));
  for (const [file, pattern] of VERSIONS) change(file, (text) => text.replace(pattern, `$1${next}$3`));
  for (const [file, pattern] of SHORT_VERSIONS) change(file, (text) => text.replace(pattern, `$1${short(next)}$3`));
  const run = (...command) => execFileSync(command[0], command.slice(1), { cwd: root, stdio: "inherit" });
  run("npm", "install", "--package-lock-only", "--ignore-scripts", "--no-audit", "--no-fund");
  for (const lock of LOCKS) run("cargo", "update", "--quiet", "--workspace", "--manifest-path", lock.replace(/lock$/, "toml"));
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const [first, tag] = process.argv.slice(2);
  if (first === "--tag") {
    if (tag !== `v${version()}`) throw new Error(`the tag ${tag} is not v${version()}`);
    console.log(notes(read("CHANGELOG.md"), version()));
  } else {
    if (first !== undefined) write(first);
    console.log(version());
  }
}
