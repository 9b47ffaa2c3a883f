// Each package as a new user meets it: packed, installed into an empty project, and every example of its README and of
// the repository's README run there. Slow, because each package is built as it would be published: only with
// TEST_PACKAGES=1, which `./test --long` sets.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { homedir, tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, before, describe, test } from "node:test";
import { fileURLToPath } from "node:url";

const root = dirname(dirname(fileURLToPath(import.meta.url)));
const skip = !process.env.TEST_PACKAGES && "only with TEST_PACKAGES=1";
const folder = skip ? "" : mkdtempSync(join(tmpdir(), "sweep-and-prune-packages-"));
after(() => folder && rmSync(folder, { recursive: true, force: true }));

/** Runs a command in a folder and returns what it printed. */
const run = (cwd, command, ...options) =>
  execFileSync(command, options, { cwd, encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });

/** The code blocks of a language in a README of the repository. */
const examples = (readme, language) =>
  [...readFileSync(join(root, readme), "utf8").matchAll(new RegExp(`^\`\`\`${language}\\n(.*?)^\`\`\``, "gms"))].map(
    ([, code]) => code,
  );

/** An empty project. */
function project(name) {
  const path = join(folder, name);
  mkdirSync(path, { recursive: true });
  return path;
}

describe("Rust: the packed crate", { skip }, () => {
  const readmes = ["README.md", "core/README.md"];

  test("runs every example in an empty project", () => {
    const path = project("rust");
    const target = join(folder, "target");
    run(root, "cargo", "package", "--quiet", "--no-verify", "--allow-dirty", "--package", "sweep-and-prune", "--target-dir", target);
    const crates = readdirSync(join(target, "package")).filter((name) => name.endsWith(".crate"));
    assert.equal(crates.length, 1, crates.join());
    run(path, "tar", "-xzf", join(target, "package", crates[0]));
    const unpacked = crates[0].slice(0, -".crate".length);
    for (const file of ["README.md", "LICENSE-MIT", "LICENSE-APACHE"]) readFileSync(join(path, unpacked, file));
    mkdirSync(join(path, "src/bin"), { recursive: true });
    writeFileSync(
      join(path, "Cargo.toml"),
      `[package]\nname = "new-user"\nversion = "0.1.0"\nedition = "2024"\n\n[dependencies]\nsweep-and-prune = { path = "${unpacked}" }\n\n[workspace]\n`,
    );
    const codes = readmes.flatMap((readme) => examples(readme, "rust"));
    assert.ok(codes.length >= 6, `${codes.length} examples`);
    codes.forEach((code, at) => {
      writeFileSync(join(path, `src/bin/example_${at}.rs`), code.includes("fn main") ? code : `fn main() {\n${code}}\n`);
    });
    for (const at of codes.keys()) run(path, "cargo", "run", "--quiet", "--target-dir", target, "--bin", `example_${at}`);
  });
});

describe("JavaScript: the packed packages", { skip }, () => {
  test("prints in an empty project what each example says", () => {
    const path = project("js");
    writeFileSync(join(path, "package.json"), '{ "private": true, "type": "module" }');
    // They are built already: `npm pack` would build them again.
    const pack = (folder) => run(join(root, folder), "npm", "pack", "--ignore-scripts", "--silent", "--pack-destination", path).trim();
    run(path, "npm", "install", "--silent", "--no-audit", "--no-fund", ...["js", "classroom/demo"].map((folder) => `./${pack(folder)}`));
    assert.match(readFileSync(join(path, "node_modules/sweep-and-prune-classroom/dist/LICENSE-DEPENDENCIES"), "utf8"), /BSD 3-Clause/);
    const codes = ["README.md", "js/README.md", "classroom/demo/README.md"].flatMap((readme) => examples(readme, "js"));
    assert.ok(codes.length >= 6, `${codes.length} examples`);
    for (const [at, code] of codes.entries()) {
      const expected = [...code.matchAll(/console\.log\(.*\);\s*\/\/ (.*)/g)].flatMap(([, said]) => said.split(" | "));
      assert.ok(expected.length > 0, code);
      writeFileSync(join(path, `example-${at}.js`), code);
      assert.deepEqual(run(path, process.execPath, `example-${at}.js`).trim().split("\n"), expected);
    }
  });
});

describe("Python: the wheel and the source distribution", { skip }, () => {
  const dist = skip ? "" : join(folder, "dist");
  const of = (ending) => join(dist, readdirSync(dist).find((name) => name.endsWith(ending)));
  // Long tests are for `./test python --long`: what is installed is the same code.
  const { TEST_LONG, ...env } = process.env;
  const tryWheel = (python, ...options) =>
    execFileSync("scripts/try-wheel", options, { cwd: root, env: { ...env, PYTHON: python }, stdio: "inherit" });

  before(() => {
    if (skip) return;
    execFileSync("scripts/wheels", [dist], { cwd: root, env: { ...process.env, PROFILE: "checked" }, stdio: "inherit" });
  });

  test("prints in a fresh environment what each example says", () => {
    const path = project("python");
    const python = join(path, "environment/bin/python");
    run(path, "python3", "-m", "venv", "environment");
    run(path, python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", of(".whl"));
    const codes = ["README.md", "python/README.md"].flatMap((readme) => examples(readme, "python"));
    assert.ok(codes.length >= 4, `${codes.length} examples`);
    // Not needed by the package, but one example uses it, and its readers have it.
    run(path, python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "pandas");
    for (const code of codes) {
      const expected = [...code.matchAll(/^\s*print\(.*\)\s+# (.*)$/gm)].map(([, said]) => said);
      assert.ok(expected.length > 0, code);
      assert.deepEqual(run(path, python, "-c", code).trim().split("\n"), expected);
    }
  });

  test("passes its whole suite with all optional libraries", () => {
    tryWheel("python3", of(".whl"), "--requirement=python/requirements.txt");
  });

  test("passes on the oldest Python and NumPy, and on the newest", () => {
    const [oldest, newest] = [pythons().at(0), pythons().at(-1)];
    tryWheel(oldest, of(".whl"), ...(oldest.includes("3.9") ? ["numpy==1.22.*"] : []));
    tryWheel(newest, of(".whl"));
  });

  test("builds from the source distribution", () => tryWheel("python3", of(".tar.gz")));
});

/** The Pythons of this machine that the package supports, oldest first: on the PATH, or installed by pyenv. */
function pythons() {
  const versions = join(process.env.PYENV_ROOT ?? join(homedir(), ".pyenv"), "versions");
  const installed = existsSync(versions) ? readdirSync(versions) : [];
  return [9, 10, 11, 12, 13, 14, 15].flatMap((minor) => {
    const folders = installed.filter((name) => name.startsWith(`3.${minor}.`));
    const names = [`python3.${minor}`, ...folders.map((name) => join(versions, name, "bin/python"))];
    const works = (name) => spawnSync(name, ["-c", "import ensurepip, venv"]).status === 0;
    return names.filter(works).slice(0, 1);
  });
}
