/**
 * Bodies of a `BroadPhase` that are meshes of three.js: their boxes, and picking.
 *
 * ```js
 * import { BroadPhase, init } from "sweep-and-prune/broad-phase";
 * import { insertObjects, moveObjects, pick } from "sweep-and-prune/three";
 *
 * await init();
 * const world = new BroadPhase({ dimensions: 3 });
 * insertObjects(world, meshes);
 * moveObjects(world); // in each frame
 * const hit = pick(world, raycaster);
 * ```
 *
 * @module
 */
export * from "./common.js";
export { insertObjects, moveObjects, pick, type ThreeHit, type ThreeObject, type ThreeRaycaster } from "../engines/three.js";
