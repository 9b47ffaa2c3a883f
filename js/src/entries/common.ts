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
} from "../boxes/boxes.js";
export { InterruptedError, InvalidBoxError, NotInitializedError, OutOfMemoryError, SweepAndPruneError } from "../wasm/errors.js";
export type { InitOptions, Started, Wasm } from "../wasm/init.js";
