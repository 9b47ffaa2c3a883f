// Loads the module of a library, with the package that it measures; only what runs it imports this.

/** @type {Record<string, () => Promise<any>>} */
const modules = {
  "brute-force": () => import("./brute-force.js"),
  "pair-finder": () => import("./pair-finder.js"),
  "broad-phase": () => import("./broad-phase.js"),
  "plain-sweep": () => import("./plain-sweep.js"),
  "box-intersect": () => import("./box-intersect.js"),
  "flatbush": () => import("./flatbush.js"),
  "rbush": () => import("./rbush.js"),
  "rbush-3d": () => import("./rbush-3d.js"),
  "detect-collisions": () => import("./detect-collisions.js"),
  "cannon-es": () => import("./cannon-es.js"),
  "matter-js": () => import("./matter-js.js"),
  "p2-es": () => import("./p2-es.js"),
  "planck": () => import("./planck.js"),
  "rapier2d": () => import("./rapier2d.js"),
  "rapier2d-simd": () => import("./rapier2d-simd.js"),
  "rapier3d": () => import("./rapier3d.js"),
  "rapier3d-simd": () => import("./rapier3d-simd.js"),
  "jolt-physics": () => import("./jolt-physics.js"),
};

/** @param {{ module: string }} library */
export function load({ module }) {
  const start = modules[module];
  if (!start) throw new Error(`there is no module '${module}'`);
  return start();
}
