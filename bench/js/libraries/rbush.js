import RBush from "rbush";
import { PairList } from "./pair-list.js";

export async function create() {
  const pairs = new PairList();
  const tree = new RBush();
  /** @type {{ minX: number, minY: number, maxX: number, maxY: number, index: number }[]} */
  let items = [];
  return {
    find(rows) {
      const count = rows.length / 4;
      if (items.length !== count) {
        items = Array.from({ length: count }, (_, index) => ({ minX: 0.5, minY: 0.5, maxX: 0.5, maxY: 0.5, index }));
      }
      for (let i = 0, at = 0; i < count; i++) {
        const item = items[i];
        item.minX = rows[at++];
        item.minY = rows[at++];
        item.maxX = rows[at++];
        item.maxY = rows[at++];
      }
      tree.clear();
      tree.load(items);
      pairs.clear();
      for (const item of items) {
        for (const other of tree.search(item)) if (other.index > item.index) pairs.push(item.index, other.index);
      }
      return pairs.pairs;
    },
  };
}
