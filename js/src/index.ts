/**
 * Which boxes overlap? All pairs of a set of axis-aligned boxes, in one, two or three dimensions.
 *
 * ```js
 * import { init, findPairs } from "sweep-and-prune";
 *
 * await init();
 * const boxes = new Float32Array([0, 0, 2, 2,  5, 5, 6, 6,  2, 1, 3, 4]);
 * findPairs(boxes, { dimensions: 2 }); // Uint32Array [0, 2]
 * ```
 *
 * In pages this entry loads the compiled core from a file beside it; `sweep-and-prune/inline`
 * carries it inside, and is what this entry stands for in Node, Deno and Bun.
 *
 * @module
 */
import { type InitOptions, start, type Started } from "./init.js";
import { finderCore } from "./pair-finder.js";

export * from "./api.js";

/**
 * Loads and starts the compiled core: once, before the first call of anything else. Later and
 * concurrent calls get the promise of the first, whose options are the ones that count; after a
 * failure the next call tries again.
 *
 * @throws What loading throws: the network's, the file system's or the compiler's error.
 */
export function init(options: InitOptions = {}): Promise<Started> {
  return start(
    finderCore,
    {
      simd: () => new URL("./sweep-and-prune.simd.wasm", import.meta.url),
      scalar: () => new URL("./sweep-and-prune.wasm", import.meta.url),
    },
    options,
  );
}
