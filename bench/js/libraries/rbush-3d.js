import { RBush3D } from "rbush-3d";
import { PairList } from "./pair-list.js";

export async function create() {
  const pairs = new PairList();
  const tree = new RBush3D();
  /** @type {{ minX: number, minY: number, minZ: number, maxX: number, maxY: number, maxZ: number, index: number }[]} */
  let items = [];
  return {
    find(rows) {
      const count = rows.length / 6;
      if (items.length !== count) {
        items = Array.from({ length: count }, (_, index) => ({
          minX: 0.5,
          minY: 0.5,
          minZ: 0.5,
          maxX: 0.5,
          maxY: 0.5,
          maxZ: 0.5,
          index,
        }));
      }
      for (let i = 0, at = 0; i < count; i++) {
        const item = items[i];
        item.minX = rows[at++];
        item.minY = rows[at++];
        item.minZ = rows[at++];
        item.maxX = rows[at++];
        item.maxY = rows[at++];
        item.maxZ = rows[at++];
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
