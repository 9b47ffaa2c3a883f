export type { BoundsBox, Boxes, BoxObject, Corner, Dimensions, EdgesBox, MinMaxBox } from "./boxes.js";
export { InvalidBoxError, NotInitializedError, OutOfMemoryError, SweepAndPruneError } from "./errors.js";
export type { InitOptions, Started, Wasm } from "./init.js";
export {
  countPairs,
  type EachPair,
  findPairs,
  findPairsBetween,
  type FindPairsOptions,
  forEachPair,
  PairFinder,
  type PairFinderOptions,
} from "./pair-finder.js";
