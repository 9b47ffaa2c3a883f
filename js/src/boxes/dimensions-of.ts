import { describe } from "../wasm/describe.js";
import { axesOf, type Dimensions, isRow } from "./boxes.js";

/**
 * @internal How many dimensions boxes have that are objects: each has as many. Empty sets have any number.
 *
 * @throws `RangeError` for flat arrays, which do not tell; `TypeError` if two boxes differ.
 */
export function dimensionsOf(sets: readonly (readonly [name: string, boxes: unknown])[]): Dimensions {
  let first: { name: string; axes: Dimensions } | undefined;
  for (const [set, boxes] of sets) {
    if (!Array.isArray(boxes)) refuseFlat(boxes, set);
    for (const [at, box] of boxes.entries()) {
      if (typeof box === "number") refuseFlat(boxes, set);
      const name = `${set}[${at}]`;
      const axes = axesOf(box, name);
      first ??= { name, axes };
      if (axes !== first.axes) throw new TypeError(`${name} is in ${axes}D and ${first.name} in ${first.axes}D; all boxes of a search have the same dimensions`);
    }
  }
  return first?.axes ?? 1;
}

function refuseFlat(boxes: unknown, name: string): never {
  if (Array.isArray(boxes) || isRow(boxes)) {
    throw new RangeError(`\`options\` is missing: \`${name}\` is a flat array of numbers, which needs \`{ dimensions: 1 }\`, 2 or 3`);
  }
  throw new TypeError(`\`${name}\` must be an array of boxes, not ${describe(boxes)}`);
}
