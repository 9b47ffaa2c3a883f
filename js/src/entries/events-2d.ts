/**
 * A small {@link BroadPhase} for games in 1D and 2D that only need the overlaps that begin and end: half of the
 * download of `sweep-and-prune/broad-phase`.
 *
 * @module
 */
import { entry, type InitOptions, type Started } from "../wasm/init.js";
import type { EventsOptions } from "../world/types.js";
import { core } from "../world/events-2d.js";

export * from "./events.js";
/** How a {@link BroadPhase} treats its boxes. */
export type BroadPhaseOptions<D extends 1 | 2 = 1 | 2> = EventsOptions<D>;
export { BroadPhase } from "../world/events-2d.js";

/** Loads and starts the compiled core of this entry point, and those of the others. Otherwise it works as `init` of `sweep-and-prune`. */
export const init: (options?: InitOptions) => Promise<Started> = entry(core, {
  simd: () => new URL("./events-2d.simd.wasm", import.meta.url),
  scalar: () => new URL("./events-2d.wasm", import.meta.url),
});
