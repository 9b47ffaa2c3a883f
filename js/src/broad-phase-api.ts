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
export type { Bodies } from "./bodies.js";
export { BroadPhase } from "./world.js";
export {
  type Box,
  type BroadPhaseOptions,
  type Buffers,
  type Changes,
  type Hit,
  type Neighbor,
  type Numbers,
  type Point,
  type ProxyId,
  type QueryFilter,
  slotOf,
} from "./world-types.js";
export {
  InvalidBoxError,
  NotInitializedError,
  OutOfMemoryError,
  SnapshotError,
  StaleProxyError,
  SweepAndPruneError,
} from "./errors.js";
export type { Filter } from "./filter.js";
export type { InitOptions, Started, Wasm } from "./init.js";
