import { overlaps } from "../listings/overlaps.js";

export function findPairs(boxes, onPair) {
  const center = (box) => (box.left + box.right) / 2;
  boxes = boxes.toSorted((a, b) => center(a) - center(b));
  for (let i = 0; i < boxes.length; i++) {
    const a = boxes[i];
    for (let j = i + 1; j < boxes.length; j++) {
      const b = boxes[j];
      if (b.left > a.right) break;
      if (overlaps(a, b)) onPair(a, b);
    }
  }
}
