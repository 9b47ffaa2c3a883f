import { PairList } from "./pair-list.js";
import { axisOfMostVariance } from "./rows.js";

// What a good developer writes in an hour: sort the boxes along the axis on which they vary most,
// sweep along it, test the other axes. Typed arrays throughout, nothing allocated between calls.

const LIMIT = 2 ** 128;

export async function create({ dimensions }) {
  const pairs = new PairList();
  let order = new Uint32Array(0);
  let keys = new Float64Array(0);
  let sorted = new Float32Array(0);

  /** Sorts the boxes by their left edge on an axis. */
  function sort(rows, axis) {
    const width = 2 * dimensions;
    const count = rows.length / width;
    if (order.length !== count) {
      order = new Uint32Array(count);
      keys = new Float64Array(count);
      sorted = new Float32Array(rows.length);
    }
    // Half of a double's digits are more than a float has: the box's index goes there, and sorting
    // needs no function to compare. Infinity has no digits; 2^128 is above all floats.
    const words = new Uint32Array(keys.buffer);
    for (let i = 0; i < count; i++) {
      keys[i] = Math.max(-LIMIT, Math.min(rows[i * width + axis] + 0, LIMIT)); // -0 becomes 0
      words[2 * i] |= i;
    }
    keys.sort();
    for (let i = 0; i < count; i++) {
      order[i] = words[2 * i] & 0x1fffffff;
      const from = order[i] * width;
      for (let k = 0; k < width; k++) sorted[i * width + k] = rows[from + k];
    }
  }

  function find(rows) {
    const axis = axisOfMostVariance(rows, dimensions);
    sort(rows, axis);
    pairs.clear();
    const width = 2 * dimensions;
    const other = axis === 0 ? 1 : 0;
    const third = dimensions === 3 ? 3 - axis - other : other;
    for (let a = 0; a < sorted.length; a += width) {
      const end = sorted[a + dimensions + axis];
      const [min, max] = [sorted[a + other], sorted[a + dimensions + other]];
      const [min3, max3] = [sorted[a + third], sorted[a + dimensions + third]];
      for (let b = a + width; b < sorted.length && sorted[b + axis] <= end; b += width) {
        if (sorted[b + other] > max || sorted[b + dimensions + other] < min) continue;
        if (sorted[b + third] > max3 || sorted[b + dimensions + third] < min3) continue;
        pairs.push(order[a / width], order[b / width]);
      }
    }
    return pairs.pairs;
  }

  return { find };
}
