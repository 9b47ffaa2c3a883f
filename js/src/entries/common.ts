/** What every entry point has. */
export type {
  BoundsBox,
  Boxes,
  BoxObject,
  Corner,
  Corner1D,
  Corner2D,
  Corner3D,
  Dimensions,
  EdgesBox,
  MinMaxBox,
  SidesBox,
  SizedBox,
  TypedNumbers,
} from "../boxes/boxes.js";
export { InterruptedError, InvalidBoxError, NotInitializedError, OutOfMemoryError, SweepAndPruneError } from "../wasm/errors.js";
export type { InitOptions, Started, Wasm } from "../wasm/init.js";
