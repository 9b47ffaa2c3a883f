// What a form has found, as numbers that can be compared.
import { slotOf } from "sweep-and-prune/broad-phase";

/** Flat pairs as sorted numbers. @type {(pairs: ArrayLike<number>) => number[]} */
export function keysOf(pairs) {
  const keys = [];
  for (let at = 0; at < pairs.length; at += 2) keys.push(pairs[at] * 2 ** 20 + pairs[at + 1]);
  return keys.sort((a, b) => a - b);
}

/**
 * The keys of the pairs of a world, whose slots are the positions of its bodies. The second of each pair is counted from `from`.
 *
 * @type {(world: import("sweep-and-prune/broad-phase").BroadPhase, from?: number) => number[]}
 */
export const keysOfWorld = (world, from = 0) => keysOf(Array.from(world.pairs(), (id, at) => slotOf(id) - (at % 2) * from));
