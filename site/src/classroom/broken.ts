import type { DemoVariant } from "sweep-and-prune-classroom/variants";

/** Broken variants, each with a common error, shown on purpose. */
export const broken: Readonly<Record<string, DemoVariant>> = {
  "strict-ties": { method: "strict ties (wrong)", like: "swap-driven sweep", defaults: {} },
  "wrong-start": { method: "sorted start (wrong)", like: "swap-driven sweep", defaults: {} },
  "center-sort": { method: "sort by center (wrong)", like: "sorted pairwise", defaults: {} },
};
