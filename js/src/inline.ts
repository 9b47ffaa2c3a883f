/**
 * `sweep-and-prune` with both builds of the compiled core inside the module: no file to load, but
 * three times as much to download.
 *
 * @module
 */
import scalar from "../dist/sweep-and-prune.wasm";
import simd from "../dist/sweep-and-prune.simd.wasm";
import { bytesOf } from "./base64.js";
import { entry, type InitOptions, type Started } from "./init.js";
import { finderCore } from "./pair-finder.js";

export * from "./api.js";

/**
 * Starts the compiled core, and those of the other entry points that the program has imported. Call it
 * once, before anything else. Later and concurrent calls get the promise of the first call, and their
 * options are ignored.
 */
export const init: (options?: InitOptions) => Promise<Started> = entry(finderCore, { simd: () => bytesOf(simd), scalar: () => bytesOf(scalar) });
