// Who is measured, how, and the name of the module that does it. Each module exports
//
//     create({ dimensions, isMoving, rows }) -> { find(rows), slotOf? }
//
// `rows` is the first frame: one row a box, the minimum corner and then the maximum corner. `find`
// returns the pairs that overlap, `a0, b0, a1, b1, ...` in any order, or what began and ended since
// the last frame, `{ begun, ended }`, of boxes in motion. It may keep buffers between calls; of
// boxes at rest it may know nothing from one call to the next.
//
// The same modules run in Node and in the browser.

/**
 * @typedef {object} Library
 * @property {string} name
 * @property {string} package where it comes from; empty if it stands here
 * @property {readonly number[]} dimensions
 * @property {readonly ("find" | "track")[]} tasks
 * @property {boolean} alternative whether it is another library, or code without one
 * @property {string} how what is called
 * @property {string} module the file that does it, here; `load.js` loads it
 */

/** The name that the others are compared with. */
export const FINDER = "sweep-and-prune";
/** The persistent broad phase of sweep-and-prune. */
export const WORLD = "sweep-and-prune, BroadPhase";
/** The sweep that a good developer writes in an hour. */
export const PLAIN = "plain sweep";

const BOTH = Object.freeze(/** @type {const} */ (["find", "track"]));

/** @type {readonly Library[]} */
export const libraries = [
  {
    name: FINDER,
    package: "sweep-and-prune",
    dimensions: [2, 3],
    tasks: BOTH,
    alternative: false,
    how: "`PairFinder.find` on all boxes, with the option `views`",
    module: "pair-finder",
  },
  {
    name: WORLD,
    package: "sweep-and-prune",
    dimensions: [2, 3],
    tasks: ["track"],
    alternative: false,
    how: "`BroadPhase.setMany` with all boxes, `update`, with the option `views`",
    module: "broad-phase",
  },
  {
    name: PLAIN,
    package: "",
    dimensions: [2, 3],
    tasks: BOTH,
    alternative: true,
    how: "70 lines: sorted and swept along the axis of most variance, in typed arrays",
    module: "plain-sweep",
  },
  {
    name: "box-intersect",
    package: "box-intersect",
    dimensions: [2, 3],
    tasks: BOTH,
    alternative: true,
    how: "`boxIntersect(boxes, visit)`, its arrays of boxes kept",
    module: "box-intersect",
  },
  {
    name: "flatbush",
    package: "flatbush",
    dimensions: [2],
    tasks: BOTH,
    alternative: true,
    how: "index of `Float32Array` built from scratch, `search` for each box, pairs taken in its callback",
    module: "flatbush",
  },
  {
    name: "rbush",
    package: "rbush",
    dimensions: [2],
    tasks: BOTH,
    alternative: true,
    how: "`load` of all boxes, `search` for each, its items kept",
    module: "rbush",
  },
  {
    name: "rbush-3d",
    package: "rbush-3d",
    dimensions: [3],
    tasks: BOTH,
    alternative: true,
    how: "`load` of all boxes, `search` for each, its items kept",
    module: "rbush-3d",
  },
  {
    name: "detect-collisions",
    package: "detect-collisions",
    dimensions: [2],
    tasks: BOTH,
    alternative: true,
    how: "`createBox` each, or `setPosition` of those that moved, and its tree's `search`",
    module: "detect-collisions",
  },
  {
    name: "cannon-es",
    package: "cannon-es",
    dimensions: [3],
    tasks: BOTH,
    alternative: true,
    how: "`SAPBroadphase.collisionPairs`, axis detected, boxes written to its bodies",
    module: "cannon-es",
  },
  {
    name: "matter-js",
    package: "matter-js",
    dimensions: [2],
    tasks: BOTH,
    alternative: true,
    how: "`Detector.collisions` without the exact test, boxes written to its bodies",
    module: "matter-js",
  },
  {
    name: "p2-es",
    package: "p2-es",
    dimensions: [2],
    tasks: BOTH,
    alternative: true,
    how: "`SAPBroadphase.getCollisionPairs`, best axis, boxes written to its bodies",
    module: "p2-es",
  },
  {
    name: "planck",
    package: "planck",
    dimensions: [2],
    tasks: BOTH,
    alternative: true,
    how: "`BroadPhase`: proxies created and its tree queried, or moved and `updatePairs`",
    module: "planck",
  },
  {
    name: "rapier 2D",
    package: "@dimforge/rapier2d-compat",
    dimensions: [2],
    tasks: BOTH,
    alternative: true,
    how: "a world of sensors, `step`, collision events",
    module: "rapier2d",
  },
  {
    name: "rapier 2D, SIMD",
    package: "@dimforge/rapier2d-simd-compat",
    dimensions: [2],
    tasks: BOTH,
    alternative: true,
    how: "as rapier 2D",
    module: "rapier2d-simd",
  },
  {
    name: "rapier 3D",
    package: "@dimforge/rapier3d-compat",
    dimensions: [3],
    tasks: BOTH,
    alternative: true,
    how: "a world of sensors, `step`, collision events",
    module: "rapier3d",
  },
  {
    name: "rapier 3D, SIMD",
    package: "@dimforge/rapier3d-simd-compat",
    dimensions: [3],
    tasks: BOTH,
    alternative: true,
    how: "as rapier 3D",
    module: "rapier3d-simd",
  },
  {
    name: "jolt-physics",
    package: "jolt-physics",
    dimensions: [3],
    tasks: BOTH,
    alternative: true,
    how: "bodies added in bulk or moved, `BroadPhaseQuery.CollideAABox` for each",
    module: "jolt-physics",
  },
];
