// The scene of balls that fall: their boxes are what the algorithms search, step by step.

import { Simulation } from "../../../classroom/simulation/wasm/simulation.js";
import scalarWasm from "../generated/simulation.wasm?url";
import simdWasm from "../generated/simulation.simd.wasm?url";
import { hasSimd } from "../simd.ts";
import type { WorldOptions } from "./experiment.ts";
import { GRAVITIES } from "./scene.ts";
import type { Balls } from "./messages.ts";

/** What the bodies of size 1 fill together: an area in 2D, a volume in 3D. The box is 10 wide. */
const FILLED = { 2: 32, 3: 335 } as const;

/** The middle radius of this many bodies. More bodies are smaller bodies: they fill the same space. */
function radiusOf(bodies: number, dimensions: 2 | 3): number {
  const each = FILLED[dimensions] / bodies;
  return dimensions === 2 ? Math.sqrt(each / Math.PI) : Math.cbrt((3 * each) / (4 * Math.PI));
}

let loaded: Promise<unknown> | undefined;

/** Loads the compiled simulation, once in each thread: `Falling` needs it. */
export const loadSimulation = (): Promise<unknown> => (loaded ??= Simulation.load(new URL(hasSimd() ? simdWasm : scalarWasm, self.location.href)));

export class Falling {
  readonly #simulation: Simulation;
  readonly #dimensions: number;
  /** At which the balls start. */
  readonly #heights: Float32Array;
  #isNew = true;
  /** Milliseconds that the last step took. */
  #ms = 0;

  constructor({ dimensions, boxes, seed, size, spread, motion }: WorldOptions) {
    this.#dimensions = dimensions;
    const gravity = GRAVITIES[motion] ?? 9.81;
    this.#simulation = new Simulation({ scene: "falling", dimensions, bodies: boxes, size: size * radiusOf(boxes, dimensions), spread: Math.min(spread, 100), seed, gravity, counting: false });
    this.#heights = this.#simulation.positions.filter((_, at) => at % dimensions === 1);
  }

  advance(): void {
    this.#ms = this.#simulation.step().totalMs;
  }

  /** The boxes of the balls, rows of min corner and max corner. */
  get rows(): Float32Array {
    const { positions, radii } = this.#simulation;
    const row = 2 * this.#dimensions;
    const rows = new Float32Array(2 * positions.length);
    for (const [at, center] of positions.entries()) {
      const [ball, axis] = [Math.floor(at / this.#dimensions), at % this.#dimensions];
      rows[row * ball + axis] = center - radii[ball]!;
      rows[row * ball + this.#dimensions + axis] = center + radii[ball]!;
    }
    return rows;
  }

  /** What is drawn: where the balls are, and at first also in which world. */
  get balls(): Balls {
    const { positions, radii, bounds } = this.#simulation;
    const world = this.#isNew ? { ...bounds, radii: radii.slice(), heights: this.#heights } : undefined;
    this.#isNew = false;
    return { positions: positions.slice(), world, ms: this.#ms };
  }

  free(): void {
    this.#simulation.free();
  }
}
