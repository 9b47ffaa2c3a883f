import { Simulation, SimulationError } from "../../../simulation/wasm/simulation.js";
import type { Row } from "./types.js";
import { OptionError } from "./option-error.js";
import { WIDTH, type WorldOptions } from "./options.js";

/** Loads the compiled simulation: the file beside the bundle that this module is part of. */
export function loadWorlds(): Promise<void> {
  return Simulation.load(new URL("./simulation.wasm", import.meta.url));
}

/** How fast balls that are given without a velocity set out sideways, at most. */
const GIVEN_SPEED = 90;
/** Random balls vary in size by this factor. */
const SPREAD = 2;

/** The balls: the compiled simulation, set up as the attributes say. One tick is 1/60 s. */
export class World {
  readonly #simulation: Simulation;
  readonly #options: WorldOptions;
  readonly radii: Float32Array;
  /** Whether a ball was ever put elsewhere. */
  hasMoved = false;

  /** @throws {@link OptionError} if the balls do not fit. */
  constructor(options: WorldOptions) {
    this.#options = options;
    this.#simulation = start(options);
    this.radii = this.#simulation.radii.slice();
  }

  /** Centers, two numbers a ball, to keep. */
  positions(): Float32Array {
    return this.#simulation.positions.slice();
  }

  velocities(): Float32Array {
    return this.#simulation.velocities.slice();
  }

  /** 16 hexadecimal digits of all positions and velocities, bit for bit. */
  hash(): string {
    return this.#simulation.hash();
  }

  /** One tick of motion; the last before a detection is when a ball that teleports does. */
  tick(isLast: boolean): void {
    const { motion, focus } = this.#options;
    if (motion === "bounce" || motion === "drift") {
      this.#simulation.step();
    } else if (motion === "teleport" && isLast && this.radii.length > 0) {
      const [x = 0, y = 0] = this.#simulation.positions.subarray(2 * focus);
      this.#simulation.place(focus, { x: WIDTH - x, y });
    }
  }

  /** Puts a ball somewhere else, inside the walls. */
  place(ball: number, x: number, y: number, vx = 0, vy = 0): void {
    this.#simulation.place(ball, { x, y, vx, vy });
    this.hasMoved = true;
  }

  save(): number {
    return this.#simulation.save();
  }

  restore(moment: number): void {
    this.#simulation.restore(moment);
  }

  forget(moment: number): void {
    this.#simulation.forget(moment);
  }

  free(): void {
    this.#simulation.free();
  }
}

function start({ balls, seed, motion, bounces, height }: WorldOptions): Simulation {
  const isDrifting = motion === "drift";
  const laws = { collisions: bounces, counting: false, ...(isDrifting && { gravity: 0, restitution: 1 }) };
  const size = { width: WIDTH, height };
  try {
    if (typeof balls === "number" && balls > 0) {
      return new Simulation({ scene: "bouncing", bodies: balls, size: middleRadius(balls, height), spread: SPREAD, seed, ...size, ...laws });
    }
    const rows = typeof balls === "number" ? [] : balls;
    const given = rows.map(([x, y, radius, vx, vy], index) => ({
      x,
      y,
      radius,
      vx: vx ?? sideways(seed, index),
      vy: vy ?? 0,
    }));
    return new Simulation({ scene: "bouncing", balls: given, ...size, ...laws });
  } catch (error) {
    const isTooMuch = error instanceof SimulationError && error.code === "no-room";
    throw isTooMuch ? new OptionError(`balls="${String(balls)}": that many do not fit into the world; use fewer`) : error;
  }
}

/** So large that the balls fill a fifth of the world, and no larger than looks well. */
function middleRadius(count: number, height: number): number {
  return Math.min(height / 10, Math.sqrt((0.2 * WIDTH * height) / (Math.PI * count)));
}

/** A speed from the seed, the same everywhere: given balls would only fall. */
function sideways(seed: number, index: number): number {
  const mixed = Math.imul((seed >>> 0) + 0x9e3779b9 * (index + 1), 0x85ebca6b) >>> 8;
  return ((mixed / 0xffffff) * 2 - 1) * GIVEN_SPEED;
}

/** Boxes as rows of min corner and max corner, which is what a runner takes. Those of walls are as high as the world. */
export function boxesOf(positions: Float32Array, radii: Float32Array, { walls, height }: WorldOptions): Float64Array {
  const boxes = new Float64Array(positions.length * 2);
  radii.forEach((radius, ball) => {
    const [x, y] = [positions[2 * ball]!, positions[2 * ball + 1]!];
    boxes.set([x - radius, y - radius, x + radius, y + radius], 4 * ball);
  });
  for (const wall of walls) [boxes[4 * wall + 1], boxes[4 * wall + 3]] = [0, height];
  return boxes;
}

/** The smallest boxes that enclose the same ones here and there: what each sweeps on its way. */
export function sweptBoxes(from: Float64Array, to: Float64Array): Float64Array {
  return to.map((value, at) => (at % 4 < 2 ? Math.min(value, from[at]!) : Math.max(value, from[at]!)));
}

/** The balls as rows, as the attribute `balls` takes them. */
export function rowsOf(positions: Float32Array, radii: Float32Array): Row[] {
  return Array.from(radii, (radius, ball) => [positions[2 * ball]!, positions[2 * ball + 1]!, radius]);
}
