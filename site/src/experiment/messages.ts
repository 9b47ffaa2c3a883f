// What the page of an experiment and its thread say to each other.

import type { RunnerOptions, Lists, Report, WorldOptions } from "./experiment.ts";

export type ToExperiment =
  | {
      readonly type: "begin";
      readonly run: number;
      readonly world: WorldOptions;
      readonly runners: readonly RunnerOptions[];
      /** Steps to take before the first is shown. */
      readonly steps?: number;
      /** Whether the same runners go on, with other boxes of the visitor's own. */
      readonly keep?: boolean;
    }
  | { readonly type: "pace"; readonly running: boolean }
  | { readonly type: "step" }
  /** The page has shown a frame and can take another. */
  | { readonly type: "seen"; readonly run: number };

/** A runner in one step: what it did, or why it is out. */
export type Lane = { readonly report: Report } | { readonly out: string };

/** Balls that fall, in the scene of that name. */
export interface Balls {
  /** The centers, one ball after another. */
  readonly positions: Float32Array;
  /** Milliseconds that their motion took. */
  readonly ms: number;
  /** The box that they are in, how large they are, and the heights at which they started, by which they are painted: with the first frame of a run. */
  readonly world?: { readonly min: readonly number[]; readonly max: readonly number[]; readonly radii: Float32Array; readonly heights: Float32Array } | undefined;
}

export interface ExperimentFrame {
  readonly type: "frame";
  /** The number that the page gave this experiment; what an earlier one still sends is stale. */
  readonly run: number;
  readonly step: number;
  readonly boxes: Float32Array;
  /** The pairs of the first runner that is in. */
  readonly pairs: Uint32Array;
  readonly lanes: readonly Lane[];
  readonly balls?: Balls | undefined;
}

export type FromExperiment =
  | { readonly type: "ready"; readonly lists: Lists }
  /** The addresses of files that the thread has loaded: the page cannot see them itself. */
  | { readonly type: "loaded"; readonly files: readonly string[] }
  /** Why this world is too much. */
  | { readonly type: "refused"; readonly run: number; readonly reason: string }
  | ExperimentFrame
  /** A change of pace was heard: no step that was on its way is still to come. */
  | { readonly type: "paced" }
  | { readonly type: "failed"; readonly message: string };
