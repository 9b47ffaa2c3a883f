/**
 * `sweep-and-prune/algorithms` with the compiled algorithms inside the module.
 *
 * @module
 */
import wasm from "../dist/algorithms.wasm";
import { type InitOptions, start, type Started } from "./init.js";
import { algorithmsCore } from "./runner.js";

export * from "./algorithms-api.js";

/** Starts the compiled algorithms. Otherwise it works as `init` of `sweep-and-prune/inline`. */
export function init(options: InitOptions = {}): Promise<Started> {
  return start(algorithmsCore, { simd: () => wasm, scalar: () => wasm }, { ...options, simd: false });
}
