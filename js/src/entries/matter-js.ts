/**
 * Another broad phase for the physics engine matter-js. It runs on the compiled core of `sweep-and-prune`, whose `init` starts it.
 *
 * ```js
 * import Matter from "matter-js";
 * import { init } from "sweep-and-prune";
 * import { replaceBroadPhase } from "sweep-and-prune/matter-js";
 *
 * await init();
 * replaceBroadPhase(Matter);
 * ```
 *
 * @module
 */
export * from "./common.js";
export { type MatterModule, replaceBroadPhase } from "../engines/matter-js.js";
