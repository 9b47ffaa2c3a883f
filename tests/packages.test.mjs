// Each package as a new user meets it: packed, installed into an empty project, and every example of its README and of
// the repository's README run there. Slow, because each package is built as it would be published: only with
// TEST_PACKAGES=1, which `./test --long` sets.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, describe, test } from "node:test";
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

describe("JavaScript: the packed package", { skip }, () => {
  test("prints in an empty project what each example says", () => {
    const path = project("js");
    writeFileSync(join(path, "package.json"), '{ "private": true, "type": "module" }');
    // js/dist is built already: `npm pack` would build it again.
    const packed = run(join(root, "js"), "npm", "pack", "--ignore-scripts", "--silent", "--pack-destination", path).trim();
    run(path, "npm", "install", "--silent", "--no-audit", "--no-fund", `./${packed}`);
    const codes = ["README.md", "js/README.md"].flatMap((readme) => examples(readme, "js"));
    assert.ok(codes.length >= 6, `${codes.length} examples`);
    for (const [at, code] of codes.entries()) {
      const expected = [...code.matchAll(/console\.log\(.*\);\s*\/\/ (.*)/g)].flatMap(([, said]) => said.split(" | "));
      assert.ok(expected.length > 0, code);
      writeFileSync(join(path, `example-${at}.js`), code);
      assert.deepEqual(run(path, process.execPath, `example-${at}.js`).trim().split("\n"), expected);
    }
  });
});

describe("Python: the wheel", { skip }, () => {
  test("prints in a fresh environment what each example says", () => {
    const path = project("python");
    const wheels = join(folder, "wheels");
    run(root, "maturin", "build", "--quiet", "--profile", "checked", "--manifest-path", "python/Cargo.toml", "--out", wheels);
    const [wheel, ...more] = readdirSync(wheels);
    assert.ok(wheel && more.length === 0, `${wheel}, ${more}`);
    const python = join(path, "environment/bin/python");
    run(path, "python3", "-m", "venv", "environment");
    run(path, python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", join(wheels, wheel));
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
});
