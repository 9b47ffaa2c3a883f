// No file imports a file that imports it, directly or indirectly, in the folders that tests/imports.mjs lists.
//
// What counts as an import of file B by file A:
//
// Rust
// - A path in A, in a `use` or in the code (`super::tree::build()`), that leads to an item which B defines.
//   Re-exports are followed: `use crate::Aabb` imports geometry/aabb.rs, not lib.rs.
// - A call in A of `self.method()` or `Self::method()` that an `impl` of the same type in B defines. So a type
//   whose methods are spread over files does not hide that these files need each other.
// - `mod b;` is not an import, and `pub use b::Item` is not, unless A also uses `Item` itself. So a mod.rs may
//   declare its children and re-export what they define. But if it uses a child, and that child uses an item
//   that mod.rs defines, then this is a cycle: the item belongs in a file of its own.
// - What only tests need (`#[cfg(test)]`) does not count.
//
// TypeScript
// - Each `import` and `export ... from` of a file of the folder counts: imports of types as well.
//
// What is not seen: method calls on other values than `self`, and names that only a macro puts together.
//
// `node tests/imports.mjs` prints the cycles; with `--all`, also what each file imports.
import assert from "node:assert/strict";
import { mkdtempSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join, relative } from "node:path";
import { test } from "node:test";

import { FOLDERS, importsOf, report, root } from "./imports.mjs";
import { cyclicGroups } from "./support/cycles.mjs";
import { crateRoot, rustImports } from "./support/rust-imports.mjs";
import { typescriptImports } from "./support/typescript-imports.mjs";

/** Files that are still in cycles, by folder. A number may only shrink; the aim is an empty list. */
const KNOWN = {
};

const folderOf = (file) => Object.keys(KNOWN).sort((a, b) => b.length - a.length).find((it) => file.startsWith(`${it}/`));

for (const [folder, fewest] of Object.entries(FOLDERS)) {
  test(`no file of ${folder} imports a file that imports it`, () => {
    const graph = importsOf(folder);
    assert.ok(graph.size >= fewest, `only ${graph.size} files were found in ${folder}`);
    const groups = cyclicGroups(graph);
    const counts = {};
    for (const file of groups.flat()) {
      const owner = folderOf(relative(root, file)) ?? folder;
      counts[owner] = (counts[owner] ?? 0) + 1;
    }
    const grown = Object.entries(counts).filter(([owner, count]) => count > (KNOWN[owner] ?? 0));
    assert.ok(
      grown.length === 0,
      [
        ...grown.map(([owner, count]) => `${count} files of ${owner} are in cycles; ${KNOWN[owner] ?? 0} may be:`),
        ...groups.map((group) => report(graph, group)),
      ].join("\n"),
    );
  });
}

/** Imports of a file in the folder of one page by a file in the folder of another: `[from, to]`. */
function importsAcrossPages(graph, source, pages) {
  const pageOf = (file) => pages.find((page) => relative(source, file).startsWith(`${page}/`));
  return [...graph].flatMap(([file, imports]) =>
    [...imports.keys()].filter((to) => pageOf(file) && pageOf(to) && pageOf(to) !== pageOf(file)).map((to) => [relative(source, file), relative(source, to)]),
  );
}

test("the folder of a page of the site imports no folder of another page", () => {
  const site = join(root, "site");
  // A page's folder is the one that has the script its HTML loads. The scripts of index.html stand in article/.
  const pages = new Set(["article"]);
  for (const file of readdirSync(site).filter((file) => file.endsWith(".html"))) {
    for (const [, folder] of readFileSync(join(site, file), "utf8").matchAll(/src="\.\/src\/([^/"]+)\/[^"]*\.ts"/g)) pages.add(folder);
  }
  assert.ok(pages.size > 5 && pages.has("play") && pages.has("tasks"), [...pages].join(", "));
  assert.deepEqual(importsAcrossPages(importsOf("site/src"), join(site, "src"), [...pages]), []);
  const made = new Map([["/s/a/x.ts", new Map([["/s/b/y.ts", new Set()], ["/s/shared/z.ts", new Set()], ["/s/a/w.ts", new Set()]])]]);
  assert.deepEqual(importsAcrossPages(made, "/s", ["a", "b"]), [["a/x.ts", "b/y.ts"]]);
});

/** Which folder imports which; a file beside the folders stands for itself. */
function foldersOf(graph, source) {
  const folder = (file) => relative(source, file).split("/")[0];
  const folders = new Map([...graph.keys()].map((file) => [folder(file), new Map()]));
  for (const [file, imports] of graph) {
    for (const to of imports.keys()) if (folder(to) !== folder(file)) folders.get(folder(file)).set(folder(to), new Set());
  }
  return folders;
}

