// What the page and the thread of the simulation say to each other.

/** The axes by name. */
export const AXIS_NAMES: readonly string[] = ["x", "y"];

/** How the pairs are found. Names are those that `Choices` lists. */
export interface Method {
  readonly algorithm: string;
  readonly sort: string;
  /** A rule, or one of `AXIS_NAMES`. */
  readonly axis: string;
}

/** Every name that a `Method` may hold, as the compiled simulation gives them. */
export interface Choices {
  readonly algorithms: readonly string[];
  readonly sorts: readonly string[];
  readonly axes: readonly string[];
}

/** A world to begin with. The same setup gives the same world, step for step, bit for bit. */
export interface Setup {
  readonly bodies: number;
  /** The middle radius; the box is 10 wide. */
  readonly radius: number;
  /** The greatest radius over the least. */
  readonly spread: number;
  readonly seed: number;
}

/** The laws, which can change while a world goes on. */
export interface Laws {
  /** Downwards, in units/s². */
  readonly gravity: number;
  /** Equal parts of a step. */
  readonly substeps: number;
}

/**
 * The counters of one step. `null` is not counted: the algorithm does not do this, or does not
 * tell; all but `bodies` are `null` before it has taken a step.
 */
export interface Measurement {
  readonly bodies: number;
  /** Counts of the broad phase at the beginning of the step. */
  readonly tests: number | null;
  readonly axisOverlaps: number | null;
  readonly pairs: number | null;
  readonly comparisons: number | null;
  readonly swaps: number | null;
  /** Milliseconds of a step, the mean of the last steps: from bodies to pairs, */
  readonly broadPhase: number | null;
  /** from pairs to those that touch, */
  readonly narrowPhase: number | null;
  /** and moving and parting them. */
  readonly solving: number | null;
}

export type ToSimulation =
  | { readonly type: "begin"; readonly run: number; readonly setup: Setup; readonly laws: Laws; readonly method: Method }
  | { readonly type: "method"; readonly method: Method }
  | { readonly type: "laws"; readonly laws: Laws }
  | { readonly type: "pace"; readonly running: boolean }
  | { readonly type: "step" }
  /** Whether frames carry the pairs. */
  | { readonly type: "list-pairs"; readonly on: boolean }
  /** A buffer of positions, drawn and free for the next frame. */
  | { readonly type: "recycle"; readonly run: number; readonly positions: Float32Array };

/** A world has begun: bodies of these radii in the box from `min` to `max`, the second axis up. */
export interface Begun {
  readonly type: "begun";
  /** The number that the page gave this world; what an earlier one still sends is stale. */
  readonly run: number;
  readonly min: readonly number[];
  readonly max: readonly number[];
  readonly radii: Float32Array;
}

/** The state after a step. */
export interface Frame {
  readonly type: "frame";
  readonly run: number;
  readonly step: number;
  /** How many changes of the method this thread has seen: what is measured belongs to the last of them. */
  readonly methods: number;
  /** Whether steps follow by themselves. */
  readonly running: boolean;
  /** Steps a second, of late; 0 while that is not known. */
  readonly pace: number;
  /** 16 hexadecimal digits of all positions and velocities; empty while steps follow by themselves. */
  readonly hash: string;
  readonly positions: Float32Array;
  readonly pairs: Uint32Array;
  readonly measurement: Measurement;
}

export type FromSimulation =
  | { readonly type: "ready"; readonly choices: Choices }
  | Begun
  | Frame
  | { readonly type: "failed"; readonly message: string };
