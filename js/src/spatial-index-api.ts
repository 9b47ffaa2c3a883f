export type {
  BoundsBox,
  Boxes,
  BoxObject,
  Corner,
  Dimensions,
  EdgesBox,
  MinMaxBox,
  SizedBox,
  TypedNumbers,
} from "./boxes.js";
export { InvalidBoxError, NotInitializedError, OutOfMemoryError, SweepAndPruneError } from "./errors.js";
export type { InitOptions, Started, Wasm } from "./init.js";
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
