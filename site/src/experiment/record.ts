// What has happened in an experiment so far.

import type { Report } from "./experiment.ts";
import type { Lane, ExperimentFrame } from "./messages.ts";

/** What can be plotted. */
export const MEASURES = [
  { key: "ms", label: "Time", unit: "milliseconds per step", read: (r: Report): number | null => r.ms },
  { key: "tests", label: "Tests", unit: "tests per step", read: (r: Report): number | null => r.tests },
  {
    key: "sort",
    label: "Cost of the sort",
    unit: "comparisons and swaps per step",
    read: (r: Report): number | null => (r.comparisons === null || r.swaps === null ? null : r.comparisons + r.swaps),
  },
] as const;

export type Measure = (typeof MEASURES)[number];

/** Steps that the plot shows. */
export const SHOWN = 240;
/** Times are means of the middle half of this many steps: browsers tell the time in tenths of a millisecond. */
export const WINDOW = 60;
/** The same for the plot. */
const SMOOTH = 16;

/** The reports of the last steps, by lane, and whether all agreed on the pairs in every one. */
export class ExperimentRecord {
  /** The step of the first report kept. */
  first = 0;
  readonly lanes: (Report | undefined)[][];
  /** The step in which runners first disagreed. */
  disagreed: { readonly step: number; readonly lanes: readonly number[] } | undefined;
  /** In how many steps at least two were compared. */
  compared = 0;

  constructor(lanes: number) {
    this.lanes = Array.from({ length: lanes }, () => []);
  }

  add({ step, lanes }: ExperimentFrame): void {
    lanes.forEach((lane, place) => this.lanes[place]?.push("report" in lane ? lane.report : undefined));
    const kept = this.lanes[0]?.length ?? 0;
    if (kept > SHOWN) this.lanes.forEach((reports) => reports.shift());
    this.first = step + 1 - Math.min(kept, SHOWN);
    const odd = atOdds(lanes);
    if (lanes.filter((lane) => "report" in lane).length > 1) this.compared++;
    if (odd.length > 0) this.disagreed ??= { step, lanes: odd };
  }

  /** The values of the last steps, the very first step left out unless it is the only one. */
  last(lane: number, measure: Measure): number[] {
    const all = this.lanes[lane] ?? [];
    const steps = this.first === 0 && all.length > 1 ? all.slice(1) : all;
    return steps.slice(-WINDOW).flatMap((report) => (report && measure.read(report)) ?? []);
  }

  /** The middle mean of the last steps; `null` if there is none. */
  level(lane: number, measure: Measure): number | null {
    return middleMean(this.last(lane, measure));
  }

  /** What is plotted, a value a step: times smoothed over some steps, counts as they are. */
  line(lane: number, measure: Measure): (number | null)[] {
    const values = (this.lanes[lane] ?? []).map((report) => (report ? measure.read(report) : null));
    if (measure.key !== "ms") return values;
    return values.map((value, step) => (value === null ? null : middleMean(values.slice(Math.max(step + 1 - SMOOTH, 0), step + 1))));
  }
}

/** The mean of the middle half: no outlier moves it, and unlike a median it sees between two ticks of a coarse clock. */
export function middleMean(all: readonly (number | null | undefined)[]): number | null {
  const values = all.filter((value) => value !== null && value !== undefined).sort((a, b) => a - b);
  if (values.length === 0) return null;
  const cut = Math.floor(values.length / 4);
  const middle = values.slice(cut, values.length - cut);
  return middle.reduce((sum, value) => sum + value, 0) / middle.length;
}

/** The lanes whose pairs are not those of the first runner that is in. */
function atOdds(lanes: readonly Lane[]): number[] {
  const first = lanes.find((lane) => "report" in lane);
  if (!first || !("report" in first)) return [];
  const { pairs, fingerprint } = first.report;
  return lanes.flatMap((lane, place) =>
    "report" in lane && (lane.report.pairs !== pairs || lane.report.fingerprint !== fingerprint) ? [place] : [],
  );
}
