import { PairList } from "./pair-list.js";

/** Tests every pair: the reference for all other libraries. */
export async function create({ dimensions }) {
  const pairs = new PairList();
  return {
    find(rows) {
      pairs.clear();
      const width = 2 * dimensions;
      const [x, y, z] = [dimensions, dimensions + 1, dimensions + 2];
      for (let a = 0; a < rows.length; a += width) {
        for (let b = a + width; b < rows.length; b += width) {
          if (rows[a] > rows[b + x] || rows[b] > rows[a + x]) continue;
          if (rows[a + 1] > rows[b + y] || rows[b + 1] > rows[a + y]) continue;
          if (dimensions === 3 && (rows[a + 2] > rows[b + z] || rows[b + 2] > rows[a + z])) continue;
          pairs.push(a / width, b / width);
        }
      }
      return pairs.pairs;
    },
  };
}
