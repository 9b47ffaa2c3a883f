/**
 * A living world of boxes: each update tells which overlaps began and which ended.
 *
 * ```js
 * import { init, BroadPhase } from "sweep-and-prune/broad-phase";
 *
 * await init();
 * const world = new BroadPhase({ dimensions: 2 });
 * const hero = world.insert(0, 0, 1, 2);
 * ```
 *
 * It is an entry of its own, with a compiled core of its own, so that whoever only finds pairs
 * need not load it.
 *
 * @module
 */
import { type InitOptions, start, type Started } from "./init.js";
import { worldCore } from "./world-core.js";

export * from "./broad-phase-api.js";

/** Loads and starts the compiled core of worlds; otherwise as that of `sweep-and-prune`. */
export function init(options: InitOptions = {}): Promise<Started> {
  return start(
    worldCore,
    {
      simd: () => new URL("./broad-phase.simd.wasm", import.meta.url),
      scalar: () => new URL("./broad-phase.wasm", import.meta.url),
    },
    options,
  );
}
