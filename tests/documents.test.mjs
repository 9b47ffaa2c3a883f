// The documents tell the truth: every path that they name exists, every command that they give
// is one we have, and the README's JavaScript example does what it says. (Its Rust example is a
// doc test of the core crate.)
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

const root = dirname(dirname(fileURLToPath(import.meta.url)));
const read = (path) => readFileSync(join(root, path), "utf8");
const withoutBlocks = (text) => text.replace(/^```.*?^```/gms, "");
const tracked = new Set(execFileSync("git", ["ls-files"], { cwd: root, encoding: "utf8" }).split("\n"));
const isTracked = (path) =>
  tracked.has(path) || [...tracked].some((file) => file.startsWith(path.replace(/\/?$/, "/")));

/** Entries of the npm package, such as `sweep-and-prune/inline`, look like paths and are to exist as such. */
const { name, exports } = JSON.parse(read("js/package.json"));
const entries = new Set(Object.keys(exports).map((entry) => entry.replace(/^\./, name)));

/** What stands in backticks and looks like a path of this repository: it has a slash or an ending. */
function pathsNamed(text) {
  const spans = [...withoutBlocks(text).matchAll(/`([^`\n]+)`/g)].map((match) => match[1]);
  return spans.filter(
    (span) => /^[\w.][\w./-]*$/.test(span) && (span.includes("/") || /\.(rs|toml|md|json|mjs|ts|sh)$/.test(span)),
  );
}

for (const document of ["ARCHITECTURE.md", "js/ARCHITECTURE.md", "python/ARCHITECTURE.md", "classroom/ARCHITECTURE.md", "README.md", "CONTRIBUTING.md", "docs/testing.md", "docs/releasing.md"]) {
  test(`every path that ${document} names exists`, () => {
    const paths = pathsNamed(read(document));
    assert.ok(paths.length > 0, "no path found: is the pattern still right?");
    const missing = paths.filter((path) => !entries.has(path) && !isTracked(path.replace(/^\.\//, "")));
    assert.deepEqual(missing, []);
  });
}

/** The anchors of a document's headings, as they are made where it is shown. */
const anchors = (text) =>
  [...text.matchAll(/^#+ (.*)$/gm)].map(([, heading]) =>
    heading.replace(/\[([^\]]*)\]\([^)]*\)/g, "$1").toLowerCase().replace(/[^\p{L}\p{N}\s_-]/gu, "").replaceAll(" ", "-"),
  );

/** The links of a document to files of the repository that lead nowhere. */
function brokenLinks(document) {
  const text = withoutBlocks(read(document));
  const links = [...text.matchAll(/(?:\]\(|(?:src|srcset|href)=")([^)"\s]+)/g)].map((match) => match[1]);
  return links
    .filter((link) => !/^[a-z]+:|^\/\//.test(link))
    .filter((link) => {
      const [path, anchor] = link.split("#");
      const target = path ? join(dirname(document), path) : document;
      if (!existsSync(join(root, target))) return true;
      return Boolean(anchor) && target.endsWith(".md") && !anchors(read(target)).includes(anchor);
    });
}

for (const document of [...tracked].filter((path) => path.endsWith(".md") && existsSync(join(root, path)))) {
  test(`every link of ${document} to a file of the repository leads there`, () => {
    assert.deepEqual(brokenLinks(document), []);
  });
}

test("every folder at the top has its line in ARCHITECTURE.md", () => {
  const folders = new Set([...tracked].filter((file) => file.includes("/")).map((file) => file.split("/")[0]));
  const text = read("ARCHITECTURE.md");
  const unnamed = [...folders].filter((folder) => !text.includes(`\`${folder}/`));
  assert.deepEqual(unnamed, []);
});

// Cargo would not run them, and would not say so.
test("a library or program with `test = false` in its Cargo.toml has no unit tests", () => {
  for (const manifest of [...tracked].filter((path) => path.endsWith("Cargo.toml") && existsSync(join(root, path)))) {
    const sections = read(manifest).split(/^(?=\[)/m);
    for (const section of sections.filter((text) => /^\[+(lib|bin)\]+\n/.test(text) && /^test = false$/m.test(text))) {
      const value = (key) => section.match(new RegExp(`^${key} = "(.*)"$`, "m"))?.[1];
      const isLibrary = section.startsWith("[lib]");
      const path = join(dirname(manifest), value("path") ?? (isLibrary ? "src/lib.rs" : `src/bin/${value("name")}.rs`));
      // A program of several files is not among them.
      const files = isLibrary ? [...tracked].filter((file) => file.startsWith(`${dirname(path)}/`)) : [path];
      assert.ok(files.includes(path), `${manifest}: ${path}`);
      const tested = files.filter((file) => file.endsWith(".rs") && /#\[(cfg\()?test\b|\bproptest!/.test(read(file)));
      assert.deepEqual(tested, [], `${manifest} has \`test = false\``);
    }
  }
});

test("the README's JavaScript example prints what it says", async () => {
  const example = /```js\n(.*?)```/s.exec(read("README.md"))?.[1];
  assert.ok(example, "the README has no JavaScript example");
  const expected = [...example.matchAll(/console\.log\(.*?\);\s*\/\/ (.*)/g)].map((match) => match[1]);
  assert.ok(expected.length > 0, "the example prints nothing that could be checked");
  const printed = execFileSync(process.execPath, ["--input-type=module", "--eval", example], {
    cwd: join(root, "js"),
    encoding: "utf8",
  });
  assert.deepEqual(printed.trim().split("\n"), expected);
});
