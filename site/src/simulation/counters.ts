// The counters of falling balls: the work of every search, brute force beside it, and the time of each stage.

import { bruteForceTests, type Counter, formatCount, WORK } from "../panel/counters.ts";
import type { Measurement } from "./messages.ts";

/** What the simulation measured, and the page's own share of the time. */
export interface Shown extends Measurement {
  /** Milliseconds a picture, the mean of the last pictures. */
  readonly drawing: number;
}

const milliseconds = new Intl.NumberFormat("en", { minimumFractionDigits: 2, maximumFractionDigits: 2 });
const time = (value: number | null): string | null => (value === null ? null : `${milliseconds.format(value)} ms`);

const [tests, ...others] = WORK;

export const WORK_COUNTERS: readonly Counter<Shown>[] = [
  tests!,
  { key: "brute-force", label: "Brute force would test", meaning: "every pair of n bodies: n(n − 1)/2", read: ({ bodies }) => formatCount(bruteForceTests(bodies)) },
  ...others,
];

export const TIME_COUNTERS: readonly Counter<Shown>[] = [
  { key: "broad-phase", label: "Broad phase", meaning: "from the bodies to the pairs whose boxes overlap; mean of the last steps", read: ({ broadPhase }) => time(broadPhase) },
  { key: "narrow-phase", label: "Narrow phase", meaning: "testing those pairs as discs or spheres, in all substeps; mean of the last steps", read: ({ narrowPhase }) => time(narrowPhase) },
  { key: "solving", label: "Solving", meaning: "moving the bodies, and bouncing and separating those that touch, in all substeps; mean of the last steps", read: ({ solving }) => time(solving) },
  { key: "drawing", label: "Drawing", meaning: "handing one picture to the browser, on the page’s own thread; mean of the last pictures", read: ({ drawing }) => time(drawing) },
];
