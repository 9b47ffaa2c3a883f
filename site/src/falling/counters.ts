import type { Measurement } from "../simulation/messages.ts";

/** What the simulation measured, and the page's own share of the time. */
export interface Shown extends Measurement {
  /** Milliseconds a picture, the mean of the last pictures. */
  readonly drawing: number;
}

/** One line of the counters: what it is called, what it means, and where its number comes from. */
interface Counter {
  readonly key: string;
  readonly label: string;
  readonly meaning: string;
  readonly group: "work" | "time";
  /** The text to show; `null` if the algorithm does not count this. */
  readonly read: (shown: Shown) => string | null;
}

const whole = new Intl.NumberFormat("en", { maximumFractionDigits: 0 });
const milliseconds = new Intl.NumberFormat("en", { minimumFractionDigits: 2, maximumFractionDigits: 2 });

/** A count with thousands separators. */
export const formatCount = (count: number): string => whole.format(count);

const count = (value: number | null): string | null => (value === null ? null : whole.format(value));
const time = (value: number | null): string | null => (value === null ? null : `${milliseconds.format(value)} ms`);

/** What brute force tests: each of `n` bodies with each other, once. */
export const bruteForceTests = (n: number): number => (n * (n - 1)) / 2;

/** Every counter, in the order shown. Each means the same for every algorithm. */
export const COUNTERS: readonly Counter[] = [
  {
    key: "tests",
    label: "Tests",
    meaning: "pairs of boxes handed to the box test by the broad phase; 0 for a sweep on every axis, which checks flags instead",
    group: "work",
    read: (m) => count(m.tests),
  },
  {
    key: "brute-force",
    label: "Brute force would test",
    meaning: "every pair of n bodies: n(n − 1)/2",
    group: "work",
    read: (m) => whole.format(bruteForceTests(m.bodies)),
  },
  {
    key: "axis-overlaps",
    label: "Axis overlaps",
    meaning: "pairs whose intervals overlap on the swept axis; for a sweep on every axis, summed over the axes",
    group: "work",
    read: (m) => count(m.axisOverlaps),
  },
  {
    key: "pairs",
    label: "Pairs",
    meaning: "pairs whose boxes overlap on every axis",
    group: "work",
    read: (m) => count(m.pairs),
  },
  {
    key: "comparisons",
    label: "Sort comparisons",
    meaning: "how often the sort compared two endpoints",
    group: "work",
    read: (m) => count(m.comparisons),
  },
  {
    key: "swaps",
    label: "Sort swaps",
    meaning: "how often the sort swapped two endpoints",
    group: "work",
    read: (m) => count(m.swaps),
  },
  {
    key: "broad-phase",
    label: "Broad phase",
    meaning: "from the bodies to the pairs whose boxes overlap; mean of the last steps",
    group: "time",
    read: (m) => time(m.broadPhase),
  },
  {
    key: "narrow-phase",
    label: "Narrow phase",
    meaning: "testing those pairs as discs or spheres, in all substeps; mean of the last steps",
    group: "time",
    read: (m) => time(m.narrowPhase),
  },
  {
    key: "solving",
    label: "Solving",
    meaning: "moving the bodies, and bouncing and separating those that touch, in all substeps; mean of the last steps",
    group: "time",
    read: (m) => time(m.solving),
  },
  {
    key: "drawing",
    label: "Drawing",
    meaning: "handing one picture to the browser, on the page’s own thread; mean of the last pictures",
    group: "time",
    read: (m) => time(m.drawing),
  },
];
