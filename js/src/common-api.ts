/** What every entry point has. */
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
export { InterruptedError, InvalidBoxError, NotInitializedError, OutOfMemoryError, SweepAndPruneError } from "./errors.js";
export type { InitOptions, Started, Wasm } from "./init.js";
