import type { TraceEvent } from "../algorithms/trace.js";
import type { Detection } from "./detection.js";

export const axisNames: readonly string[] = ["x", "y"];

/** Numbers as a sentence has them: no more digits than it takes. */
export function inWords(value: number): string {
  return String(Math.round(value * 10) / 10);
}

/** What is known beside the event. */
export interface Known {
  /** Rows of min corner and max corner. */
  readonly boxes: Float64Array;
  readonly names: readonly string[];
  /** Whether a swap of neighbors shows that an overlap begins or ends. Otherwise it only sorts. */
  readonly swapsTell: boolean;
  /** The axis that is swept first. */
  readonly axis: number;
}

/** The inequality that keeps two boxes apart, with its numbers: A’s right 120 < B’s left 140.5. */
export function separation({ boxes, names }: Pick<Known, "boxes" | "names">, axis: number, left: number, right: number): string {
  const [high, low] = axis === 0 ? ["right", "left"] : ["bottom", "top"];
  const max = boxes[4 * left + 2 + axis]!;
  const min = boxes[4 * right + axis]!;
  // As many digits as it takes to tell the two apart.
  const [a, b] = inWords(max) === inWords(min) ? [max, min].map(String) : [inWords(max), inWords(min)];
  return `${names[left]}’s ${high} ${a} < ${names[right]}’s ${low} ${b}`;
}

/** A detection in words, when none of its events is at work. `flagChecks` where flags take the place of tests. */
export function summary(isDetected: boolean, tick: number | undefined, balls: number, detection: Detection, names: readonly string[], flagChecks?: number): string {
  const when = tick === undefined ? "" : `Tick ${tick}: `;
  if (!isDetected) return `${when === "" ? "Nothing" : `${when}nothing`} has been tested yet.`;
  const all = (balls * (balls - 1)) / 2;
  const { counts, pairs } = detection.step;
  const found = pairs.length / 2;
  const work = flagChecks === undefined ? `${counts.tests} of ${all} pairs tested` : `${flagChecks} ${flagChecks === 1 ? "flag" : "flags"} checked, none of ${all} pairs tested`;
  const tested = `${work}, ${found} ${found === 1 ? "overlaps" : "overlap"}`;
  const missed = detection.missed.map(([a, b]) => `${names[a]} and ${names[b]}`);
  return `${when}${tested}.${missed.length > 0 ? ` Missed: ${missed.join(", ")}.` : ""}`;
}

/** One event in words. */
export function describeEvent(event: TraceEvent, known: Known): string {
  const word = (name: string): number => Number(event[name]);
  const name = (ball: number): string => known.names[ball] ?? String(ball);
  const edge = (at: number): string => (at % 2 === 0 ? `(${name(at >> 1)}` : `${name(at >> 1)})`);
  const [a, b] = [word("a"), word("b")];
  switch (event.kind) {
    case "test": {
      const [axis, left] = [word("axis"), word("left")];
      if (left === 2 ** 32 - 1) return `Test ${name(a)} and ${name(b)}: their boxes overlap.`;
      const right = left === a ? b : a;
      return `Test ${name(a)} and ${name(b)}: apart on ${axisNames[axis]}, ${separation(known, axis, left, right)}.`;
    }
    case "prune": {
      const [axis, left, right] = [word("axis"), word("left"), word("right")];
      return `Stop here for ${name(left)}: ${separation(known, axis, left, right)}, and every ball after it begins later still.`;
    }
    case "compare":
      // Quicksort also meets its own pivot.
      if (a === b) return `${edge(a)} is the pivot itself: the scan stops here.`;
      return `Compare ${edge(a)} with ${edge(b)}.`;
    case "swap":
      if (!known.swapsTell || Math.abs(word("i") - word("j")) !== 1) return `Swap ${edge(a)} and ${edge(b)}.`;
      return `Swap ${edge(a)} and ${edge(b)}: ${swapCase(a, b, name)}`;
    case "enter":
      return `The line enters ${name(word("id"))}.`;
    case "leave":
      return `The line leaves ${name(word("id"))}.`;
    case "axis overlap": {
      const on = `${name(a)} and ${name(b)} overlap on ${axisNames[word("axis")]}`;
      return word("axis") === known.axis ? `${on}: the pair gets its first flag.` : `${on}, but not on ${axisNames[known.axis]}: the pair has only one flag.`;
    }
    case "overlap":
      return `${name(a)} and ${name(b)} have both flags: their boxes overlap.`;
    default:
      return "";
  }
}

/** What a swap of neighbors means. `a` stood before `b`. */
function swapCase(a: number, b: number, name: (ball: number) => string): string {
  const pair = `${name(a >> 1)} and ${name(b >> 1)}`;
  if (a % 2 === 1 && b % 2 === 0) return `)( becomes (), ${pair} begin to overlap on this axis.`;
  if (a % 2 === 0 && b % 2 === 1) return `() becomes )(, ${pair} cease to overlap on this axis.`;
  return `${a % 2 === 0 ? "((" : "))"} stays the same: no overlap begins or ends.`;
}
