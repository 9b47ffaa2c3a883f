import { Core } from "../wasm/init.js";
import { Bodies } from "./bodies.js";
import type { WorldExports } from "./core.js";
import { eventsMemory } from "./events-memory.js";
import type { EventsOptions } from "./types.js";

/** The core for events in 3D. */
export const core: Core<WorldExports> = new Core("world_new", "sweep-and-prune/events-3d");

/**
 * The `BroadPhase` of `sweep-and-prune/broad-phase` for 3D in single precision, without data, the
 * options of `insert`, `boxes`, excluded pairs, queries, casts, lists of pairs and snapshots. What it has works in the same way and takes as long.
 *
 * ```js
 * using world = new BroadPhase({ dimensions: 3 });
 * ```
 */
export class BroadPhase<D extends 3 = 3> extends Bodies<D> {
  /**
   * An empty broad phase.
   *
   * @throws {@link NotInitializedError} before `init()` is done.
   * @throws `RangeError` for other dimensions, double precision, or a margin or prediction that is
   *   negative, infinite or NaN; `TypeError` if `views` is not a boolean.
   */
  constructor(options: EventsOptions<D>) {
    super(eventsMemory(core, [3], options));
  }
}
