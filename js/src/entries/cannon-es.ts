/**
 * Another broad phase for the physics engine cannon-es. It runs on the compiled core of `sweep-and-prune`, whose `init` starts it.
 *
 * ```js
 * import * as CANNON from "cannon-es";
 * import { init } from "sweep-and-prune";
 * import { replaceBroadPhase } from "sweep-and-prune/cannon-es";
 *
 * await init();
 * const world = new CANNON.World();
 * replaceBroadPhase(world);
 * ```
 *
 * @module
 */
export * from "./common.js";
export { type CannonWorld, replaceBroadPhase } from "../engines/cannon-es.js";
