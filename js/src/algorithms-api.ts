export * from "./common-api.js";
export { type AxisOverlap, type Line, type Place, Player, type PlayerState } from "./player.js";
export { axes, type Counts, methods, Runner, type RunnerOptions, sorts, type Step, wrongMethods } from "./runner.js";
export { events, type TraceEvent } from "./trace.js";
