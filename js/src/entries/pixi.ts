/**
 * Bodies of a `BroadPhase` that are sprites or other containers of Pixi: their boxes.
 *
 * ```js
 * import { BroadPhase, init } from "sweep-and-prune/broad-phase";
 * import { insertObjects, moveObjects } from "sweep-and-prune/pixi";
 *
 * await init();
 * const world = new BroadPhase({ dimensions: 2 });
 * insertObjects(world, sprites);
 * moveObjects(world); // in each frame
 * ```
 *
 * @module
 */
export * from "./common.js";
export { insertObjects, moveObjects, type PixiObject, type PixiParent } from "../engines/pixi.js";
