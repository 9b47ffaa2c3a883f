export type { Boxes, Dimensions } from "./boxes.js";
export { InvalidBoxError, NotInitializedError, OutOfMemoryError, SweepAndPruneError } from "./errors.js";
export type { InitOptions, Started } from "./init.js";
export { findPairs, type FindPairsOptions, PairFinder } from "./pair-finder.js";
