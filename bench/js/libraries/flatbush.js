import Flatbush from "flatbush";
import { PairList } from "./pair-list.js";

export async function create() {
  const pairs = new PairList();
  return {
    find(rows) {
      pairs.clear();
      const count = rows.length / 4;
      if (count === 0) return pairs.pairs;
      const index = new Flatbush(count, 16, Float32Array);
      for (let at = 0; at < rows.length; at += 4) index.add(rows[at], rows[at + 1], rows[at + 2], rows[at + 3]);
      index.finish();
      let box = 0;
      const each = (/** @type {number} */ other) => {
        if (other > box) pairs.push(box, other);
        return false; // dealt with: no array of results is needed
      };
      for (let at = 0; box < count; box++, at += 4) {
        index.search(rows[at], rows[at + 1], rows[at + 2], rows[at + 3], each);
      }
      return pairs.pairs;
    },
  };
}
