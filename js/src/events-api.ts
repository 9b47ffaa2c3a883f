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
export {
  type Box,
  type BroadPhaseOptions,
  type Buffers,
  type Changes,
  type Numbers,
  type ProxyId,
  slotOf,
} from "./world-types.js";
export { InvalidBoxError, NotInitializedError, OutOfMemoryError, StaleProxyError, SweepAndPruneError } from "./errors.js";
export type { Filter } from "./filter.js";
export type { InitOptions, Started, Wasm } from "./init.js";
export type { Bodies } from "./bodies.js";
