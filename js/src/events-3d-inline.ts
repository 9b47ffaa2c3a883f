/**
 * `sweep-and-prune/events-3d` with both builds of the compiled core inside the module: no file to load, but
 * more to download.
 *
 * @module
 */
import scalar from "../dist/events-3d.wasm";
import simd from "../dist/events-3d.simd.wasm";
import { bytesOf } from "./base64.js";
import { entry, type InitOptions, type Started } from "./init.js";
import { eventsCore3D } from "./events-core.js";

export * from "./events-3d-api.js";

/** Loads and starts the compiled core of this entry point, and those of the others. Otherwise it works as `init` of `sweep-and-prune`. */
export const init: (options?: InitOptions) => Promise<Started> = entry(eventsCore3D, { simd: () => bytesOf(simd), scalar: () => bytesOf(scalar) });
