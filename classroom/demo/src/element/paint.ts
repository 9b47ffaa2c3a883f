import type { TraceEvent } from "../algorithms/trace.js";
import type { Canvases } from "./canvas.js";
import { hasFlags } from "./detection.js";
import { drawScene } from "./draw.js";
import { arrayHeight, drawArray } from "./draw-array.js";
import type { Explanation } from "./explain.js";
import { type Options, WIDTH } from "./options.js";
import type { Theme } from "./theme.js";
import type { Timeline } from "./timeline.js";

/** What is to be painted. */
interface Painting {
  readonly timeline: Timeline;
  readonly options: Options;
  readonly names: readonly string[];
  /** The balls to be marked. */
  readonly marked: readonly number[];
  /** What stands out in the array in place of the last event, if a question is about it. */
  readonly asked: TraceEvent | undefined;
  /** The color of what is to stand out. */
  readonly emphasis: string | undefined;
  readonly explanation: Explanation | undefined;
  /** Where the sweep line is, if it is anywhere. */
  readonly lineAt: number | undefined;
  readonly theme: Theme;
  /** Whether what a scan finds is not to be seen yet. */
  readonly isScanHidden: boolean;
  /** The edges whose swap is flashed. */
  readonly flashing: ReadonlySet<number>;
}

const nothingMoved: ReadonlySet<number> = new Set();

/** Paints the balls, and the array where there is a canvas for it. */
export function paint(root: ParentNode, canvases: Canvases, painting: Painting): void {
  const { timeline, options, names, explanation, theme } = painting;
  const { state, event, detection, positions, radii, jump } = timeline;
  const ofFocus = focusLine(painting);
  const { isScanHidden, flashing } = painting;
  const common = { state, event, chosen: painting.marked, options, isScanHidden, flashing };
  const picture = canvases.open(root.querySelector(".picture canvas"), WIDTH);
  if (picture) {
    const labels = options.labels === undefined && !options.explains && !options.predicts ? [] : names;
    const lineAt = options.decorations.sweep && (ofFocus?.at ?? painting.lineAt);
    const touched = ofFocus?.touched ?? state.active;
    const { axis } = detection.step;
    const missed = timeline.isDetected && !isScanHidden ? detection.missed : [];
    drawScene(picture.context, { ...common, positions, radii, jump, labels, lineAt, touched, axis, missed, gap: explanation?.gap, emphasis: painting.emphasis }, theme);
  }
  const array = options.decorations.array && canvases.open(root.querySelector("canvas.array"));
  if (array) {
    const moved = timeline.isDetected && options.decorations.array?.isSortShown ? detection.swapped : nothingMoved;
    drawArray(array.context, array.width, { ...common, event: painting.asked ?? event, labels: names, moved, lineEdge: ofFocus?.edge ?? state.line?.edge }, theme);
  }
}

/** The right edge of the ball in focus, where it takes the place of a sweep line: in a demo that lists swaps. */
function focusLine({ timeline, options }: Painting): { at: number; edge: number; touched: number[] } | undefined {
  const { focus, hasSwapLog } = options;
  if (!hasSwapLog || focus === undefined) return undefined;
  const { boxes, step } = timeline.detection;
  const [min, max] = [(ball: number): number => boxes[4 * ball + step.axis]!, (ball: number): number => boxes[4 * ball + 2 + step.axis]!];
  const at = max(focus);
  const touched = [...timeline.radii.keys()].filter((ball) => ball !== focus && min(ball) <= at && at <= max(ball));
  return { at, edge: 2 * focus + 1, touched };
}

/** How high the canvas of the array has to be, in CSS pixels. */
export function heightOfArray({ detecting }: Options, balls: number): number {
  return arrayHeight(2 * balls, hasFlags(detecting) ? 2 : 1);
}
