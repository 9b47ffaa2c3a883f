// Whole frames: with this package, rbush, flatbush and by hand each frame has the same pairs or shapes.
import assert from "node:assert/strict";
import { test } from "node:test";
import { init } from "sweep-and-prune";
import { init as initBroadPhase } from "sweep-and-prune/broad-phase";
import { measure } from "../frames/measure.js";
import { scenes } from "../frames/scenes.js";

await Promise.all([init(), initBroadPhase()]);

for (const [name, { forms }] of Object.entries(scenes)) {
  test(`${name}: all forms find the same in three frames`, () => {
    const { found, forms: measured } = measure({ frames: 3, forms });
    assert.ok(found > 20, `${found} found in a frame`);
    assert.equal(measured.length, Object.keys(forms).length);
  });
}

test("a form that finds something else is named", () => {
  const form = (/** @type {number} */ last) => () => ({ frame: () => {}, found: () => [1, last] });
  assert.throws(() => measure({ frames: 1, forms: { own: form(2), other: form(3) } }), /other, frame 0/);
});
