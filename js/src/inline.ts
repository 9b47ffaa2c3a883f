/**
 * `sweep-and-prune` with both builds of the compiled core inside the module: no file to load, but
 * three times as much to download.
 *
 * @module
 */
import scalar from "../dist/sweep-and-prune.wasm";
import simd from "../dist/sweep-and-prune.simd.wasm";
import { type InitOptions, start, type Started } from "./init.js";
import { finderCore } from "./pair-finder.js";

export * from "./api.js";

/**
 * Starts the compiled core. Call it once, before anything else. Later and concurrent calls get the
 * promise of the first call, and their options are ignored.
 */
export function init(options: InitOptions = {}): Promise<Started> {
  return start(finderCore, { simd: () => simd, scalar: () => scalar }, options);
}
