// The contender that decides who is right, up to the number of boxes that it can.

/** Up to so many boxes brute force is the reference; beyond, ours and a rival that agree. */
export const REFERENCE_LIMIT = 10_000;

/** @type {import("../contenders/index.js").Contender} */
export const contender = {
  name: "brute force",
  package: "",
  dimensions: [2, 3],
  tasks: ["find", "follow"],
  rival: false,
  how: "all pairs tested",
  module: "brute-force",
};
