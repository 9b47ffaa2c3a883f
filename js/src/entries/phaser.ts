/**
 * Another broad phase for overlaps of groups in Phaser's arcade physics. It runs on the compiled core of `sweep-and-prune`, whose
 * `init` starts it.
 *
 * ```js
 * import { init } from "sweep-and-prune";
 * import { replaceBroadPhase } from "sweep-and-prune/phaser";
 *
 * await init();
 * class Level extends Phaser.Scene {
 *   create() {
 *     replaceBroadPhase(this);
 *   }
 * }
 * ```
 *
 * @module
 */
export * from "./common.js";
export { type ArcadeScene, replaceBroadPhase } from "../engines/phaser.js";