test("no folder of the site imports a folder that imports it, directly or indirectly", () => {
  const folders = foldersOf(importsOf("site/src"), join(root, "site/src"));
  assert.ok(folders.size > 15 && folders.get("playground").has("experiment"), [...folders.keys()].join(", "));
  assert.deepEqual(cyclicGroups(folders), []);
  const made = new Map([["/s/a/x.ts", new Map([["/s/b/y.ts", new Set()]])], ["/s/b/y.ts", new Map()], ["/s/b/z.ts", new Map([["/s/a/w.ts", new Set()]])], ["/s/a/w.ts", new Map()]]);
  assert.deepEqual([cyclicGroups(made), cyclicGroups(foldersOf(made, "/s"))], [[], [["a", "b"]]]);
});

/** The groups of cyclic files of a small made-up crate or package. */
function groupsOf(files, read) {
  const folder = mkdtempSync(join(tmpdir(), "imports-"));
  try {
    for (const [path, text] of Object.entries(files)) {
      mkdirSync(dirname(join(folder, path)), { recursive: true });
      writeFileSync(join(folder, path), text);
    }
    return cyclicGroups(read(folder)).map((group) => group.map((file) => relative(folder, file)));
  } finally {
    rmSync(folder, { recursive: true });
  }
}
const rust = (files) => groupsOf(files, (folder) => rustImports(crateRoot(folder)));

test("a mod.rs that declares and re-exports its children is in no cycle with them", () => {
  assert.deepEqual(
    rust({
      "lib.rs": "mod a; pub use a::{One, Two};",
      "a/mod.rs": "mod one; mod two; pub use one::One; pub use two::Two;",
      "a/one.rs": "use crate::Two; pub struct One(Two);",
      "a/two.rs": "pub struct Two; #[cfg(test)] mod tests { use super::super::One; }",
    }),
    [],
  );
});

test("a mod.rs that uses a child is in a cycle with it if the child uses what mod.rs defines", () => {
  const child = "use super::{LIMIT, other::Three}; pub fn one() -> u32 { LIMIT }";
  const files = (mod) => ({ "lib.rs": "mod a;", "a/mod.rs": mod, "a/one.rs": child, "a/other.rs": "pub struct Three;" });
  const found = [["a/mod.rs", "a/one.rs"]];
  assert.deepEqual(rust(files("mod one; mod other; const LIMIT: u32 = 1; fn f() { one::one(); }")), found);
  assert.deepEqual(rust(files("mod one; mod other; use one::one as o; const LIMIT: u32 = 1;")), found);
  assert.deepEqual(rust(files("mod one; mod other; pub use one::one; const LIMIT: u32 = 1; fn f() { one(); }")), found);
  assert.deepEqual(rust(files("mod one; mod other; pub use one::one; const LIMIT: u32 = 1;")), []);
});

test("paths through re-exports, renames, globs and inline modules lead to the file that defines the item", () => {
  assert.deepEqual(
    rust({
      "lib.rs": "mod a; mod b; pub(crate) use b::Second as Renamed;",
      "a.rs": 'use crate::Renamed; // use crate::c;\n pub const TEXT: &str = "crate::b::x"; pub struct First(Renamed);',
      "b.rs": "mod inner { use super::super::a::*; fn f(_: First) {} } pub struct Second;",
    }),
    [["a.rs", "b.rs"]],
  );
});

test("a file that an attribute names can be the file of several modules", () => {
  const files = (of) => ({
    "lib.rs": "mod one; mod other;",
    "one.rs": '#[path = "of/a.rs"]\nmod a;\n#[path = "of/b.rs"]\npub mod b;',
    "other.rs": '#[path = "of/a.rs"]\nmod a;\n#[path = "of/b.rs"]\npub mod b;',
    "of/a.rs": "use super::b::B; pub struct A(B);",
    "of/b.rs": of,
  });
  assert.deepEqual(rust(files("use super::a::A; pub struct B(A);")), [["of/a.rs", "of/b.rs"]]);
  assert.deepEqual(rust(files("pub struct B;")), []);
});

test("methods of one type in two files that call each other are a cycle", () => {
  assert.deepEqual(
    rust({
      "lib.rs": "mod one; mod two; pub struct World<T>(T);",
      "one.rs": "use crate::World; impl<T: Fn() -> T> World<T> { fn one(&self) { self.two(); } }",
      "two.rs": "use crate::World; impl<T> World<T> { fn two(&self) { Self::one(self); } }",
    }),
    [["one.rs", "two.rs"]],
  );
});

test("imports of types, re-exports and imports without names count in TypeScript", () => {
  const text = {
    "a.ts": 'import type { B } from "./b.js";',
    "b.ts": 'export {\n  c,\n} from "./c";',
    "c.ts": 'import "./folder/d.js";',
    "folder/d.ts": '// import "./e.js";\nimport { a, type A } from "../a.js";',
    "folder/e.ts": 'import { a } from "./d.js";',
  };
  assert.deepEqual(groupsOf(text, typescriptImports), [["a.ts", "b.ts", "c.ts", "folder/d.ts"]]);
});
