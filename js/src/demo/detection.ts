import { Player, type PlayerState } from "../player.js";
import { Runner, type Step } from "../runner.js";
import { events, type TraceEvent } from "../trace.js";
import type { Decorations } from "./decorations.js";
import type { Detecting } from "./options.js";

/** What one run of an algorithm did, event by event: the compiled algorithm's own trace. */
export class Detection {
  /** The boxes it ran over: rows of least and greatest corner. */
  readonly boxes: Float64Array;
  readonly step: Step;
  /** Its events, the first the beginning of the step. */
  readonly events: readonly TraceEvent[];
  /** Whether the trace was too long to be recorded in full: it then cannot be gone through. */
  readonly isTruncated: boolean;
  readonly #player: Player;
  /** Events of the trace before the first of this step. */
  readonly #before: number;

  /** Runs one step of `runner`, whose trace is trimmed. */
  constructor(runner: Runner, boxes: Float64Array) {
    this.boxes = boxes;
    this.#before = runner.trimTrace();
    this.step = runner.step(boxes);
    this.isTruncated = runner.isTruncated;
    this.#player = new Player(runner);
    this.events = [...events(this.#player.words)].slice(this.#before);
  }

  /** What is to be drawn when so many of its events have been played. */
  stateAt(position: number): PlayerState {
    this.#player.seek(this.#before + position);
    return this.#player.state();
  }

  free(): void {
    this.#player.free();
  }
}

/** A runner for what the attributes ask for. */
export function newRunner(detecting: Detecting): Runner {
  return new Runner({ dimensions: 2, ...detecting, persistent: true, traceWords: 1 << 22 });
}

/** Which kinds of events are worth a stop. */
export function shownKinds({ checks, sweep, array }: Decorations, hasTests: boolean): Set<TraceEvent["kind"]> {
  const kinds = new Set<TraceEvent["kind"]>();
  if (checks) kinds.add(hasTests ? "test" : "overlap").add("prune");
  if (sweep) kinds.add("enter").add("leave");
  if (array?.isSortShown) kinds.add("compare").add("swap");
  return kinds;
}

/** The positions at which to stop: after each event of these kinds, and at the end. */
export function stopsOf(detection: Detection, kinds: ReadonlySet<TraceEvent["kind"]>): number[] {
  const stops: number[] = [];
  if (!detection.isTruncated && kinds.size > 0) {
    detection.events.forEach(({ kind }, index) => kinds.has(kind) && stops.push(index + 1));
  }
  const end = detection.events.length;
  if (stops.at(-1) !== end) stops.push(end);
  return stops;
}
