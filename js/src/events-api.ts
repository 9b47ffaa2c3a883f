export * from "./common-api.js";
export {
  type Box,
  type BroadPhaseOptions,
  type Buffers,
  type Changes,
  type Numbers,
  type ProxyId,
  slotOf,
} from "./world-types.js";
export { StaleProxyError } from "./stale-proxy-error.js";
export type { Filter } from "./filter.js";
export type { Bodies } from "./bodies.js";
