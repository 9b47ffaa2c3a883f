import { checkOptions } from "./bodies.js";
import type { Dimensions } from "../boxes/boxes.js";
import type { Core } from "../wasm/init.js";
import type { WorldExports } from "./core.js";
import { WorldMemory } from "./memory.js";
import type { EventsOptions } from "./types.js";

/** An empty broad phase of a core that has only these dimensions, in single precision. */
export function eventsMemory(core: Core<WorldExports>, dimensions: readonly Dimensions[], options: EventsOptions): WorldMemory {
  const checked = checkOptions(options);
  if (!dimensions.includes(checked.dimensions) || checked.precision === "double") {
    throw new RangeError(
      `"${core.entry}" has boxes of ${dimensions.join(" or ")} dimensions in single precision only: ` +
        'import `BroadPhase` from "sweep-and-prune/broad-phase"',
    );
  }
  return WorldMemory.create(core, checked);
}
