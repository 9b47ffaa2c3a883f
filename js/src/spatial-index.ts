/**
 * A static index: built once over boxes that do not move, it finds those that overlap a box, that are nearest
 * to a point, or that a ray hits.
 *
 * ```js
 * import { init, Index } from "sweep-and-prune/spatial-index";
 *
 * await init();
 * const index = new Index(new Float32Array([0, 0, 2, 2,  5, 5, 6, 6,  2, 1, 3, 4]), { dimensions: 2 });
 * index.search([1, 1, 2, 2]).sort(); // Uint32Array [0, 2]
 * ```
 *
 * It is a separate entry point with its own .wasm file, so pages that only find pairs do not load it.
 *
 * @module
 */
import { entry, type InitOptions, type Started } from "./init.js";
import { indexCore } from "./static-index.js";

export * from "./spatial-index-api.js";

/** Loads and starts the compiled core of this entry point, and those of the others. Otherwise it works as `init` of `sweep-and-prune`. */
export const init: (options?: InitOptions) => Promise<Started> = entry(indexCore, {
  simd: () => new URL("./spatial-index.simd.wasm", import.meta.url),
  scalar: () => new URL("./spatial-index.wasm", import.meta.url),
});
