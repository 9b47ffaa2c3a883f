import { overlaps } from "./overlaps.js";

export function sortedPairwise(boxes, onPair) {
  boxes = boxes.toSorted((a, b) => a.left - b.left); // @added @compare @swap
  for (let i = 0; i < boxes.length; i++) {
    const a = boxes[i]; // @enter
    for (let j = i + 1; j < boxes.length; j++) {
      const b = boxes[j];
      if (b.left > a.right) break; // @added @skip
      if (overlaps(a, b)) onPair(a, b); // @test @overlap
    }
  }
}
