// One frame of the race, in words and numbers.

import { formatCount } from "../falling/counters.ts";
import type { LANE_COUNTERS } from "./markup.ts";
import type { Lane, RaceFrame } from "./messages.ts";
import type { RaceRecord } from "./record.ts";

/** The time of an algorithm, if it is still in. */
interface Level {
  readonly name: string;
  readonly ms: number | null;
}

/** Of fewer steps than this no winner is named. */
const LEAST_STEPS = 10;

/** Whether all found the same, so far, and which is the fastest. */
export function verdict({ lanes }: RaceFrame, { compared, disagreed }: RaceRecord, levels: readonly Level[]): string {
  const reports = lanes.flatMap((lane) => ("report" in lane ? [lane.report] : []));
  const [first] = reports;
  if (disagreed) return "The algorithms disagree.";
  if (!first || compared === 0) return "No other algorithm to compare with.";
  const before = compared > 1 ? `, in this step and in all ${formatCount(compared)} so far` : "";
  const won = compared < LEAST_STEPS ? "" : ` ${winner(levels)}`;
  return `All ${reports.length} found the same ${formatCount(first.pairs)} pairs${before}.${won}`;
}

function winner(levels: readonly Level[]): string {
  const [first, second] = levels.flatMap(({ name, ms }) => (ms === null ? [] : [{ name, ms }])).sort((a, b) => a.ms - b.ms);
  if (!first || !second) return "";
  const factor = second.ms / Math.max(first.ms, 1e-3);
  if (factor < 1.05) return `Fastest: ${first.name} and ${second.name}, about equal.`;
  return `Fastest: ${first.name}, ${factor < 10 ? factor.toFixed(1) : Math.round(factor)} times as fast as ${second.name}.`;
}

/** The values of a lane's counters; null for what its algorithm does not count. */
export function countersOf(lane: Lane | undefined, ms: number | null): Record<(typeof LANE_COUNTERS)[number]["key"], string | null> {
  const report = lane && "report" in lane ? lane.report : undefined;
  return {
    ms: ms === null ? null : `${ms.toFixed(ms < 100 ? 2 : 0)} ms`,
    tests: counted(report?.tests),
    "axis-overlaps": counted(report?.axisOverlaps),
    comparisons: counted(report?.comparisons),
    swaps: counted(report?.swaps),
    pairs: counted(report?.pairs),
  };
}

const counted = (count: number | null | undefined): string | null => (count === null || count === undefined ? null : formatCount(count));
