// Whether the algorithms found the same pairs, and which is the fastest, once the clock can tell.

import { formatCount } from "../panel/counters.ts";
import type { ExperimentFrame } from "../experiment/messages.ts";
import { type ExperimentRecord, MEASURES, middleMean, WINDOW } from "../experiment/record.ts";

/** An algorithm that is still in, and the milliseconds of its last steps, the very first step left out. */
export interface Timed {
  readonly name: string;
  readonly times: readonly number[];
}

/** What all found; then the fastest. */
export function verdict({ lanes }: ExperimentFrame, record: ExperimentRecord, names: readonly string[]): string {
  const reports = lanes.flatMap((lane) => ("report" in lane ? [lane.report] : []));
  const [first] = reports;
  if (record.disagreed) return "The algorithms disagree.";
  if (!first || record.compared === 0) return "No other algorithm to compare with.";
  const before = record.compared > 1 ? `, in this step and in all ${formatCount(record.compared)} so far` : "";
  const timed = names.flatMap((name, lane) => (lanes[lane] && "report" in lanes[lane] ? [{ name, times: record.last(lane, MEASURES[0]) }] : []));
  return `All ${reports.length} found the same ${formatCount(first.pairs)} pairs${before}. ${fastest(timed)}`;
}

/**
 * The fastest algorithm, by this rule:
 * 1. Each has `WINDOW` measured steps.
 * 2. Times shorter than one tick of the clock count as one tick. The tick is the smallest difference between two
 *    of the times, or between a time and 0.
 * 3. The same algorithm is the fastest in the older half of these steps and in the newer half.
 */
export function fastest(all: readonly Timed[]): string {
  const measured = Math.min(...all.map(({ times }) => times.length));
  if (measured < WINDOW) return `Measuring the time: ${measured} of ${WINDOW} steps.`;
  const tick = tickOf(all.flatMap(({ times }) => times));
  const ranked = (from: number, to?: number): { name: string; ms: number }[] =>
    all
      .map(({ name, times }) => ({ name, ms: Math.max(middleMean(times.slice(-WINDOW).slice(from, to)) ?? 0, tick) }))
      .sort((a, b) => a.ms - b.ms);
  const [first, second] = ranked(0);
  if (!first || !second) return "";
  if (second.ms === tick) return `${first.name} and ${second.name} are both faster than the clock of this browser can tell apart.`;
  const factor = second.ms / first.ms;
  if (factor < 1.05) return `Fastest: ${first.name} and ${second.name}, about equal.`;
  const halves = [ranked(0, WINDOW / 2), ranked(WINDOW / 2)];
  if (halves.some(([leader]) => leader?.name !== first.name)) return "No algorithm is the fastest all the time.";
  const least = first.ms === tick ? "at least " : "";
  return `Fastest: ${first.name}, ${least}${factor < 10 ? factor.toFixed(1) : Math.round(factor)} times as fast as ${second.name}.`;
}

/** The smallest difference between two times or a time and 0, in whole microseconds: below that is rounding. */
function tickOf(times: readonly number[]): number {
  const sorted = [0, ...times].map((ms) => Math.round(1000 * ms)).sort((a, b) => a - b);
  const steps = sorted.slice(1).map((time, at) => time - (sorted[at] ?? 0)).filter((step) => step > 0);
  return steps.length === 0 ? 0 : Math.min(...steps) / 1000;
}
