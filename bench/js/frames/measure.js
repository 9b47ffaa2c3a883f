import assert from "node:assert/strict";
import { median } from "../src/record.js";

/**
 * One way to do a scene. `frame` is the work of a frame, and is timed; `found` says afterwards what it has found, as sorted numbers,
 * which are the same in all forms.
 *
 * @typedef {{ frame: (step: number) => void, found: () => number[] }} Form
 */

/**
 * The median milliseconds of a frame in each form. They take turns, and have to find the same in every frame, which is looked at
 * between them. The first third lets the compiler settle.
 *
 * @param {{ frames: number, forms: Record<string, () => Form> }} scene
 */
export function measure({ frames, forms }) {
  const all = Object.entries(forms).map(([name, create]) => ({ name, ...create(), times: /** @type {number[]} */ ([]) }));
  let total = 0;
  for (let step = 0; step < frames; step++) {
    for (let at = 0; at < all.length; at++) {
      const { frame, times } = all[(at + step) % all.length];
      const begun = performance.now();
      frame(step);
      const ms = performance.now() - begun;
      if (3 * step >= frames) times.push(ms);
    }
    const expected = all[0].found();
    total += expected.length;
    for (const { name, found } of all.slice(1)) assert.deepEqual(found(), expected, `${name}, frame ${step}`);
  }
  return { found: total / frames, forms: all.map(({ name, times }) => ({ name, ms: median(times) })) };
}
