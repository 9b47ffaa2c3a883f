/** What both entry points for events have. */
export * from "./common.js";
export {
  type Box,
  type Buffers,
  type Changes,
  type Corners,
  type EventsOptions,
  type Numbers,
  type ProxyId,
  slotOf,
} from "../world/types.js";
export { StaleProxyError } from "../world/stale-proxy-error.js";
export type { Filter } from "../world/filter.js";
export type { Bodies } from "../world/bodies.js";
