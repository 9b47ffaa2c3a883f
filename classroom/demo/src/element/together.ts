import type { TraceEvent } from "../algorithms/trace.js";
import { MS_PER_TICK } from "./playback.js";
import type { Run } from "./run.js";
import { type Kept, momentAt, momentBefore, type Progress, progressOf, type Timeline } from "./timeline.js";

/** A demo that shows the same world as others. */
export interface Member {
  /** Until it has begun there is none. */
  readonly run: Run | undefined;
  /** Whether it plays: all do, until one is paused. */
  readonly isPlaying: boolean;
  /** Whether a hand holds one of its balls. */
  readonly isHeld: boolean;
  /** Lets time pass within the detection. */
  advance(ms: number): void;
  /** Puts the ball that is held where the hand is. */
  hold(): void;
  /** One tick of the world. */
  tick(): void;
  /** Events of its detection were played. */
  stopped(events: readonly TraceEvent[]): void;
  setPlaying(isPlaying: boolean): void;
  /** Starts over; plays then, if asked. */
  begin(isPlaying: boolean): void;
  /** Shows what has changed. */
  show(): void;
}

/**
 * The same world several times, each under another method, at the same tick: the world moves on when the slowest
 * detection is done. Their kept ticks are the same, but a detection has other stops in each, so the k-th stop of
 * all is the k-th of each, or its last.
 */
export class Together {
  readonly #members: () => readonly Member[];
  #spent = 0;

  constructor(members: () => readonly Member[]) {
    this.#members = members;
  }

  /** Whether every detection of this tick has been gone through. */
  get isDetected(): boolean {
    return this.#timelines.every(({ isDetected }) => isDetected);
  }

  get tick(): number {
    return this.#timelines[0]?.tick ?? 0;
  }

  get hasPast(): boolean {
    return this.#timelines.some(({ hasPast }) => hasPast);
  }

  /** Where it is on the way from the oldest stop that is kept to the newest. */
  get progress(): Progress {
    return progressOf(this.#kept);
  }

  /** Lets so much time pass. */
  advance(ms: number): void {
    const members = this.#members();
    for (const member of members) if (!member.run?.timeline.isDetected || member.isHeld) member.advance(ms);
    if (!this.isDetected) return;
    this.#spent = Math.min(this.#spent + ms, 4 * MS_PER_TICK);
    // A listener may pause them.
    while (this.#spent >= MS_PER_TICK && this.isDetected && members.some(({ isPlaying }) => isPlaying)) {
      this.#spent -= MS_PER_TICK;
      this.#tickAll();
    }
    if (!this.isDetected) this.#spent = 0;
  }

  /** To the next stop of each detection; after the last of all, to the next detection. */
  step(): void {
    if (this.isDetected) {
      do this.#tickAll();
      while (this.#timelines[0]?.hasDetection === false);
    }
    for (const member of this.#members()) member.stopped(member.run!.timeline.nextStop());
  }

  back(): void {
    const moment = momentBefore(this.#kept);
    if (moment) this.#goTo(...moment);
  }

  /** Goes to a stop by its index among the kept ones; 0 is the first. */
  seek(place: number): void {
    this.#goTo(...momentAt(this.#kept, place));
  }

  /** Puts a ball elsewhere in every copy of the world. */
  placeBall(ball: number, x: number, y: number, vx: number, vy: number): void {
    for (const timeline of this.#timelines) timeline.placeBall(ball, x, y, vx, vy);
  }

  detectAgain(): void {
    for (const timeline of this.#timelines) timeline.detectAgain();
  }

  get #timelines(): Timeline[] {
    return this.#members().flatMap(({ run }) => (run ? [run.timeline] : []));
  }

  /** The kept ticks, each with the most stops of any of its detections, and the stop that the furthest has reached. */
  get #kept(): Kept {
    const all = this.#timelines.map(({ kept }) => kept);
    const { at, stops } = all[0] ?? { at: 0, stops: [] };
    return { at, stop: Math.max(-1, ...all.map(({ stop }) => stop)), stops: stops.map((_, index) => Math.max(...all.map(({ stops }) => stops[index] ?? 0))) };
  }

  #goTo(index: number, stop: number): void {
    for (const timeline of this.#timelines) timeline.goTo(index, stop);
  }

  /** First the hand, in every copy of the world; then one tick of each. */
  #tickAll(): void {
    for (const member of this.#members()) member.hold();
    for (const member of this.#members()) member.tick();
  }
}
