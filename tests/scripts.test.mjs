// The scripts fail when what they check is wrong, and take the programs that they should: run beside programs that stand in
// for cargo and others.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { delimiter, dirname, join } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath } from "node:url";

import { textsOfCrates, textsOfModules } from "../scripts/licenses.mjs";

const root = dirname(dirname(fileURLToPath(import.meta.url)));
const folder = mkdtempSync(join(tmpdir(), "sweep-and-prune-scripts-"));
after(() => rmSync(folder, { recursive: true, force: true }));

/** Writes a program of bash, and returns its folder. */
function program(path, text) {
  mkdirSync(join(folder, dirname(path)), { recursive: true });
  writeFileSync(join(folder, path), `#!/usr/bin/env bash\n${text}\n`, { mode: 0o755 });
  return join(folder, dirname(path));
}

/** Runs a command of bash, with folders before the rest of the PATH. */
function bash(command, { before = [], ...env } = {}) {
  const { CARGO_TARGET_DIR: _, PATH, ...rest } = process.env;
  const { status, stdout, stderr } = spawnSync("bash", ["-euo", "pipefail", "-c", command], {
    cwd: root,
    env: { ...rest, ...env, PATH: [...before, PATH].join(delimiter) },
    encoding: "utf8",
  });
  return { status, stdout: stdout.trim(), stderr };
}

const setup = "root=$PWD; . scripts/setup.sh;";

test("scripts/platforms --native compares every kernel with the table, and sees a crash", () => {
  const before = [program("cargo/cargo", `[ "$1" != metadata ] || echo '{"target_directory":"${folder}"}'`)];
  program("cargo/rustup", "");
  program("cargo/rustc", `echo ${folder}`);
  const [, hashes] = readFileSync(join(root, "docs/testing.md"), "utf8").match(/\| scalar \| (.*) \|$/m);
  const right = hashes.replace(/[`|]/g, "");
  const wrong = right.replace(/.$/, (digit) => (digit === "0" ? "1" : "0"));
  const compare = (text) => {
    program("checked/examples/platform", text);
    return bash("scripts/platforms --native", { before });
  };
  assert.deepEqual(compare(`echo scalar ${right}; echo AVX2 ${right}`), { status: 0, stdout: "", stderr: "" });
  assert.match(compare(`echo scalar ${right}; echo AVX2 ${wrong}`).stderr, /other hashes than AVX2/);
  assert.match(compare(`echo scalar ${right}; exit 1`).stderr, /It failed/);
  assert.match(compare("").stderr, /It printed nothing/);
});

test("./test knows which parts ran to their ends, also where a later process has the number of one that ended", () => {
  const numbers = "/proc/sys/kernel/ns_last_pid"; // which root may set, on Linux; elsewhere every process has a new number
  const { stdout, stderr } = bash(`
    failed=$(mktemp); ended=$(mktemp); number=$(mktemp)
    parts=(good early slow slower third)
    test_good() { ps -o ppid= -p "$BASHPID" >"$number"; }
    test_early() { false; echo "goes on"; }
    test_slow() {
      until [ -s "$number" ]; do sleep 0.1; done
      local last=$(($(cat "$number") - 1))
      for ((SECONDS = 0; SECONDS < 3;)); do { echo "$last" >${numbers}; } 2>/dev/null || true; done
    }
    test_slower() { test_slow; }
    test_third() { :; }
    eval "$(sed -n '/^two_at_a_time() {/,/^}/p; /^run_part() {/,/^}/p' test)"
    two_at_a_time
    cat "$failed"
    rm "$failed" "$ended" "$number"`);
  assert.deepEqual([stdout, stderr], ["early, which ended early", ""]);
});

for (const [script, wrong] of [["audit", "--advisory"], ["pack", ""], ["platforms", "--nativ"], ["try-wheel", "--wheels"], ["wheels", ""]]) {
  test(`scripts/${script} says what its arguments are, and fails without those that it needs`, () => {
    assert.equal(bash(`scripts/${script} --help`).status, 0);
    const { status, stderr } = bash(`scripts/${script} ${wrong}`);
    assert.equal(status, 1);
    assert.match(stderr, /^.* is (missing|not|neither)\b.*\n$/);
  });
}

test("rustup's cargo comes before the system's", () => {
  const rustup = program("home/bin/cargo", "");
  program("home/bin/rustup", "");
  program("home/bin/rustc", `echo ${folder}`);
  const system = program("system/cargo", "exit 1");
  program("system/cc", "");
  const chosen = (...before) => bash(`${setup} setup_rust; command -v cargo`, { before }).stdout;
  assert.equal(chosen(system, rustup), join(rustup, "cargo"));
  assert.equal(chosen(rustup, system), join(rustup, "cargo"));
});

test("programs of another version are not used", () => {
  const installs = (name) => bash(`${setup} root=${folder}; setup_${name}`, { before: [join(folder, "old")] }).stderr;
  program("old/go", "");
  program("old/cargo", "");
  for (const [name, path, said] of [["actionlint", "old/actionlint", "v"], ["cargo_deny", "old/cargo-deny", "cargo-deny "]]) {
    const [, version] = readFileSync(join(root, "scripts/setup.sh"), "utf8").match(new RegExp(`setup_${name}\\(.*\\n.*version=(\\S+)`));
    program(path, `echo ${said}${version}`);
    assert.equal(installs(name), "");
    program(path, `echo ${said}0.0.1`);
    assert.match(installs(name), /Installing/);
  }
});

test("what cargo builds is looked for where its settings say", () => {
  mkdirSync(join(folder, "settings"), { recursive: true });
  writeFileSync(join(folder, "settings/config.toml"), `[build]\ntarget-dir = "${folder}/elsewhere"\n`);
  const found = bash(`${setup} target_directory; target_directory c/Cargo.toml`, { CARGO_HOME: join(folder, "settings") });
  assert.equal(found.stdout, `${folder}/elsewhere\n${folder}/elsewhere`);
});

test("the license texts of what is compiled in are found: of crates, and of npm packages", () => {
  const crates = textsOfCrates(join(root, "python/Cargo.toml"), "--target=all");
  assert.ok(crates.some((text) => /^numpy [\d.]+\n\nBSD 2-Clause/.test(text)), `${crates.length} texts`);
  assert.ok(!crates.some((text) => text.startsWith("sweep-and-prune")));
  const modules = ["node_modules/@lit/reactive-element/index.js", "node_modules/@lit/reactive-element/css-tag.js", "js/src/entries/index.ts"];
  const [text, ...others] = textsOfModules(modules.map((path) => `${root}/${path}`));
  assert.match(text, /reactive-element [\d.]+\n\nBSD 3-Clause/);
  assert.equal(others.length, 0);
});

test("every file has the same bytes on every system", () => {
  const files = execFileSync("git", ["ls-files", "--eol"], { cwd: root, encoding: "utf8" }).trim().split("\n");
  const others = files.filter((line) => !/^i\/(lf|none) .*attr\/text=auto eol=lf|^i\/-text .*attr\/-text|attr\/-text *\tfuzz\/corpus/.test(line));
  assert.deepEqual(others, []);
});
