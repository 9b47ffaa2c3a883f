import type { PlayerState } from "../algorithms/player.js";
import { Runner } from "../algorithms/runner.js";
import type { TraceEvent } from "../algorithms/trace.js";
import { type Detection, isStart, newRunner, Oracle, oracleFor, stopsOf, TracedDetection } from "./detection.js";
import type { Options } from "./options.js";
import { ProgramDetection } from "./program.js";
import type { DemoProgram, ProgramEvent } from "./types.js";
import { boxesOf, sweptBoxes, World } from "./world.js";

/** What is kept of a tick, to come back to it. */
interface Tick {
  readonly number: number;
  readonly positions: Float32Array;
  /** Where the balls were at the detection before this tick, if there was one. */
  readonly last: Float32Array | undefined;
  /** The saved moment of the world. */
  readonly moment: number;
  /** If there is a detection at this tick: the runner as it was before. */
  readonly before: Runner | undefined;
  /** How many stops there are in it. */
  stops: number;
  /** What a program did in it, or the promise of that, so that the program runs only once. */
  reported?: ReturnType<DemoProgram>;
}

/** Which of the kept ticks is shown, which of its stops has been reached, and of each tick the number of stops: 0 without a detection. */
export interface Kept {
  readonly at: number;
  readonly stop: number;
  readonly stops: readonly number[];
}

/** A kept tick, and one of its stops: -1 before the first. */
type Moment = readonly [index: number, stop: number];

export interface Progress {
  readonly at: number;
  readonly of: number;
}

export function progressOf({ at, stop, stops }: Kept): Progress {
  const sum = (counts: readonly number[]): number => counts.reduce((total, count) => total + count, 0);
  // A tick without a detection belongs to the last stop before it.
  return { at: sum(stops.slice(0, at)) + (stops[at] === 0 ? 0 : stop + 1), of: sum(stops) };
}

/** The stop before the one that is shown, if there is one. */
export function momentBefore({ at, stop, stops }: Kept): Moment | undefined {
  const isFirst = !stops.slice(0, at).some((count) => count > 0);
  if (stops[at] !== 0 && (stop > 0 || (stop === 0 && isFirst))) return [at, stop - 1];
  for (let index = at - 1; index >= 0; index--) if (stops[index] !== 0) return [index, Infinity];
  return undefined;
}

/** A stop by its index among the kept ones; 0 is the first. */
export function momentAt({ stops }: Kept, place: number): Moment {
  let left = Math.max(0, Math.trunc(place));
  let last: number | undefined;
  for (const [index, count] of stops.entries()) {
    if (count === 0) continue;
    // Between two detections there is no such thing as before the first stop.
    if (left <= count && (left > 0 || last === undefined)) return [index, left - 1];
    last = index;
    left -= count;
  }
  return [last ?? 0, Infinity];
}

/** How many ticks a demo can go back: a quarter of a minute. */
const MOST_TICKS = 900;
/** The most ticks times balls that are kept, so that many balls do not take too much memory. */
const MOST_BALL_TICKS = 90_000;
/** The number of detections to keep, if they are rarer than that. */
const LEAST_DETECTIONS = 4;

/**
 * A world and its detections as one line of time: what has been can be gone through forward and
 * back, what has not yet been is simulated when it is asked for. Within the past nothing is
 * simulated: the world is restored, and the detection is run again from the runner of that time.
 */
export class Timeline {
  readonly #world: World;
  readonly #kinds: ReadonlySet<TraceEvent["kind"]>;
  readonly #options: Options;
  readonly #most: number;
  readonly #oracle: Oracle | undefined;
  #runner: Runner;
  #ticks: Tick[] = [];
  /** Which tick is shown. */
  #at = 0;
  /** Which tick the world is in. */
  #worldAt = 0;
  #detection: Detection | undefined;
  #stops: number[] = [];
  /** Which of the stops has been reached; -1 before the first. */
  #stop = -1;
  /** Where a program has not answered yet: the tick it was asked about, and the stop to show then. What is shown until then is the detection before. */
  #awaited: { readonly tick: Tick; stop: number } | undefined;
  #settled: Promise<void> = Promise.resolve();
  #isOver = false;
  /** Called when a program has answered, with the events that are played at once, or has failed. */
  waiter: { answered(events: readonly TraceEvent[]): void; failed(error: unknown): void } | undefined;

