// Brute force, which decides which pairs are right, up to the number of boxes that it can handle.

/** Up to this many boxes brute force is the reference; above, sweep-and-prune and an alternative that agree. */
export const REFERENCE_LIMIT = 10_000;

/** @type {import("../libraries/index.js").Library} */
export const library = {
  name: "brute force",
  package: "",
  dimensions: [2, 3],
  tasks: ["find", "track"],
  alternative: false,
  how: "brute force",
  module: "brute-force",
};
