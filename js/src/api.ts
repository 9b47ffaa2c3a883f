export * from "./common-api.js";
export {
  anyPair,
  countPairs,
  type EachPair,
  findPairs,
  findPairsBetween,
  type FindPairsOptions,
  forEachPair,
  PairFinder,
  type PairFinderOptions,
  type PairsInto,
} from "./pair-finder.js";