  /** From the beginning, or in a world that is there already, at this tick. */
  constructor(options: Options, kinds: ReadonlySet<TraceEvent["kind"]>, world: World = new World(options.world), tick = 0) {
    this.#options = options;
    this.#kinds = kinds;
    this.#world = world;
    const most = Math.min(MOST_TICKS, MOST_BALL_TICKS / Math.max(1, world.radii.length));
    this.#most = Math.max(most, LEAST_DETECTIONS * (options.skip + 1));
    this.#oracle = options.program ? new Oracle(undefined) : oracleFor(options);
    this.#runner = newRunner(options.detecting);
    this.#record(tick, true);
  }

  /**
   * The state of the world after this many ticks. A method remembers no more than what its last detection found, so
   * only that one is run. A broken variant remembers more: all of its detections are run.
   */
  static at(options: Options, kinds: ReadonlySet<TraceEvent["kind"]>, ticks: number): Timeline {
    const interval = options.skip + 1;
    const { method, like } = options.detecting;
    const first = method === like ? Math.max(0, Math.ceil(ticks / interval) - 1) * interval : 0;
    const world = new World(options.world);
    for (let tick = 1; tick <= first; tick++) world.tick(tick % interval === 0);
    const timeline = new Timeline(options, kinds, world, first);
    while (timeline.tick < ticks) {
      timeline.finish();
      timeline.nextTick();
    }
    return timeline;
  }

  get tick(): number {
    return this.#ticks[this.#at]!.number;
  }

  get positions(): Float32Array {
    return this.#ticks[this.#at]!.positions;
  }

  get radii(): Float32Array {
    return this.#world.radii;
  }

  /** Whether a ball was ever put elsewhere. */
  get hasMoved(): boolean {
    return this.#world.hasMoved;
  }

