import { overlaps } from "./overlaps.js";

export function pairwise(boxes, onPair) {
  for (let i = 0; i < boxes.length; i++) {
    for (let j = i + 1; j < boxes.length; j++) {
      if (overlaps(boxes[i], boxes[j])) { // @test
        onPair(boxes[i], boxes[j]); // @overlap
      }
    }
  }
}
