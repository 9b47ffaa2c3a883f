export * from "./common-api.js";
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
  type SortOptions,
} from "./world-types.js";
export { StaleProxyError } from "./stale-proxy-error.js";
export { SnapshotError } from "./snapshot-error.js";
export type { Filter } from "./filter.js";
