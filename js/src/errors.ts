/**
 * What this package throws. Misuse of a call is a built-in `TypeError` or `RangeError`; everything
 * that depends on the data or on the machine is one of these. After an error nothing has changed.
 */
export class SweepAndPruneError extends Error {
  /** The name of this class. */
  override name = "SweepAndPruneError";
}

/** A box is not `min <= max` on some axis: it is inverted, or holds a NaN. */
export class InvalidBoxError extends SweepAndPruneError {
  /** The name of this class. */
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
  /** The name of this class. */
  override name = "NotInitializedError";

  constructor() {
    super("sweep-and-prune is not ready: `await init()` once before the first call");
  }
}

/** The boxes or their pairs do not fit in the memory of WebAssembly, 4 GiB at most. */
export class OutOfMemoryError extends SweepAndPruneError {
  /** The name of this class. */
  override name = "OutOfMemoryError";

  constructor() {
    super("out of memory: the boxes or their pairs do not fit in WebAssembly's memory");
  }
}

/** A proxy id is of a body that was removed, or was never given out by this world. */
export class StaleProxyError extends SweepAndPruneError {
  /** The name of this class. */
  override name = "StaleProxyError";

  constructor(
    /** The position of the id among those that were passed, 0 for a single one. */
    readonly index: number,
  ) {
    super(`proxy id ${index} is stale: its body was removed, or it never had one here`);
  }
}

/** Bytes that are no snapshot of such a world. */
export class SnapshotError extends SweepAndPruneError {
  /** The name of this class. */
  override name = "SnapshotError";

  /** @internal */
  constructor(fault: number, found: number) {
    const faults = [
      "it does not begin as one does",
      `it is of version ${found}, which cannot be read here`,
      "it holds a world of other dimensions or of the other precision",
      "it ends too early",
      "its parts contradict each other or their checksum",
    ];
    super(`these bytes are no snapshot of such a world: ${faults[fault] ?? "they are damaged"}`);
  }
}
