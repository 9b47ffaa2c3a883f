// The table of demos, algorithms and corrections names tests that exist, and leaves none out.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

const root = new URL("../../", import.meta.url);
const table = readFileSync(new URL("site/test/inventory.md", root), "utf8");

test("every demo, algorithm and correction has a row", () => {
  const numbers = [...table.matchAll(/^\| ([DA]?\d+) \|/gm)].map(([, number]) => number);
  const all = (prefix, count) => Array.from({ length: count }, (_, at) => `${prefix}${at + 1}`);
  assert.deepEqual(numbers, [...all("D", 20), ...all("A", 12), ...all("", 18)]);
});

test("every test that it names exists", () => {
  const named = [...table.matchAll(/`([\w./-]+)`: ([^|;\n]+)/g)].map(([, file, name]) => ({ file, name: name.trim() }));
  assert.ok(named.length > 60);
  for (const { file, name } of named) {
    const source = readFileSync(new URL(file, root), "utf8");
    // A name of a Rust function, or a part of the text of a test.
    const isThere = file.endsWith(".rs") ? new RegExp(`\\bfn ${name}\\b`).test(source) : source.split("\n").some((line) => /\b(test|describe)\(/.test(line) && line.includes(name));
    assert.ok(isThere, `${file} has no test "${name}"`);
  }
});
