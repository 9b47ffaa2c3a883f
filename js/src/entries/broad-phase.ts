/**
 * A persistent broad phase: each update reports which overlaps began and which ended.
 *
 * ```js
 * import { init, BroadPhase } from "sweep-and-prune/broad-phase";
 *
 * await init();
 * const world = new BroadPhase({ dimensions: 2 });
 * const hero = world.insert(0, 0, 1, 2);
 * ```
 *
 * It is a separate entry point with its own .wasm file, so pages that only find pairs do not load it.
 *
 * @module
 */
import { entry, type InitOptions, type Started } from "../wasm/init.js";
import { worldCore } from "../world/core.js";

export * from "./common.js";
export type { Batches } from "../world/batches.js";
export type { Bodies } from "../world/bodies.js";
export { BroadPhase } from "../world/broad-phase.js";
export type { Queries } from "../world/queries.js";
export {
  type Box,
  type BroadPhaseOptions,
  type Buffers,
  type CastOptions,
  type Changes,
  type Corners,
  type EventsOptions,
  type ExcludeOptions,
  type Hit,
  type Hits,
  type InsertOptions,
  type Lists,
  type Neighbor,
  type NeighborLists,
  type Numbers,
  type PairsByBody,
  type Point,
  type Points,
  type ProxyId,
  type QueryFilter,
  type QueryOptions,
  slotOf,
  type SortOptions,
} from "../world/types.js";
export { inPairs } from "../pairs/in-pairs.js";
export { StaleProxyError } from "../world/stale-proxy-error.js";
export { SnapshotError } from "../world/snapshot-error.js";
export type { Filter } from "../world/filter.js";

/** Loads and starts the compiled core of this entry point, and those of the others. Otherwise it works as `init` of `sweep-and-prune`. */
export const init: (options?: InitOptions) => Promise<Started> = entry(worldCore, {
  simd: () => new URL("./broad-phase.simd.wasm", import.meta.url),
  scalar: () => new URL("./broad-phase.wasm", import.meta.url),
});
