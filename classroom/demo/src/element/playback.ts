import type { TraceEvent } from "../algorithms/trace.js";
import type { Options } from "./options.js";
import type { Timeline } from "./timeline.js";

export const MS_PER_TICK: number = 1000 / 60;
/** How long each event of a sort stays highlighted. */
const SORT_MS = 90;
/** How fast the sweep line goes, in units of the world a millisecond. */
const LINE_SPEED = 0.35;
/** Stops and ticks in one frame, at most: a great speed is no reason to stall. */
const MOST_AT_ONCE = 400;
/** Milliseconds of script in one frame, at most. */
const MOST_MS = 6;

/** What is told while time passes. */
export interface Listener {
  stopped(events: readonly TraceEvent[]): void;
  /** Whether it still plays: what is told may pause it. */
  isPlaying(): boolean;
  /** Whether a hand holds a ball: then the world does not wait for what would be shown. */
  isHeld(): boolean;
  /** Before a tick: the last chance to put balls elsewhere. */
  ticking(): void;
  ticked(): void;
}

/** Turns time into stops and ticks: a world waits while an event is highlighted. */
export class Playback {
  readonly #timeline: Timeline;
  readonly #options: Options;
  /** Milliseconds spent at the stop, or since the last tick. */
  #spent = 0;

  constructor(timeline: Timeline, options: Options) {
    this.#timeline = timeline;
    this.#options = options;
  }

  /** Sets the counters to zero. */
  restart(): void {
    this.#spent = 0;
  }

  /**
   * Lets so much time pass. Whether there is more to come. Without `mayTick` the world waits at the end of the
   * detection.
   */
  advance(ms: number, listener: Listener, mayTick = true): boolean {
    const timeline = this.#timeline;
    const began = performance.now();
    this.#spent += ms;
    if (listener.isHeld()) timeline.finish();
    for (let count = 0; count < MOST_AT_ONCE && !timeline.isWaiting; count++) {
      const isDetected = timeline.isDetected;
      if (isDetected && !mayTick) break;
      if (isDetected && this.#options.isStatic) return false;
      const needed = isDetected ? MS_PER_TICK : this.#duration();
      if (this.#spent < needed) return true;
      if (performance.now() - began > MOST_MS) break;
      this.#spent -= needed;
      if (isDetected) this.tick(listener);
      else listener.stopped(timeline.nextStop());
      if (timeline.isOver || !listener.isPlaying()) return true;
    }
    // What there was no time for is left out.
    this.#spent = 0;
    return true;
  }

  /** One tick, and if there is a detection of which nothing is shown, all of it. */
  tick(listener: Listener): void {
    listener.ticking();
    this.tickFreely(listener);
  }

  /** As `tick`, where balls that are held have been put in their places. */
  tickFreely(listener: Listener): void {
    this.#timeline.nextTick();
    if (this.#timeline.isStopless && !this.#timeline.isWaiting) this.#timeline.finish();
    listener.ticked();
  }

  /** Where the sweep line is, if it is anywhere; between two stops while it plays. */
  lineAt(isPlaying: boolean): number | undefined {
    const { state, event } = this.#timeline;
    if (this.#timeline.isDetected || !state.line) return undefined;
    const { from, to, ms } = this.#line();
    const isMoving = isPlaying && ms > 0 && isOfLine(event);
    return from + (to - from) * (isMoving ? Math.min(1, this.#spent / ms) : 0);
  }

  /** How long the stop at work lasts. */
  #duration(): number {
    const { event } = this.#timeline;
    if (isOfLine(event)) return this.#line().ms;
    if (event?.kind === "test" || event?.kind === "overlap" || event?.kind === "axis overlap") return this.#options.decorations.checks?.ms ?? 0;
    if (event?.kind === "compare" || event?.kind === "swap") return SORT_MS;
    return 0;
  }

  /** Where the line stands, where it goes, and how long that takes. */
  #line(): { from: number; to: number; ms: number } {
    const { state, detection, position } = this.#timeline;
    const array = state.arrays[state.arrayAxis] ?? [];
    const from = state.line ? (array[state.line.position]?.at ?? 0) : 0;
    const next = detection.events.slice(position).find(({ kind }) => kind === "visit");
    const to = next ? (array[Number(next["position"])]?.at ?? from) : from;
    return { from, to: Math.max(from, to), ms: Math.max(0, to - from) / LINE_SPEED };
  }
}

function isOfLine(event: TraceEvent | undefined): boolean {
  return event?.kind === "enter" || event?.kind === "leave";
}
