// Rows of boxes in the plane, and what rbush and flatbush make of them.
import Flatbush from "flatbush";

/** @typedef {{ minX: number, minY: number, maxX: number, maxY: number, at: number }} Item */

/** Whether two boxes of rows overlap. @type {(a: ArrayLike<number>, i: number, b: ArrayLike<number>, j: number) => boolean} */
export const overlap = (a, i, b, j) =>
  a[4 * i] <= b[4 * j + 2] && b[4 * j] <= a[4 * i + 2] && a[4 * i + 1] <= b[4 * j + 3] && b[4 * j + 1] <= a[4 * i + 3];

/** What rbush holds. @type {(count: number) => Item[]} */
export const createItems = (count) => Array.from({ length: count }, (_, at) => ({ minX: 0.5, minY: 0.5, maxX: 0.5, maxY: 0.5, at }));

/** @type {(item: Item, boxes: ArrayLike<number>, row: number) => void} */
export function copyBox(item, boxes, row) {
  [item.minX, item.minY, item.maxX, item.maxY] = [boxes[4 * row], boxes[4 * row + 1], boxes[4 * row + 2], boxes[4 * row + 3]];
}

/** @type {(tree: import("rbush").default<Item>, items: Item[], boxes: ArrayLike<number>, from?: number) => void} */
export function load(tree, items, boxes, from = 0) {
  items.forEach((item, at) => copyBox(item, boxes, from + at));
  tree.clear();
  tree.load(items);
}

/** A new index of rows. @type {(boxes: Float32Array | Float64Array, from?: number) => Flatbush} */
export function indexOf(boxes, from = 0) {
  const index = new Flatbush(boxes.length / 4 - from, 16, boxes.constructor);
  for (let at = 4 * from; at < boxes.length; at += 4) index.add(boxes[at], boxes[at + 1], boxes[at + 2], boxes[at + 3]);
  index.finish();
  return index;
}
