/**
 * The classic algorithms, one step at a time: chosen by name, counted, recorded, played forward and
 * backward. They are for learning and teaching. To find pairs fast, use `sweep-and-prune`.
 *
 * @module
 */
import { entry, type InitOptions, type Started } from "./init.js";
import { algorithmsCore } from "./runner.js";

export * from "./algorithms-api.js";

/** Loads and starts the compiled core of this entry point, and those of the others. Otherwise it works as `init` of `sweep-and-prune`. */
export const init: (options?: InitOptions) => Promise<Started> = entry(algorithmsCore, {
  scalar: () => new URL("./algorithms.wasm", import.meta.url),
});
