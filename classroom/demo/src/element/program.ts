import type { Place, PlayerState } from "../algorithms/player.js";
import type { Step } from "../algorithms/runner.js";
import type { TraceEvent } from "../algorithms/trace.js";
import type { Detection } from "./detection.js";
import { gapOn } from "./explain.js";
import type { ProgramEvent } from "./types.js";

const NONE = 2 ** 32 - 1;

/** What one run of a program from outside did, in the place of a compiled algorithm. */
export class ProgramDetection implements Detection {
  readonly boxes: Float64Array;
  readonly step: Step;
  readonly events: readonly TraceEvent[];
  readonly missed: Detection["missed"];
  readonly swapped: ReadonlySet<number>;
  readonly isTruncated = false;
  readonly isDrivenBySwaps = false;
  /** After each event. */
  readonly #states: PlayerState[];

  /** From what the program reported about these boxes. */
  constructor(reported: readonly ProgramEvent[], boxes: Float64Array, missedOf: (found: Uint32Array) => Detection["missed"]) {
    this.boxes = boxes;
    this.events = [{ kind: "step", axis: 0, keeps: 0 }, ...reported.map((event) => traced(event, boxes))];
    this.#states = statesOf(this.events, boxes);
    const { overlaps, counts } = this.#states.at(-1)!;
    const none = new Uint32Array(0);
    this.step = { pairs: Uint32Array.from(overlaps), begun: none, ended: none, axis: 0, counts, bytes: 0 };
    this.missed = missedOf(this.step.pairs);
    this.swapped = new Set(this.events.flatMap(({ kind, a, b }) => (kind === "swap" ? [Number(a), Number(b)] : [])));
  }

  get length(): number {
    return this.events.length;
  }

  flagChecksAt(position: number): number {
    return this.stateAt(position).counts.axisOverlaps;
  }

  stateAt(position: number): PlayerState {
    return this.#states[Math.max(0, position - 1)]!;
  }

  free(): void {
    // It holds no memory of the compiled module.
  }
}

/** The event with the words that a compiled algorithm would give it; the edges of a swap are filled in later. */
function traced(event: ProgramEvent, boxes: Float64Array): TraceEvent {
  if (event.kind === "test") {
    const gap = gapOn(boxes, 0, event.a, event.b) ?? gapOn(boxes, 1, event.a, event.b);
    return { ...event, axis: gap?.axis ?? NONE, left: gap?.left ?? NONE } as TraceEvent;
  }
  if (event.kind === "array") return { kind: "array", axis: event.axis, edges: event.edges.join(" ") };
  return { ...event } as TraceEvent;
}

/** What is to be drawn after each of the events, all of which are gone through once. */
function statesOf(events: readonly TraceEvent[], boxes: Float64Array): PlayerState[] {
  const counts = { comparisons: 0, swaps: 0, tests: 0, axisOverlaps: 0, axisEnds: 0, pairs: 0, begun: 0, ended: 0, active: 0, maxActive: 0 };
  const arrays: Place[][] = [];
  const overlaps: number[] = [];
  const axisOverlaps: PlayerState["axisOverlaps"] = [];
  let arrayAxis = 0;
  return events.map((event) => {
    const [a, b] = [Number(event["a"]), Number(event["b"])];
    switch (event.kind) {
      case "array":
        arrayAxis = Number(event["axis"]);
        arrays[arrayAxis] = String(event["edges"]).split(" ").map((text) => {
          const edge = Number(text);
          return { edge, at: boxes[4 * (edge >> 1) + 2 * (edge & 1) + arrayAxis] ?? 0 };
        });
        break;
      case "compare":
        counts.comparisons++;
        break;
      case "swap": {
        counts.swaps++;
        const [i, j] = [Number(event["i"]), Number(event["j"])];
        const array = [...(arrays[arrayAxis] ?? [])];
        event["a"] = array[i]?.edge ?? 0;
        event["b"] = array[j]?.edge ?? 0;
        [array[i], array[j]] = [array[j]!, array[i]!];
        arrays[arrayAxis] = array;
        break;
      }
      case "test":
        counts.tests++;
        break;
      case "axis overlap":
        counts.axisOverlaps++;
        axisOverlaps.push({ axis: Number(event["axis"]), a, b });
        break;
      case "overlap":
        counts.pairs++;
        overlaps.push(a, b);
        break;
    }
    return {
      axis: 0,
      arrayAxis,
      arrays: [...arrays],
      line: undefined,
      active: [],
      axisOverlaps: [...axisOverlaps],
      overlaps: [...overlaps],
      held: [],
      counts: { ...counts },
    };
  });
}
