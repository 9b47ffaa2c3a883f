import { overlaps } from "./overlaps.js";

export function globalPairwise(boxes, onPair) {
  for (let i = 0; i < boxes.length; i++) {
    const a = boxes[i];
    for (let j = i + 1; j < boxes.length; j++) {
      const b = boxes[j];
      if (overlaps(a, b)) onPair(a, b); // @test @overlap
    }
  }
}
