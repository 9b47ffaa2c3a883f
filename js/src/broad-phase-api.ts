export type { Boxes, BoxObject, Corner, Dimensions } from "./boxes.js";
export {
  BroadPhase,
  type BroadPhaseOptions,
  type Changes,
  type Hit,
  type Neighbour,
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
export type { InitOptions, Started } from "./init.js";
