// The words of the glossary's left column are gone, from texts, comments, messages and identifiers.
// tests/vocabulary.mjs has the words, the exceptions with their reasons, and prints the places.
import assert from "node:assert/strict";
import { test } from "node:test";

import { EXCEPTIONS, WORDS, counts, describe, folderOf, places, placesIn } from "./vocabulary.mjs";

/** How many places each folder still has. A number may only shrink; a folder that is not listed has none. */
const LEFT = {
  "core": 12,
  "core/src": 5,
  "core/src/pairs": 5,
  "core/src/world": 5
};

test("no folder uses more of the words to avoid than before", () => {
  const found = places();
  const grown = Object.entries(counts(found)).filter(([folder, count]) => count > (LEFT[folder] ?? 0));
  const report = grown.map(([folder, count]) => {
    const all = found.filter(({ path }) => folderOf(path) === folder).map((place) => `  ${describe(place)}`);
    const shown = all.length > 40 ? [...all.slice(0, 40), `  ... node tests/vocabulary.mjs --list ${folder}`] : all;
    return `${folder}: ${count} places, at most ${LEFT[folder] ?? 0} are allowed\n${shown.join("\n")}`;
  });
  assert.ok(grown.length === 0, report.join("\n"));
});

test("the words are found in prose, in identifiers and in the names of files", () => {
  const found = (path, text) => placesIn(path, text).map(({ word }) => word.not);
  assert.deepEqual(found("core/src/world/a.rs", "/// A living world."), ["living world"]);
  assert.deepEqual(found("core/src/world/a.rs", "fn starts_anew() {}"), ["anew"]);
  assert.deepEqual(found("core/src/world/a.rs", "let fat_box = hull(a, b);"), ["fat box", "hull"]);
  assert.deepEqual(found("bench/a.js", "export const CONTENDERS = rivals;"), ["ours, rival, peer, contender"]);
  assert.deepEqual(found("python/src/door.rs", ""), ["door"]);
  assert.deepEqual(found("core/src/a.rs", "bodies who rest"), ["who, somebody, nobody (for a thing)"]);
  assert.deepEqual(found("site/src/a.ts", "interface LabOptions {}"), ["lab, laboratory"]);
});

test("plain English and names that only look alike are no finds", () => {
  for (const text of ["the following example", "hours and flours", "split, litter", "seaten, theater", "a convex hull"]) {
    assert.deepEqual(placesIn("README.md", text), [], text);
  }
  assert.deepEqual(placesIn("js/src/a.ts", 'import { html } from "lit";'), []);
});

test("each exception is for a word of the list and has a reason", () => {
  const words = new Set(WORDS.map((word) => word.not));
  for (const { not, why } of EXCEPTIONS) assert.ok(words.has(not) && why.length > 10, `${not}: ${why}`);
});
