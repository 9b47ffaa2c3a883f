/**
 * Balls that bounce: discs in 2D, spheres in 3D, simulated in WebAssembly.
 *
 * The module is loaded once; after that any number of simulations can be made. Everything is
 * deterministic: the same options and the same number of steps give the same bits, here and in
 * the native build, whichever broad phase is chosen.
 */

/** One ball given by hand. Lengths are in the units of the box (pixels for `bouncing`). */
export interface Ball {
  x: number;
  y: number;
  radius: number;
  /** Velocity in units a second; 0 if absent. */
  vx?: number;
  vy?: number;
}

/**
 * `falling`: bodies scattered in a box 10 wide, the y axis up, gravity 9.81 downwards; the box
 * is as high as the bodies need (see `bounds`).
 *
 * `bouncing`: a canvas of `width` x `height` pixels (600 x 400), the y axis down as on a canvas,
 * gravity 500 pixels/s² downwards, restitution 0.96; 2D only. With `balls` they are as given,
 * otherwise `bodies` of them at random places with random velocities, none overlapping.
 */
export type Scene = "falling" | "bouncing";

export interface SimulationOptions {
  /** Default `falling`. */
  scene?: Scene;
  /** 2 or 3; default 3 for `falling`, 2 for `bouncing`. */
  dimensions?: 2 | 3;
  /** 1 to 100,000; default 10,000 (`falling`) or 5 (`bouncing`). Ignored if `balls` is given. */
  bodies?: number;
  /**
   * The middle radius; defaults 0.2 (`falling` in 3D), 0.04 (`falling` in 2D), 35 (`bouncing`).
   * Clamped to what the box can hold.
   */
  size?: number;
  /**
   * The greatest radius over the least, 1 to 100; default 1 (all equal). Radii run from
   * size/sqrt(spread) to size*sqrt(spread), small ones more often.
   */
  spread?: number;
  /** A whole number, 0 to 2^53; default 1. */
  seed?: number;
  /** `bouncing` only: these balls (at most 4,096) instead of random ones. */
  balls?: readonly Ball[];
  /** `bouncing` only: the box in pixels; default 600 x 400. */
  width?: number;
  height?: number;
  /** Acceleration downwards, in units/s²; may be 0 or negative. */
  gravity?: number;
  /** 0 (no bounce) to 1 (no loss); default 0.4 (`falling`) or 0.96 (`bouncing`). */
  restitution?: number;
  /**
   * Substeps of one step of 1/60 s, 1 to 32; default 4, of discs that fall 8. The broad phase runs
   * once for all of them.
   */
  substeps?: number;
  /** Whether balls meet each other, or only the walls; default true. */
  collisions?: boolean;
  /** Whether `step` counts what the algorithm does; default true. */
  counting?: boolean;
  /** Default: the library's `findPairs`. */
  broadPhase?: BroadPhaseOptions;
}

export interface BroadPhaseOptions {
  /** One of `Simulation.algorithms`; the first, the default, is the library's own pair finder. */
  algorithm?: string;
  /** One of `Simulation.sorts`; default the first. Only for algorithms that sort. */
  sort?: string;
  /** One of `Simulation.axes`, or the number of an axis; default the axis of largest variance. */
  axis?: string | number;
  /** Whether a step's order is where the next begins; default true. */
  persistent?: boolean;
}

/**
 * What one step did. The counts are those of the broad phase at the step's beginning, so they
 * compare with n(n-1)/2, and they mean the same for every algorithm;
 * `null` is "not counted": the library's pair finder reports no counts but its pairs, and with
 * `counting` off none are taken. Times are of the whole step; counting is never in them.
 */
