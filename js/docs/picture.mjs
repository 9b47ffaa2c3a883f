// Draws js/docs/picture.svg: boxes, and the pairs that findPairs finds among them. To the standard output.
import { findPairs, init } from "sweep-and-prune";

await init();

const [width, height, count] = [960, 320, 90];
let seed = 12;
/** Mulberry32: the same numbers in [0, 1) on every run. */
function random() {
  seed = (seed + 0x6d2b79f5) | 0;
  let mixed = Math.imul(seed ^ (seed >>> 15), seed | 1);
  mixed ^= mixed + Math.imul(mixed ^ (mixed >>> 7), mixed | 61);
  return ((mixed ^ (mixed >>> 14)) >>> 0) / 2 ** 32;
}

const boxes = new Float32Array(4 * count);
for (let i = 0; i < count; i++) {
  const [w, h] = [16 + 50 * random() ** 2, 16 + 50 * random() ** 2];
  const [x, y] = [10 + random() * (width - 20 - w), 10 + random() * (height - 20 - h)];
  boxes.set([x, y, x + w, y + h].map(Math.round), 4 * i);
}
const pairs = findPairs(boxes, { dimensions: 2 });
const paired = new Set(pairs);

const lines = [];
for (let i = 0; i < count; i++) {
  const [left, top, right, bottom] = boxes.subarray(4 * i);
  const kind = paired.has(i) ? "in" : "out";
  lines.push(`<rect class="${kind}" x="${left}" y="${top}" width="${right - left}" height="${bottom - top}" rx="2"/>`);
}
for (let i = 0; i < pairs.length; i += 2) {
  const [a, b] = [boxes.subarray(4 * pairs[i]), boxes.subarray(4 * pairs[i + 1])];
  const [left, top] = [Math.max(a[0], b[0]), Math.max(a[1], b[1])];
  const [right, bottom] = [Math.min(a[2], b[2]), Math.min(a[3], b[3])];
  lines.push(`<rect class="both" x="${left}" y="${top}" width="${right - left}" height="${bottom - top}"/>`);
}
console.log(`<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" role="img" aria-labelledby="t">
<title id="t">${count} boxes. ${pairs.length / 2} pairs of them overlap: where they do is filled.</title>
<style>
  .page { fill: #fff } .in { fill: #2563eb22; stroke: #2563eb; stroke-width: 1.5 }
  .out { fill: none; stroke: #9ca3af; stroke-width: 1.5 } .both { fill: #dc2626; stroke: #dc2626 }
  @media (prefers-color-scheme: dark) {
    .page { fill: #0d1117 } .in { fill: #60a5fa22; stroke: #60a5fa } .out { stroke: #6b7280 }
    .both { fill: #f87171; stroke: #f87171 }
  }
</style>
<rect class="page" width="${width}" height="${height}" rx="8"/>
${lines.join("\n")}
</svg>`);
