/**
 * What this package throws. Misuse of a call is a built-in `TypeError` or `RangeError`; everything
 * that depends on the data or on the machine is one of these. After an error nothing has changed.
 */
export class SweepAndPruneError extends Error {
  override name = "SweepAndPruneError";
}

/** A box is not `min <= max` on some axis: it is inverted, or holds a NaN. */
export class InvalidBoxError extends SweepAndPruneError {
  override name = "InvalidBoxError";

  constructor(
    /** The position of the box: the first one that is invalid. */
    readonly index: number,
    /** Its first invalid axis: 0 for x, 1 for y, 2 for z. */
    readonly axis: number,
  ) {
    super(`box ${index} is inverted or NaN on axis ${axis}: min <= max must hold`);
  }
}

/** A call came before the promise of `init()` was fulfilled. */
export class NotInitializedError extends SweepAndPruneError {
  override name = "NotInitializedError";

  constructor() {
    super("sweep-and-prune is not ready: `await init()` once before the first call");
  }
}

/** The boxes or their pairs do not fit in the memory of WebAssembly, 4 GiB at most. */
export class OutOfMemoryError extends SweepAndPruneError {
  override name = "OutOfMemoryError";

  constructor() {
    super("out of memory: the boxes or their pairs do not fit in WebAssembly's memory");
  }
}
