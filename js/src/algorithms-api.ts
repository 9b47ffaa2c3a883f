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
export { type AxisOverlap, type Line, type Place, Player, type PlayerState } from "./player.js";
export { axes, type Counts, methods, Runner, type RunnerOptions, sorts, type Step, wrongMethods } from "./runner.js";
export { events, type TraceEvent } from "./trace.js";
