// What a release needs: one version number, one minimum Rust version, lock files that fit, licenses that we accept, and
// workflows that use fixed versions of actions, have no more rights than they need, and run scripts that exist.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, readdirSync, readFileSync, statSync } from "node:fs";
import { basename, dirname, join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

import { LOCKS, RUST_VERSIONS, SHORT_VERSIONS, VERSIONS, notes, short, valuesOf, withSection } from "../scripts/version.mjs";

const root = dirname(dirname(fileURLToPath(import.meta.url)));
const read = (path) => readFileSync(join(root, path), "utf8");
const workflows = readdirSync(join(root, ".github/workflows")).map((name) => [name, read(`.github/workflows/${name}`)]);
const locks = execFileSync("git", ["ls-files", "*package-lock.json"], { cwd: root, encoding: "utf8" }).trim().split("\n");

for (const [what, places] of [["version", VERSIONS], ["minimum Rust version", RUST_VERSIONS]]) {
  test(`every place has the same ${what}`, () => {
    const values = valuesOf(places);
    const [first] = values.values();
    assert.match(first, /^\d+\.\d+/);
    for (const [place, value] of values) assert.equal(value, first, place);
  });
}

test("the places with two numbers have those of the version", () => {
  const [version] = valuesOf(VERSIONS).values();
  for (const [place, value] of valuesOf(SHORT_VERSIONS)) assert.equal(value, short(version), place);
});

test("the lock files have that version, too", () => {
  const [version] = valuesOf(VERSIONS).values();
  const { packages } = JSON.parse(read("package-lock.json"));
  for (const workspace of ["js", "classroom/demo", "gpu/js", "site"]) assert.equal(packages[workspace].version, version, workspace);
  const locked = LOCKS.map((lock) => [lock, read(lock).match(/^name = "sweep-and-prune"\nversion = "(.*)"/m)?.[1]]);
  assert.ok(locked.filter(([, found]) => found !== undefined).length >= 7, `${locked}`);
  for (const [lock, found = version] of locked) assert.equal(found, version, lock);
});

test("release notes are the section of the changelog", () => {
  const changelog = "# Changelog\n\n## 0.2.0 (2026-12-01)\n\n### Added\n\n- This.\n\n## 0.1.0 (2026-11-23)\n\n- That.\n";
  assert.equal(notes(changelog, "0.2.0"), "### Added\n\n- This.");
  assert.equal(notes(changelog, "0.1.0"), "- That.");
  assert.throws(() => notes(changelog, "0.2"), /no heading/);
  assert.throws(() => notes("## Unreleased (0.2.0)\n", "0.2.0"), /no heading/);
});

test("the next version has a section of its own above what is released", () => {
  assert.equal(withSection("# Changelog\n\n## Unreleased (0.2.0)\n\n- This.\n", "0.3.0"), "# Changelog\n\n## Unreleased (0.3.0)\n\n- This.\n");
  const released = "## 0.2.0 (2026-12-01)\n\n- This.\n\n## 0.1.0 (2026-11-23)\n";
  assert.equal(withSection(`# Changelog\n\n${released}`, "0.2.1"), `# Changelog\n\n## Unreleased (0.2.1)\n\n${released}`);
});

test("each package has the license texts of the repository", () => {
  for (const name of ["LICENSE-MIT", "LICENSE-APACHE"]) {
    for (const folder of ["core", "python", "gpu", "integrations/bevy"]) assert.equal(read(`${folder}/${name}`), read(name), `${folder}/${name}`);
  }
});

test("npm packages have licenses that we accept", () => {
  const accepted = new Set(
    "MIT ISC Apache-2.0 BSD-2-Clause BSD-3-Clause 0BSD Zlib Unlicense CC0-1.0 BlueOak-1.0.0 Python-2.0".split(" "),
  );
  // Data and tools that are used to build and test, and are not part of what we publish.
  const tools = new Set(["MPL-2.0", "CC-BY-4.0", "CC-BY-3.0", "LGPL-3.0-or-later"]);
  const refused = [];
  for (const lock of locks) {
    for (const [name, { license, link }] of Object.entries(JSON.parse(read(lock)).packages)) {
      if (name === "" || link || license === undefined) continue;
      // All of those joined by AND apply, and any of those joined by OR.
      const parts = license.replace(/[()]/g, "").split(" AND ").map((part) => part.split(" OR "));
      if (!parts.every((part) => part.some((word) => accepted.has(word) || tools.has(word)))) refused.push(`${lock}: ${name}: ${license}`);
    }
  }
  assert.deepEqual(refused, []);
});

for (const [name, text] of workflows) {
  test(`${name}: actions are fixed to a commit, and say which version that is`, () => {
    for (const [line] of text.matchAll(/uses:.*/g)) assert.match(line, /uses: [\w.-]+\/[\w./-]+@[0-9a-f]{40} # v\d+\.\d+\.\d+$/);
  });

  test(`${name}: may only read, except where a job says why`, () => {
    assert.match(text, /^permissions:\n {2}contents: read\n$/m);
    for (const [line] of text.matchAll(/^.*: write.*$/gm)) assert.match(line, /^ {6}[\w-]+: write # .+/);
    assert.doesNotMatch(text, /\bsecrets\./);
    const count = (pattern) => text.split(pattern).length;
    assert.equal(count("uses: actions/checkout@"), count("persist-credentials: false"), "a checkout keeps a token");
  });

  test(`${name}: every script that it runs exists`, () => {
    const steps = [...text.matchAll(/run: (?:\|\n)?([^]*?)(?=\n {6}- |\n {8}\w|\n {2}\w|$)/g)].map(([, step]) => step);
    const commands = steps.flatMap((step) => [...step.matchAll(/(?:^|\s)((?:\.\/|\.ci\/|scripts\/)[\w./-]+)/g)]);
    for (const [, command] of commands) {
      if (command.startsWith("./dist")) continue;
      assert.ok(existsSync(join(root, command)), command);
      if (!command.endsWith(".mjs")) assert.ok(statSync(join(root, command)).mode & 0o100, `${command} is not executable`);
    }
  });
}

test("only a pushed tag is published", () => {
  const jobs = read(".github/workflows/release.yml").split(/^ {2}(?=[\w-]+:$)/m);
  const publishing = jobs.filter((job) => /^ {4}environment: release$/m.test(job));
  assert.equal(publishing.length, 3);
  for (const job of publishing) assert.match(job, /^ {4}if: github\.event_name == 'push'$/m);
});

test("one action has one version", () => {
  const versions = new Map();
  for (const [, text] of workflows) {
    for (const [, action, version] of text.matchAll(/uses: ([\w./-]+)@(\S+ # \S+)/g)) {
      assert.equal(versions.get(action) ?? version, version, action);
      versions.set(action, version);
    }
  }
  assert.ok(versions.size >= 5);
});

test("dependabot looks at every lock file and list of requirements", () => {
  const kinds = { "Cargo.lock": "cargo", "package-lock.json": "npm", "requirements.txt": "pip" };
  const configured = new Map();
  for (const update of read(".github/dependabot.yml").split("package-ecosystem: ").slice(1)) {
    const [, folders] = /director(?:ies|y): \[?(.*?)\]?\n/.exec(update);
    configured.set(/^\S+/.exec(update)[0], folders.split(", "));
  }
  const patterns = Object.keys(kinds).map((name) => `*${name}`);
  for (const file of execFileSync("git", ["ls-files", ...patterns], { cwd: root, encoding: "utf8" }).trim().split("\n")) {
    const folder = `/${dirname(file)}`.replace(/\/\.$/, "/");
    assert.ok(configured.get(kinds[basename(file)]).includes(folder), file);
  }
});

test("the scripts that run some JavaScript tests name files that exist", () => {
  const names = ["scripts/test-portable", "scripts/platforms"].flatMap((script) => {
    const [, list] = read(script).match(/for name in (.*); do\n.*js\/test\/\$name\.test\.js/) ?? [];
    assert.ok(list, script);
    return list.split(" ");
  });
  for (const name of names) assert.ok(existsSync(join(root, `js/test/${name}.test.js`)), name);
});
