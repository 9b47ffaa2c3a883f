/**
 * `sweep-and-prune/algorithms` with the compiled algorithms inside the module.
 *
 * @module
 */
import wasm from "../dist/algorithms.wasm";
import { bytesOf } from "./base64.js";
import { entry, type InitOptions, type Started } from "./init.js";
import { algorithmsCore } from "./runner.js";

export * from "./algorithms-api.js";

/** Loads and starts the compiled core of this entry point, and those of the others. Otherwise it works as `init` of `sweep-and-prune`. */
export const init: (options?: InitOptions) => Promise<Started> = entry(algorithmsCore, { scalar: () => bytesOf(wasm) });
