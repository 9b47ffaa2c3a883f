/**
 * `sweep-and-prune/broad-phase` with both builds of the compiled core inside the module: no file to
 * load, but more to download.
 *
 * @module
 */
import scalar from "../dist/broad-phase.wasm";
import simd from "../dist/broad-phase.simd.wasm";
import { bytesOf } from "./base64.js";
import { entry, type InitOptions, type Started } from "./init.js";
import { worldCore } from "./world-core.js";

export * from "./broad-phase-api.js";

/** Loads and starts the compiled core of this entry point, and those of the others. Otherwise it works as `init` of `sweep-and-prune`. */
export const init: (options?: InitOptions) => Promise<Started> = entry(worldCore, { simd: () => bytesOf(simd), scalar: () => bytesOf(scalar) });
