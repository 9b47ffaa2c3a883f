/**
 * The classic algorithms, one step at a time: chosen by name, counted, recorded, played forward and
 * backward. They are for learning and teaching. To find pairs fast, use `sweep-and-prune`.
 *
 * @module
 */
import { entry, type InitOptions, type Started } from "../../../js/src/wasm/init.js";
import { algorithmsCore } from "./algorithms/runner.js";

export * from "../../../js/src/entries/common.js";
export { type AxisOverlap, type Line, type Place, Player, type PlayerState } from "./algorithms/player.js";
export { axes, type Counts, methods, Runner, type RunnerOptions, sorts, type Step } from "./algorithms/runner.js";
export { events, type TraceEvent } from "./algorithms/trace.js";

/** Loads and starts the compiled algorithms. Otherwise it works as `init` of `sweep-and-prune`, which it does not start. */
export const init: (options?: InitOptions) => Promise<Started> = entry(algorithmsCore, {
  scalar: () => new URL("./algorithms.wasm", import.meta.url),
});
