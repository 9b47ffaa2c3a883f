import type { DemoVariant } from "sweep-and-prune-classroom/variants";

/** Broken variants, each with a common error, shown on purpose, and balls that show its effect. */
export const broken: Readonly<Record<string, DemoVariant>> = {
  // Four balls in a row, each touching the next, at rest.
  "strict-ties": {
    method: "strict ties (wrong)",
    like: "swap-driven sweep",
    defaults: {
      balls: "[[120,160,60],[240,200,60],[360,160,60],[480,200,60]]",
      motion: "rest",
      "skip-interval": "45",
      decorations: "checks:250,edges,edges:array",
    },
  },
  // Three that overlap from the start, drift apart and meet again.
  "wrong-start": {
    method: "sorted start (wrong)",
    like: "swap-driven sweep",
    defaults: {
      balls: "[[240,170,60,-90,0],[300,220,55,0,0],[370,180,50,100,0]]",
      motion: "drift",
      "no-bounce": "",
      boxes: "",
      decorations: "checks:0",
    },
  },
  // A small ball, a middle one, and a large one that reaches back over both.
  "center-sort": {
    method: "sort by center (wrong)",
    like: "sorted pairwise",
    defaults: {
      balls: "[[130,170,40],[270,210,45],[320,200,170]]",
      static: "",
      draggable: "",
      explain: "",
      boxes: "",
      decorations: "checks:700,edges",
    },
  },
};
