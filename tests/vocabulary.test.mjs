// The words of the glossary's left column are gone, from texts, comments, messages and identifiers.
// tests/vocabulary.mjs has the words, the exceptions with their reasons, and prints the places.
import assert from "node:assert/strict";
import { test } from "node:test";

import { EXCEPTIONS, WORDS, describe, places, placesIn } from "./vocabulary.mjs";

test("no word to avoid is left", () => {
  const found = places().map(describe);
  const shown = found.length > 40 ? [...found.slice(0, 40), "... node tests/vocabulary.mjs --list"] : found;
  assert.ok(found.length === 0, `${found.length} places\n${shown.join("\n")}`);
});

test("the words are found in prose, in identifiers and in the names of files", () => {
  const found = (path, text) => placesIn(path, text).map(({ word }) => word.not);
  assert.deepEqual(found("core/src/world/a.rs", "/// A living world."), ["living world"]);
  assert.deepEqual(found("core/src/world/a.rs", "fn starts_anew() {}"), ["anew"]);
  assert.deepEqual(found("core/src/world/a.rs", "let fat_box = hull(a, b);"), ["fat box", "hull"]);
  assert.deepEqual(found("bench/a.js", "export const CONTENDERS = rivals;"), ["ours, rival, peer, contender"]);
  assert.deepEqual(found("python/extension/door.rs", ""), ["door"]);
  assert.deepEqual(found("core/src/a.rs", "bodies who rest"), ["who, somebody, nobody (for a thing)"]);
  assert.deepEqual(found("site/src/a.ts", "interface LabOptions {}"), ["lab, laboratory"]);
  assert.deepEqual(found("core/src/pairs/a.rs", "/// Cuts a line into so many cells."), ["so many (a number)"]);
  assert.deepEqual(found("site/src/a.ts", "/** So many tests take a second. */"), ["so many (a number)"]);
  assert.deepEqual(found("bench/src/a.rs", "// The boxes are those of a set, or those of a column."), ["those of, twice in a sentence"]);
});

test("plain English and names that only look alike are no finds", () => {
  for (const text of ["the following example", "hours and flours", "split, litter", "seaten, theater", "a convex hull", "so many that it is slow"]) {
    assert.deepEqual(placesIn("README.md", text), [], text);
  }
  assert.deepEqual(placesIn("js/src/a.ts", 'import { html } from "lit";'), []);
});

test("each exception is for a word of the list and has a reason", () => {
  const words = new Set(WORDS.map((word) => word.not));
  for (const { not, why } of EXCEPTIONS) assert.ok(words.has(not) && why.length > 10, `${not}: ${why}`);
});
