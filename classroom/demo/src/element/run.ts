import type { TraceEvent } from "../algorithms/trace.js";
import type { DemoEvent, DemoState, Row } from "./types.js";
import { areDetectionsKept, hasFlags, shownKinds } from "./detection.js";
import { explain, type Explanation } from "./explain.js";
import { namesOf } from "./names.js";
import { describeEvent, type Known, summary } from "./narrate.js";
import { asksOfScan, isWorldKept, type Options, WIDTH } from "./options.js";
import { type Listener, Playback } from "./playback.js";
import { type Question, questionAt, questionsOfScan } from "./predict.js";
import { Timeline } from "./timeline.js";
import { demoEventOf } from "./report.js";
import { rowsOf } from "./world.js";

/** What a demo counts. */
export type Counts = Omit<DemoState, "tick" | "events" | "hash">;

export const NOTHING_COUNTED: Counts = { tests: 0, flagChecks: 0, axisOverlaps: 0, pairs: 0, comparisons: 0, swaps: 0 };

const START = "Once, at the start, one full sweep finds all overlaps.";

/** A world and its detections, as the attributes ask for them, and what can be said of where it stands. */
export class Run {
  readonly options: Options;
  readonly timeline: Timeline;
  readonly playback: Playback;
  /** What the balls are called. */
  readonly names: readonly string[];
  /** How many questions about a scan have been answered. */
  #answered = 0;

  private constructor(options: Options, timeline: Timeline) {
    this.options = options;
    this.timeline = timeline;
    this.playback = new Playback(timeline, options);
    this.names = namesOf(options.labels, timeline.radii.length);
  }

  /** A separate world, after this many ticks. */
  static begin(options: Options, ticks: number): Run {
    return new Run(options, Timeline.at(options, shownKinds(options.decorations, options.detecting), ticks));
  }

  /** Shows the same detections, at the same stop, under other options, if they change nothing but looks. */
  shownUnder(options: Options): Run | undefined {
    if (!isWorldKept(this.options, options) || !areDetectionsKept(this.options, options)) return undefined;
    const run = new Run(options, this.timeline);
    run.#answered = this.#answered;
    return run;
  }

  /** Goes on in the same world under other options, if they leave it as it was. This run is then over. */
  goOn(options: Options): Run | undefined {
    if (!isWorldKept(this.options, options)) return undefined;
    const { tick } = this.timeline;
    const kinds = shownKinds(options.decorations, options.detecting);
    return new Run(options, new Timeline(options, kinds, this.timeline.release(), tick));
  }

  free(): void {
    this.timeline.free();
  }

  /** Plays on to the next tick that has a detection. */
  nextDetection(listener: Listener): void {
    do this.playback.tick(listener);
    while (!this.timeline.isOver && !this.timeline.hasDetection);
  }

  get state(): DemoState {
    const { tick, position } = this.timeline;
    return { tick, events: position, ...this.counts, hash: this.timeline.hash() };
  }

  get counts(): Counts {
    if (this.isScanHidden) return NOTHING_COUNTED;
    const { axisOverlaps, counts } = this.timeline.state;
    const { tests, pairs, comparisons, swaps } = counts;
    // The overlaps are those that there are: also where the algorithm keeps them and tells only of changes.
    return { tests, flagChecks: this.#flagChecks ?? 0, axisOverlaps: axisOverlaps.length, pairs, comparisons, swaps };
  }

  /** Undefined where there are tests. */
  get #flagChecks(): number | undefined {
    const { detection, position } = this.timeline;
    return hasFlags(this.options.detecting) ? detection.flagChecksAt(position) : undefined;
  }

  get event(): DemoEvent | undefined {
    const { event, position } = this.timeline;
    if (this.timeline.isStart && this.timeline.isDetected) return { kind: "start", a: 0, b: 0, index: 0 };
    return event && demoEventOf(event, position - 1);
  }

  get pairs(): [number, number][] {
    if (this.isScanHidden) return [];
    const { overlaps } = this.timeline.state;
    return Array.from({ length: overlaps.length / 2 }, (_, i) => [overlaps[2 * i]!, overlaps[2 * i + 1]!]);
  }

  /** The balls where they are, without their velocities. */
  get balls(): Row[] {
    return rowsOf(this.timeline.positions, this.timeline.radii);
  }

  /** The balls, rounded: to begin with elsewhere. With their velocities, if the world moves. */
  rows(): number[][] {
    const { isStatic, world } = this.options;
    const velocities = isStatic ? [] : [...this.timeline.velocities()];
    return this.balls.map((row, ball) => {
      const [x, y, radius, ...velocity] = [...row, ...velocities.slice(2 * ball, 2 * ball + 2)].map((value) => Math.round(100 * value!)) as [number, number, number];
      // At a wall it is a little smaller: rounded, it might end outside.
      const inside = Math.min(radius, x - 1, y - 1, 100 * WIDTH - x - 1, 100 * world.height - y - 1);
      return [x, y, inside, ...velocity].map((value) => value / 100);
    });
  }

  /** Where a ball is. */
  placeOf(ball: number): { x: number; y: number } {
    const { positions } = this.timeline;
    return { x: positions[2 * ball]!, y: positions[2 * ball + 1]! };
  }

  explain(pair: readonly [number, number]): Explanation {
    return explain(this.timeline.detection, this.names, ...pair);
  }

  /** What a visitor is to guess before more is shown, if that is asked for. */
  get question(): Question | undefined {
    const { timeline, options } = this;
    if (!options.predicts) return undefined;
    return asksOfScan(options) ? questionsOfScan(timeline, options.detecting.focus, this.#known)[this.#answered] : questionAt(timeline, this.#known);
  }

  /** The comparison or swap that the question is about: what comes next in the array. */
  get asked(): TraceEvent | undefined {
    const [next] = this.timeline.coming;
    return (next?.kind === "compare" || next?.kind === "swap") && this.question ? next : undefined;
  }

  /** Shows what the question was about; the events that were played. */
  answer(): readonly TraceEvent[] {
    if (!asksOfScan(this.options)) return this.timeline.nextStop();
    this.#answered++;
    return [];
  }

  /** Whether there is still something to guess about a scan, and so nothing that it did is shown. */
  get isScanHidden(): boolean {
    return asksOfScan(this.options) && this.question !== undefined;
  }

  get #known(): Known {
    const { detection } = this.timeline;
    return { boxes: detection.boxes, names: this.names, axis: detection.step.axis, swapsTell: detection.isDrivenBySwaps };
  }

  /** Where it stands, in words. */
  get sentence(): string {
    const { timeline } = this;
    const { event, detection, tick, isDetected, radii } = timeline;
    if (event) return describeEvent(event, this.#known);
    const when = this.options.isStatic ? undefined : tick;
    if (timeline.isStart && isDetected) return START;
    return summary(isDetected && !this.isScanHidden, when, radii.length, detection, this.names, this.#flagChecks);
  }
}
