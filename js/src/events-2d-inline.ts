/**
 * `sweep-and-prune/events-2d` with both builds of the compiled core inside the module: no file to load, but
 * more to download.
 *
 * @module
 */
import scalar from "../dist/events-2d.wasm";
import simd from "../dist/events-2d.simd.wasm";
import { bytesOf } from "./base64.js";
import { entry, type InitOptions, type Started } from "./init.js";
import { eventsCore2D } from "./events-core.js";

export * from "./events-2d-api.js";

/** Loads and starts the compiled core of this entry point, and those of the others. Otherwise it works as `init` of `sweep-and-prune`. */
export const init: (options?: InitOptions) => Promise<Started> = entry(eventsCore2D, { simd: () => bytesOf(simd), scalar: () => bytesOf(scalar) });
