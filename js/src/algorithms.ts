/**
 * The algorithms of the field, one step at a time: chosen by name, counted, recorded, played
 * forward and back. To learn from and to show; to only get the pairs use `sweep-and-prune`.
 *
 * @module
 */
import { type InitOptions, start, type Started } from "./init.js";
import { algorithmsCore } from "./runner.js";

export * from "./algorithms-api.js";

/** Loads and starts the compiled algorithms; otherwise as that of `sweep-and-prune`. */
export function init(options: InitOptions = {}): Promise<Started> {
  const wasm = () => new URL("./algorithms.wasm", import.meta.url);
  return start(algorithmsCore, { simd: wasm, scalar: wasm }, { ...options, simd: false });
}
