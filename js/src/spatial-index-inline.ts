/**
 * `sweep-and-prune/spatial-index` with both builds of the compiled core inside the module: no file to
 * load, but more to download.
 *
 * @module
 */
import scalar from "../dist/spatial-index.wasm";
import simd from "../dist/spatial-index.simd.wasm";
import { entry, type InitOptions, type Started } from "./init.js";
import { indexCore } from "./static-index.js";

export * from "./spatial-index-api.js";

/** Loads and starts the compiled core of this entry point, and those of the others. Otherwise it works as `init` of `sweep-and-prune`. */
export const init: (options?: InitOptions) => Promise<Started> = entry(indexCore, { simd: () => simd, scalar: () => scalar });