export interface StepReport {
  /** How often the broad phase ran over all balls: nearly always once. */
  broadPhases: number;
  /** Pairs of boxes handed to the box test. */
  tests: number | null;
  /** Pairs found to overlap on a swept axis; by the swap-driven algorithms, found to begin to. */
  axisOverlaps: number | null;
  /** Comparisons of the sort. */
  comparisons: number | null;
  /** Swaps of the sort. */
  swaps: number | null;
  /**
   * Overlapping pairs of boxes: what the broad phase hands to the narrow phase. A ball's box
   * encloses all that it is expected to sweep through in the step.
   */
  pairs: number;
  /** Pairs of balls that touch, or will within the substep: what the narrow phase leaves. */
  contacts: number;
  /** Milliseconds of the broad phase in all substeps: balls in, pairs out. */
  broadPhaseMs: number;
  /** Milliseconds of all narrow phases: which balls of the pairs touch. */
  narrowPhaseMs: number;
  /**
   * Milliseconds of the step, without the counting. What is neither broad nor narrow phase went into
   * motion, impulses and projection.
   */
  totalMs: number;
}

export interface Bounds {
  min: number[];
  max: number[];
}

/** A refusal: `code` says what, `message` in words. Nothing has changed. */
export class SimulationError extends Error {
  readonly code: "not-loaded" | "freed" | "invalid-option" | "no-room" | "too-many" | "internal";
}

export class Simulation {
  /**
   * Loads the module; later calls do nothing. Default: `simulation.wasm` beside this file.
   */
  static load(
    source?: string | URL | Response | BufferSource | WebAssembly.Module,
  ): Promise<void>;

  /** The names of the algorithms, the library's own first. Empty before `load`. */
  static readonly algorithms: readonly string[];
  /** The names of the sorts. */
  static readonly sorts: readonly string[];
  /** The names of the rules that choose the sweep axis. */
  static readonly axes: readonly string[];

  constructor(options?: SimulationOptions);

  readonly dimensions: 2 | 3;
  readonly bodies: number;
  /** The box. Balls never leave it. */
  readonly bounds: Bounds;
  /** Steps taken. One step is 1/60 s. */
  readonly steps: number;

  /**
   * Centers, `dimensions` numbers a ball. A view of the module's memory: valid until the next
   * call of any method or constructor, then read the property again (it is cheap). Copy to keep
   * or to transfer.
   */
  readonly positions: Float32Array;
  /** Velocities, as `positions`, in units a second. */
  readonly velocities: Float32Array;
  /** One radius a ball; a view, as `positions`. */
  readonly radii: Float32Array;
  /** The pairs of the boxes of the last step, a0, b0, a1, b1, ..; a view, as `positions`. */
  readonly pairs: Uint32Array;

  /** Live settings; out-of-range numbers are clamped, NaN is refused. */
  gravity: number;
  restitution: number;
  substeps: number;
  collisions: boolean;
  counting: boolean;

  /** Changes the broad phase; what it does not name goes back to its default. */
  setBroadPhase(options: BroadPhaseOptions): void;

  /** 1/60 s. */
  step(): StepReport;

  /**
   * The moment, to come back to: from there the same steps give the same bits again, unless a
   * setting has changed. A number; memory in the module until `forget` or `free`.
   */
  save(): number;
  /** Goes back, or forward again, to a saved moment. `invalid-option` if there is no such one. */
  restore(moment: number): void;
  /** Gives the memory of a saved moment back. One that does not exist is no error. */
  forget(moment: number): void;

  /**
   * Puts a ball at another place, with this velocity (at rest if absent); in 3D z stays. Outside
   * the walls it is put at the nearest place inside. `invalid-option` for NaN and infinities, or
   * if there is no such ball: then nothing has changed.
   */
  place(ball: number, to: { x: number; y: number; vx?: number; vy?: number }): void;

  /** Kinetic plus potential energy, per unit of mass; potential 0 at the wall that is down. */
  energy(): number;
  /** 16 hexadecimal digits of the state: positions and velocities, bit for bit. */
  hash(): string;

  /** Gives the memory back. Idempotent; after it everything else throws `freed`. */
  free(): void;
  [Symbol.dispose](): void;
}
