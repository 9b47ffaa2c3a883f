export type { BoundsBox, Boxes, BoxObject, Corner, Dimensions, EdgesBox, MinMaxBox } from "./boxes.js";
export {
  BroadPhase,
  type BroadPhaseOptions,
  type Buffers,
  type Changes,
  type Hit,
  type Neighbour,
  type Numbers,
  type ProxyId,
  slotOf,
} from "./world.js";
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
