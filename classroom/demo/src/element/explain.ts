import type { Detection } from "./detection.js";
import { inWords, separation } from "./narrate.js";

/** Why a pair was tested or not, in words; and the gap to draw, if one decided. */
export interface Explanation {
  readonly text: string;
  readonly gap: { readonly axis: number; readonly left: number; readonly right: number } | undefined;
}

const NONE = 2 ** 32 - 1;
const axisNames = ["x", "y"];

/**
 * Why a detection tested two balls, or did not: told from its own trace, with the coordinates that
 * decided.
 */
export function explain(detection: Detection, names: readonly string[], a: number, b: number): Explanation {
  const known = { boxes: detection.boxes, names };
  const gapText = (axis: number, left: number, right: number): string => separation(known, axis, left, right);
  const pair = `${names[a]} and ${names[b]}`;
  const isPair = (x: unknown, y: unknown): boolean => (x === a && y === b) || (x === b && y === a);

  const test = detection.events.find(({ kind, a, b }) => kind === "test" && isPair(a, b));
  if (test) {
    const [axis, left] = [Number(test["axis"]), Number(test["left"])];
    if (left === NONE) return { text: `${pair} were tested, and their boxes overlap: ${bothOverlap(detection.boxes, names, a, b)}.`, gap: undefined };
    const right = left === a ? b : a;
    return { text: `${pair} were tested, and are apart on ${axisNames[axis]}: ${gapText(axis, left, right)}.`, gap: { axis, left, right } };
  }
  if (detection.step.pairs.some((_, i, pairs) => i % 2 === 0 && isPair(pairs[i], pairs[i + 1]))) {
    return { text: `${pair} overlap, and no test was needed: each axis says so. ${capital(bothOverlap(detection.boxes, names, a, b))}.`, gap: undefined };
  }

  const apart = [detection.step.axis, 1 - detection.step.axis].map((axis) => gapOn(detection.boxes, axis, a, b)).find((gap) => gap);
  const prune = detection.events.find(({ kind, left }) => kind === "prune" && (left === a || left === b));
  const [first, last] = prune?.["left"] === b ? [b, a] : [a, b];
  if (apart === undefined) {
    const why = prune
      ? `the scan from ${names[first]} stopped at ${names[Number(prune["right"])]}, ${gapText(Number(prune["axis"]), first, Number(prune["right"]))}, though ${names[last]} reaches back`
      : `this algorithm never tested them`;
    return { text: `${pair} overlap and were missed: ${bothOverlap(detection.boxes, names, a, b)}, but ${why}.`, gap: undefined };
  }
  if (prune && apart.left === first) {
    const at = Number(prune["right"]);
    const axis = Number(prune["axis"]);
    if (at === last) return { text: `${pair} were skipped: ${gapText(axis, first, last)}, and the scan from ${names[first]} stopped here.`, gap: { axis, left: first, right: last } };
    const begins = inWords(detection.boxes[4 * last + axis]!);
    const text = `${pair} were skipped: the scan from ${names[first]} had stopped at ${names[at]}, ${gapText(axis, first, at)}, and ${names[last]} begins later still, at ${begins}.`;
    return { text, gap: { axis, left: first, right: last } };
  }
  const { axis, left, right } = apart;
  return { text: `${pair} were never a candidate: apart on ${axisNames[axis]}, ${gapText(axis, left, right)}.`, gap: apart };
}

/** How two boxes are apart on an axis, if they are. */
export function gapOn(boxes: Float64Array, axis: number, a: number, b: number): Explanation["gap"] {
  const [min, max] = [(ball: number): number => boxes[4 * ball + axis]!, (ball: number): number => boxes[4 * ball + 2 + axis]!];
  if (max(a) < min(b)) return { axis, left: a, right: b };
  if (max(b) < min(a)) return { axis, left: b, right: a };
  return undefined;
}

/** On each axis, the one that begins later begins before the other ends. */
function bothOverlap(boxes: Float64Array, names: readonly string[], a: number, b: number): string {
  return [0, 1]
    .map((axis) => {
      const min = (ball: number): number => boxes[4 * ball + axis]!;
      const [early, late] = min(a) <= min(b) ? [a, b] : [b, a];
      const [begin, end] = axis === 0 ? ["left", "right"] : ["top", "bottom"];
      return `on ${axisNames[axis]} ${names[late]}’s ${begin} ${inWords(min(late))} ≤ ${names[early]}’s ${end} ${inWords(boxes[4 * early + 2 + axis]!)}`;
    })
    .join(", ");
}

function capital(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}

