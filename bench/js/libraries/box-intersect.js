import boxIntersect from "box-intersect";
import { PairList } from "./pair-list.js";

export async function create({ dimensions }) {
  const pairs = new PairList();
  const visit = (a, b) => pairs.push(a, b);
  /** @type {number[][]} */
  let boxes = [];
  return {
    find(rows) {
      const width = 2 * dimensions;
      const count = rows.length / width;
      if (boxes.length !== count) boxes = Array.from({ length: count }, () => new Array(width).fill(0.5));
      for (let i = 0, at = 0; i < count; i++) {
        const box = boxes[i];
        for (let k = 0; k < width; k++) box[k] = rows[at++];
      }
      pairs.clear();
      boxIntersect(boxes, visit);
      return pairs.pairs;
    },
  };
}
