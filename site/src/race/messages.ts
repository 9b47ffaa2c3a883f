// What the page of the race and its thread say to each other.

import type { RunnerOptions, Lists, Report, WorldOptions } from "../experiment/experiment.ts";

export type ToRace =
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

export interface RaceFrame {
  readonly type: "frame";
  /** The number that the page gave this race; what an earlier one still sends is stale. */
  readonly run: number;
  readonly step: number;
  readonly boxes: Float32Array;
  /** The pairs of the first runner that is in. */
  readonly pairs: Uint32Array;
  readonly lanes: readonly Lane[];
}

export type FromRace =
  | { readonly type: "ready"; readonly lists: Lists }
  /** Why there can be no race in this world. */
  | { readonly type: "refused"; readonly run: number; readonly reason: string }
  | RaceFrame
  /** A change of pace was heard: no step that was on its way is still to come. */
  | { readonly type: "paced" }
  | { readonly type: "failed"; readonly message: string };
