import { describe } from "./describe.js";

/** @internal An id, which may be stale. Only a number: `valueOf` of an object could free the world. */
export function checkId(id: unknown): number {
  if (typeof id !== "number") throw new TypeError(`\`id\` must be a number, not ${describe(id)}`);
  return id;
}

const names = [
  ["minX", "maxX"],
  ["minX", "minY", "maxX", "maxY"],
  ["minX", "minY", "minZ", "maxX", "maxY", "maxZ"],
];

/** @internal Throws what is wrong with the corners of a box, given as separate numbers. */
export function refuseCorners(dimensions: number, corners: readonly unknown[]): never {
  const expected = names[dimensions - 1]!;
  const form = `a box in ${dimensions}D is ${expected.length} numbers: ${expected.join(", ")}`;
  const wrong = expected.findIndex((_, at) => typeof corners[at] !== "number");
  if (wrong < 0) throw new TypeError(`there are more arguments than ${expected.at(-1)}; ${form}`);
  throw new TypeError(`\`${expected[wrong]}\` must be a number, not ${describe(corners[wrong])}; ${form}`);
}
