/**
 * Another broad phase for the game engine Excalibur. It runs on the compiled core of `sweep-and-prune/broad-phase`, whose `init`
 * starts it.
 *
 * ```js
 * import * as ex from "excalibur";
 * import { init } from "sweep-and-prune/broad-phase";
 * import { replaceBroadPhase } from "sweep-and-prune/excalibur";
 *
 * await init();
 * replaceBroadPhase(engine.currentScene, ex);
 * ```
 *
 * @module
 */
export * from "./common.js";
export { type ExcaliburModule, type ExcaliburScene, replaceBroadPhase } from "../engines/excalibur.js";
