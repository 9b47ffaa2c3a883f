/**
 * Finds every overlapping pair of axis-aligned boxes in 1D, 2D and 3D, fast.
 *
 * ```js
 * import { init, findPairs } from "sweep-and-prune";
 *
 * await init();
 * const boxes = new Float32Array([0, 0, 2, 2,  5, 5, 6, 6,  2, 1, 3, 4]);
 * findPairs(boxes, { dimensions: 2 }); // Uint32Array [0, 2]
 * ```
 *
 * In pages this entry point loads the compiled core from a file beside it. In Node, Deno and Bun it
 * resolves to `sweep-and-prune/inline`, which has the core inside.
 *
 * @module
 */
import { entry, type InitOptions, type Started } from "../wasm/init.js";
import { finderCore } from "../pairs/pair-finder.js";

export * from "./common.js";
export { inPairs } from "../pairs/in-pairs.js";
export {
  anyPair,
  countPairs,
  type EachPair,
  findPairs,
  findPairsBetween,
  type FindPairsOptions,
  forEachPair,
  PairFinder,
  type PairFinderOptions,
  type PairsInto,
} from "../pairs/pair-finder.js";

/**
 * Loads and starts the compiled core, and those of the other entry points that the program has
 * imported. Call it once, before anything else. Later and concurrent calls get the promise of the first
 * call, and their options are ignored. After a failure the next call tries again.
 *
 * @throws The error of the network, the file system or the compiler.
 */
export const init: (options?: InitOptions) => Promise<Started> = entry(finderCore, {
  simd: () => new URL("./sweep-and-prune.simd.wasm", import.meta.url),
  scalar: () => new URL("./sweep-and-prune.wasm", import.meta.url),
});
