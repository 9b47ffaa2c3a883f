/**
 * The errors of this package. Wrong arguments throw a built-in `TypeError` or `RangeError`; errors
 * that depend on the data or on the machine extend this class. After an error nothing has changed.
 */
export class SweepAndPruneError extends Error {
  /** The name of this class. */
  override name = "SweepAndPruneError";
}

/** A box is inverted or NaN on some axis: `min <= max` does not hold. */
export class InvalidBoxError extends SweepAndPruneError {
  /** The name of this class. */
  override name = "InvalidBoxError";

  constructor(
    /** The position of the box in the argument: the first one that is invalid. */
    readonly index: number,
    /** Its first invalid axis: 0 for x, 1 for y, 2 for z. */
    readonly axis: number,
    /** The name of the argument: `boxes`, `a`, `b`, ... */
    readonly argument: string = "boxes",
    /** Its min on that axis. */
    readonly min: number = NaN,
    /** Its max on that axis. */
    readonly max: number = NaN,
  ) {
    const fault = Number.isNaN(min) || Number.isNaN(max) ? "has a NaN" : min === Infinity && max === -Infinity ? "is empty" : "is inverted";
    super(`box ${index} of \`${argument}\` ${fault} on axis ${axis} (${"xyz"[axis]}): its min is ${min} and its max ${max}${hints[fault]}`);
  }
}

const hints = {
  "has a NaN": "",
  "is empty": ", as bounds of nothing are; leave it out",
  "is inverted": ". A box is its min corner and then its max corner: a position and a size are `{ x, y, width, height }`",
};

/** A call was made before the promise of `init()` was fulfilled. */
export class NotInitializedError extends SweepAndPruneError {
  /** The name of this class. */
  override name = "NotInitializedError";

  /** @internal */
  constructor(entry = "sweep-and-prune") {
    super(`"${entry}" is not initialized: import \`init\` from "${entry}" and \`await init()\` before the first call; one \`init()\` starts all entry points imported before it`);
  }
}

/** The boxes or their pairs do not fit in the memory of WebAssembly, 4 GiB at most. */
export class OutOfMemoryError extends SweepAndPruneError {
  /** The name of this class. */
  override name = "OutOfMemoryError";

  constructor() {
    super("out of memory: the boxes or their pairs do not fit in WebAssembly's memory, 4 GiB at most");
  }
}

/**
 * An earlier call with this object ended halfway, so that its state is lost: the engine had no stack left.
 * Free it, and make another one. (Nearly always such a call ends before anything has changed; then no later call
 * throws this.)
 */
export class InterruptedError extends SweepAndPruneError {
  /** The name of this class. */
  override name = "InterruptedError";

  /** @internal */
  constructor(what: string) {
    super(`a call of this ${what} ended halfway, as the stack ran out: its state is lost; free it`);
  }
}
