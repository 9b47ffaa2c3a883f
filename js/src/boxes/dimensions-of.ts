import { checkDimensions, type Dimensions, extent, formOf, isRow, rowLength, sized, type SizedBox } from "./boxes.js";

/** @internal How many dimensions boxes have that are objects: those of the first; `undefined` for flat arrays. */
export function dimensionsOf(boxes: unknown): Dimensions | undefined {
  const first: unknown = Array.isArray(boxes) ? boxes[0] : undefined;
  if (isRow(first)) return checkDimensions((rowLength(first) as number) / 2);
  if (typeof first !== "object" || first === null) return undefined;
  const form = formOf(first, "boxes[0]");
  // Not by its `z`: a sprite may have one that is no coordinate.
  const has = (axis: number) => (form === sized ? extent(first as SizedBox, axis) : form.read(first, 0, axis)) !== undefined;
  return has(2) ? 3 : has(1) ? 2 : has(0) ? 1 : undefined;
}
