export * from "./common-api.js";
export {
  Index,
  IndexDataError,
  type IndexFilter,
  type IndexHit,
  type IndexNeighbor,
  type IndexOptions,
  type NeighborsOptions,
  type Point,
  type SearchOptions,
} from "./static-index.js";
