/**
 * The same as `sweep-and-prune`, with both builds of the compiled core inside the module: nothing
 * to load, but three times as much to download.
 *
 * @module
 */
import scalar from "../dist/sweep-and-prune.wasm";
import simd from "../dist/sweep-and-prune.simd.wasm";
import { type InitOptions, start, type Started } from "./init.js";
import { finderCore } from "./pair-finder.js";

export * from "./api.js";

/**
 * Starts the compiled core: once, before the first call of anything else. Later and concurrent
 * calls get the promise of the first, whose options are the ones that count.
 */
export function init(options: InitOptions = {}): Promise<Started> {
  return start(finderCore, { simd: () => simd, scalar: () => scalar }, options);
}
