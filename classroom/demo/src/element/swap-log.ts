import type { Detection } from "./detection.js";
import { axisNames } from "./narrate.js";

/** How long a swap is flashed, in milliseconds. */
export const FLASH_MS = 900;
/** How many of the last changes are listed. */
const LINES = 3;

/** What the swaps have shown since a ball was taken: how many there were, and which overlaps on one axis began and ended. */
export class SwapLog {
  swaps = 0;
  begun = 0;
  ended = 0;
  /** The last changes in words, the latest first. */
  lines: readonly string[] = [];
  /** Until when each edge is flashed. */
  readonly #until = new Map<number, number>();

  /** Another drag begins. */
  restart(): void {
    this.swaps = this.begun = this.ended = 0;
    this.lines = [];
  }

  /** Adds what a detection did. Whether it swapped anything. */
  add(detection: Detection, names: readonly string[], focus: number | undefined, now: number): boolean {
    const { swaps } = this;
    for (const { kind, a, b, axis } of detection.events) {
      if (kind === "swap") {
        this.swaps++;
        for (const edge of [a, b]) this.#until.set(Number(edge), now + FLASH_MS);
      } else if (kind === "axis overlap" || kind === "axis apart") {
        const [first, second] = (b === focus ? [b, a] : [a, b]).map((ball) => names[Number(ball)]);
        const begins = kind === "axis overlap";
        if (begins) this.begun++;
        else this.ended++;
        this.lines = [`${first} ${begins ? "begins" : "ceases"} to overlap ${second} on ${axisNames[Number(axis)]}`, ...this.lines].slice(0, LINES);
      }
    }
    return this.swaps > swaps;
  }

  /** The edges that are flashed now. */
  flashing(now: number): ReadonlySet<number> {
    return new Set([...this.#until].flatMap(([edge, until]) => (until > now ? [edge] : [])));
  }
}
