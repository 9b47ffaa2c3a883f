/**
 * `sweep-and-prune/broad-phase` with both builds of the compiled core inside the module: no file to
 * load, but more to download.
 *
 * @module
 */
import scalar from "../dist/broad-phase.wasm";
import simd from "../dist/broad-phase.simd.wasm";
import { type InitOptions, start, type Started } from "./init.js";
import { worldCore } from "./world-core.js";

export * from "./broad-phase-api.js";

/** Starts the compiled core of this entry point. Otherwise it works as `init` of `sweep-and-prune/inline`. */
export function init(options: InitOptions = {}): Promise<Started> {
  return start(worldCore, { simd: () => simd, scalar: () => scalar }, options);
}
