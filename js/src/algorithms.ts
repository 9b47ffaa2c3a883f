/**
 * The classic algorithms, one step at a time: chosen by name, counted, recorded, played forward and
 * backward. They are for learning and teaching. To find pairs fast, use `sweep-and-prune`.
 *
 * @module
 */
import { type InitOptions, start, type Started } from "./init.js";
import { algorithmsCore } from "./runner.js";

export * from "./algorithms-api.js";

/** Loads and starts the compiled algorithms. Otherwise it works as `init` of `sweep-and-prune`. */
export function init(options: InitOptions = {}): Promise<Started> {
  const wasm = () => new URL("./algorithms.wasm", import.meta.url);
  return start(algorithmsCore, { simd: wasm, scalar: wasm }, { ...options, simd: false });
}