  /** Where the balls were at the detection shown and at the one before it. */
  get jump(): { readonly from: Float32Array | undefined; readonly to: Float32Array } {
    let at = this.#at;
    while (at > 0 && !this.#ticks[at]!.before) at--;
    const { last, positions } = this.#ticks[at]!;
    return { from: last, to: positions };
  }

  /** The detection of this tick, or of the one before it that had one. */
  get detection(): Detection {
    return this.#detection!;
  }

  /** How many events of the detection have been played; the first is that it begins. */
  get position(): number {
    return this.#stop < 0 ? 1 : this.#stops[this.#stop]!;
  }

  /** The event at work: the one at which the detection has been stopped. */
  get event(): TraceEvent | undefined {
    if (this.#kinds.size === 0 || this.isStart) return undefined;
    const event = this.detection.events[this.position - 1];
    return event && this.#kinds.has(event.kind) ? event : undefined;
  }

  /** Whether this detection is the full sweep that a swap-driven method begins with. */
  get isStart(): boolean {
    return !this.#options.program && isStart(this.detection, this.#options.detecting);
  }

  get state(): PlayerState {
    return this.detection.stateAt(this.position);
  }

  /** The event at the next stop, and the one that follows it in the trace; the end of a detection shows none. */
  get coming(): readonly [next: TraceEvent | undefined, after: TraceEvent | undefined] {
    const position = this.#stops[this.#stop + 1];
    if (position === undefined) return [undefined, undefined];
    const [next, after] = this.detection.events.slice(position - 1, position + 1);
    return next && this.#kinds.has(next.kind) ? [next, after] : [undefined, undefined];
  }

  /** Whether the detection has been gone through, so that the world may move on. */
  get isDetected(): boolean {
    return !this.isWaiting && this.#stop === this.#stops.length - 1;
  }

  /** Whether a program has not yet answered what this detection found. */
  get isWaiting(): boolean {
    return this.#awaited !== undefined;
  }

  /** Resolves when it has, or has failed. */
  get settled(): Promise<void> {
    return this.#settled;
  }

  /** Whether it was ended: a listener may do that while time passes. */
  get isOver(): boolean {
    return this.#isOver;
  }

  /** Whether there is a detection at this very tick. */
  get hasDetection(): boolean {
    return this.#ticks[this.#at]!.before !== undefined;
  }

  /** Whether no event of the detection is worth a stop. */
  get isStopless(): boolean {
    return this.#stops.length === 1;
  }

  /** Which stop of the detection has been reached; -1 before the first. */
  get stop(): number {
    return this.#stop;
  }

  get kept(): Kept {
    return { at: this.#at, stop: this.#stop, stops: this.#ticks.map(({ stops }) => stops) };
  }

  /** Whether anything has been kept from before. */
  get hasPast(): boolean {
    return this.#at > 0 || this.#stop > -1;
  }

  /** Where it is on the way from the oldest that is kept to the newest. */
  get progress(): Progress {
    return progressOf(this.kept);
  }

  /** The state of the world here, 16 hexadecimal digits. */
  hash(): string {
    this.#bringWorld();
    return this.#world.hash();
  }

  velocities(): Float32Array {
    this.#bringWorld();
    return this.#world.velocities();
  }

  /** Plays on to the next stop of this detection; the events that were played. */
  nextStop(): readonly TraceEvent[] {
    if (this.#awaited) this.#awaited.stop = Math.max(this.#awaited.stop, 0);
    if (this.#awaited || this.isDetected) return [];
    const from = this.position;
    this.#stop++;
    return this.detection.events.slice(from, this.position);
  }

  /** To the end of this detection, at once. */
  finish(): void {
    this.showStop(Infinity);
  }

  /** To a stop of this detection; beyond the last, to that one. */
  showStop(stop: number): void {
    if (this.#awaited) this.#awaited.stop = stop;
    else this.#stop = Math.min(stop, this.#stops.length - 1);
  }

  /** Back to before the first event of this detection. */
  rewind(): void {
    this.showStop(-1);
  }

  /** Moves on by a tick, in the past or beyond it. Whether it was beyond, so that it is new. */
  nextTick(): boolean {
    if (this.#at < this.#ticks.length - 1) {
      this.goTo(this.#at + 1, -1);
      return false;
    }
    this.#bringWorld();
    const number = this.tick + 1;
    const isLast = number % (this.#options.skip + 1) === 0;
    this.#world.tick(isLast);
    this.#record(number, isLast);
    return true;
  }

  /** The stop before this one, in this detection or one before, if there is one. */
  back(): void {
    const moment = momentBefore(this.kept);
    if (moment) this.goTo(...moment);
  }

  /** Goes to a stop by its index among the kept ones; 0 is the first. */
  seek(place: number): void {
    this.goTo(...momentAt(this.kept, place));
  }

  /** Shows a tick that is kept, at one of its stops; beyond the last, at that one. */
  goTo(index: number, stop: number): void {
    const tick = this.#ticks[index]!;
    if (tick.before && index !== this.#at) {
      const runner = new Runner(tick.before);
      this.#detect(runner, tick);
      runner.free();
    }
    this.#at = index;
    if (tick.before) this.showStop(stop);
  }

  /** Puts a ball elsewhere, here and now: what was to come is forgotten. */
  placeBall(ball: number, x: number, y: number, vx: number, vy: number): void {
    this.#bringWorld();
    this.#truncate();
    this.#world.place(ball, x, y, vx, vy);
  }

  /** Runs the detection again at this tick, to show a change in a world that does not move. */
  detectAgain(): void {
    this.#record(this.tick, true);
    this.finish();
  }

  /** Ends this line of time, and hands over the world as it is shown. */
  release(): World {
    this.#bringWorld();
    this.#isOver = true;
    this.#awaited = undefined;
    for (const tick of this.#ticks) this.#forget(tick);
    this.#detection?.free();
    this.#runner.free();
    this.#oracle?.free();
    return this.#world;
  }

  free(): void {
    this.release().free();
  }

  #record(number: number, isDetecting: boolean): void {
    const positions = this.#world.positions();
    const last = this.#ticks.length > 0 ? this.jump.to : undefined;
    let before: Runner | undefined;
    if (isDetecting) {
      this.#runner.trimTrace();
      before = new Runner(this.#runner);
    }
    const tick: Tick = { number, positions, last, moment: this.#world.save(), before, stops: 0 };
    if (isDetecting) this.#detect(this.#runner, tick);
    this.#ticks.push(tick);
    if (this.#ticks.length > this.#most) this.#forget(this.#ticks.shift()!);
    this.#at = this.#worldAt = this.#ticks.length - 1;
  }

  #detect(runner: Runner, tick: Tick): void {
    const { program } = this.#options;
    const boxes = this.#boxesAt(tick);
    const missedOf = (found: Uint32Array): Detection["missed"] => this.#missedAt(tick, found);
    this.#awaited = undefined;
    if (!program) return this.#show(new TracedDetection(runner, boxes, missedOf), tick);
    const detectionOf = (events: readonly ProgramEvent[]): Detection => new ProgramDetection(events, boxes, missedOf);
    try {
      tick.reported ??= program(boxes, tick.last && this.#boxes(tick.last));
      if (Array.isArray(tick.reported)) return this.#show(detectionOf(tick.reported), tick);
    } catch (error) {
      // Told like a rejection, when nothing is in the middle of a tick any more.
      tick.reported = Promise.reject(error);
    }
    if (!this.#detection) this.#show(new ProgramDetection([], boxes, () => []), tick);
    tick.stops = 1;
    const awaited = { tick, stop: -1 };
    this.#awaited = awaited;
    // Meanwhile another tick may be shown, or another program asked.
    const isAwaited = (): boolean => this.#awaited === awaited;
    this.#settled = Promise.resolve(tick.reported)
      .then((events) => {
        tick.reported = events;
        if (!isAwaited()) return;
        const detection = detectionOf(events);
        this.#awaited = undefined;
        this.#show(detection, tick);
        this.showStop(this.isStopless ? 0 : awaited.stop);
        this.waiter?.answered(this.detection.events.slice(1, this.position));
      })
      .catch((error: unknown) => {
        if (isAwaited()) this.waiter?.failed(error);
      });
  }

  #show(detection: Detection, tick: Tick): void {
    this.#detection?.free();
    this.#detection = detection;
    this.#stops = stopsOf(detection, this.#kinds, this.isStart);
    this.#stop = -1;
    tick.stops = this.#stops.length;
  }

  #boxes(positions: Float32Array): Float64Array {
    return boxesOf(positions, this.radii, this.#options.world);
  }

  /** What a detection takes. */
  #boxesAt({ positions, last }: Pick<Tick, "positions" | "last">): Float64Array {
    const boxes = this.#boxes(positions);
    return this.#options.swept === "on" && last ? sweptBoxes(this.#boxes(last), boxes) : boxes;
  }

  /** What it should have found and did not. */
  #missedAt({ positions, last }: Pick<Tick, "positions" | "last">, found: Uint32Array): Detection["missed"] {
    const oracle = this.#oracle;
    const boxes = this.#boxes(positions);
    if (!oracle || this.#options.swept !== "off") return oracle?.missed(boxes, found) ?? [];
    if (!last) return [];
    // What overlapped at the last detection was found there.
    const before = this.#boxes(last);
    return oracle.missed(sweptBoxes(before, boxes), found, oracle.pairs(before));
  }

  /** Brings the world to the tick that is shown. */
  #bringWorld(): void {
    if (this.#worldAt === this.#at) return;
    this.#world.restore(this.#ticks[this.#at]!.moment);
    this.#worldAt = this.#at;
  }

  /** Forgets all that comes after the tick that is shown. */
  #truncate(): void {
    const later = this.#ticks.splice(this.#at + 1);
    if (later.length === 0) return;
    // The runner has to be as it was after the last detection up to here.
    const before = this.#ticks.filter(({ before }) => before).at(-1)!;
    this.#runner.free();
    this.#runner = new Runner(before.before!);
    this.#runner.step(this.#boxesAt(before));
    for (const tick of later) this.#forget(tick);
  }

  #forget({ moment, before }: Tick): void {
    this.#world.forget(moment);
    before?.free();
  }
}
