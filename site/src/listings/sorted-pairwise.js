import { overlaps } from "./overlaps.js";

export function sortedPairwise(boxes, onPair) {
  // A copy: the caller's array stays as it is.
  const sorted = [...boxes];
  sorted.sort((a, b) => a.left - b.left); // @compare @swap

  for (let i = 0; i < sorted.length; i++) {
    const a = sorted[i]; // @enter
    for (let j = i + 1; j < sorted.length; j++) {
      const b = sorted[j];
      if (b.left > a.right) break; // as all after b @skip
      if (overlaps(a, b)) onPair(a, b); // @test @overlap
    }
  }
}
