// Boxes that drift about a rectangle and bounce off its walls: what the sweep works on. Which of them
// overlap is not known here; the compiled library finds that.

import { randomFrom } from "../random.ts";

/** Together, the boxes cover this share of the world. */
const COVERED = 0.13;
/** Units a second; the world is 100 high. */
const SPEED = 7;
/** A box that was thrown slows down to this. */
const FASTEST = 60;
const FRICTION = 0.4;

export const WORLD_HEIGHT = 100;

export class MovingBoxes {
  /** Rows of min corner and max corner: what a runner takes. */
  readonly rows: Float64Array;
  readonly #velocities: Float64Array;
  #width: number;
  /** The box that a hand holds: it does not move by itself. */
  held: number | undefined;

  constructor(readonly count: number, seed: number, width: number) {
    this.#width = width;
    this.rows = new Float64Array(4 * count);
    this.#velocities = new Float64Array(2 * count);
    const random = randomFrom(seed);
    const side = Math.sqrt((COVERED * width * WORLD_HEIGHT) / count);
    for (let box = 0; box < count; box++) {
      const [wide, high] = [side * (0.45 + 1.1 * random()), side * (0.45 + 1.1 * random())];
      this.#put(box, random() * (width - wide), random() * (WORLD_HEIGHT - high), wide, high);
      const [angle, speed] = [2 * Math.PI * random(), SPEED * (0.3 + random())];
      this.#velocities.set([speed * Math.cos(angle), speed * Math.sin(angle)], 2 * box);
    }
  }

  get width(): number {
    return this.#width;
  }

  /** Another width of the same world: places on x change in proportion. */
  resize(width: number): void {
    const factor = width / this.#width;
    this.#width = width;
    for (let box = 0; box < this.count; box++) {
      const [x, y, wide, high] = this.#box(box);
      this.#put(box, x * factor, y, wide, high);
    }
  }

  advance(seconds: number): void {
    const velocities = this.#velocities;
    for (let box = 0; box < this.count; box++) {
      if (box === this.held) continue;
      const [x, y, wide, high] = this.#box(box);
      const [vx, vy] = [velocities[2 * box]!, velocities[2 * box + 1]!];
      const [nextX, nextY] = [x + vx * seconds, y + vy * seconds];
      if (nextX < 0 || nextX > this.#width - wide) velocities[2 * box] = nextX < 0 ? Math.abs(vx) : -Math.abs(vx);
      if (nextY < 0 || nextY > WORLD_HEIGHT - high) velocities[2 * box + 1] = nextY < 0 ? Math.abs(vy) : -Math.abs(vy);
      if (Math.hypot(vx, vy) > 2 * SPEED) {
        velocities[2 * box]! *= 1 - FRICTION * seconds;
        velocities[2 * box + 1]! *= 1 - FRICTION * seconds;
      }
      this.#put(box, nextX, nextY, wide, high);
    }
  }

  /** The topmost box at a point, or the nearest within `reach`. */
  boxAt(x: number, y: number, reach: number): number | undefined {
    let [nearest, least]: [number | undefined, number] = [undefined, reach];
    for (let box = 0; box < this.count; box++) {
      const [left, top, wide, high] = this.#box(box);
      const far = Math.hypot(Math.max(left - x, 0, x - left - wide), Math.max(top - y, 0, y - top - high));
      if (far <= least) [nearest, least] = [box, far];
    }
    return nearest;
  }

  /** Puts the middle of a box at a point, inside the walls. */
  moveTo(box: number, x: number, y: number): void {
    const [, , wide, high] = this.#box(box);
    this.#put(box, x - wide / 2, y - high / 2, wide, high);
  }

  /** Lets the held box go, with this velocity. */
  throw(vx: number, vy: number): void {
    if (this.held === undefined) return;
    const factor = Math.min(1, FASTEST / Math.max(Math.hypot(vx, vy), 1e-9));
    this.#velocities.set([vx * factor, vy * factor], 2 * this.held);
    this.held = undefined;
  }

  /** The boxes that a vertical line touches, the one that it entered last at the end. */
  touchedBy(x: number): number[] {
    const touched: number[] = [];
    for (let box = 0; box < this.count; box++) {
      if (this.rows[4 * box]! <= x && x <= this.rows[4 * box + 2]!) touched.push(box);
    }
    return touched.sort((a, b) => this.rows[4 * a]! - this.rows[4 * b]!);
  }

  #box(box: number): [x: number, y: number, wide: number, high: number] {
    const [left = 0, top = 0, right = 0, bottom = 0] = this.rows.subarray(4 * box, 4 * box + 4);
    return [left, top, right - left, bottom - top];
  }

  #put(box: number, x: number, y: number, wide: number, high: number): void {
    const left = Math.min(Math.max(x, 0), Math.max(this.#width - wide, 0));
    const top = Math.min(Math.max(y, 0), Math.max(WORLD_HEIGHT - high, 0));
    this.rows.set([left, top, left + wide, top + high], 4 * box);
  }
}
