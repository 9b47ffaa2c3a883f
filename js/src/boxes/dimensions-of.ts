import { describe } from "../wasm/describe.js";
import { axesOf, type Dimensions, isRow } from "./boxes.js";

/**
 * @internal How many dimensions boxes have that are objects: as many as the first one. Empty sets have any number.
 *
 * @throws `RangeError` for flat arrays, which do not tell; `TypeError` if it has half of an axis.
 */
export function dimensionsOf(sets: readonly (readonly [name: string, boxes: unknown])[]): Dimensions {
  for (const [name, boxes] of sets) if (!Array.isArray(boxes) || typeof boxes[0] === "number") refuseFlat(boxes, name);
  const first = sets.find(([, boxes]) => (boxes as unknown[]).length > 0);
  return first ? axesOf((first[1] as unknown[])[0], first[0], 0) : 1;
}

function refuseFlat(boxes: unknown, name: string): never {
  if (Array.isArray(boxes) || isRow(boxes)) {
    throw new RangeError(`\`options\` is missing: \`${name}\` is a flat array of numbers, which needs \`{ dimensions: 1 }\`, 2 or 3`);
  }
  throw new TypeError(`\`${name}\` must be an array of boxes, not ${describe(boxes)}`);
}
