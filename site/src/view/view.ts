import type { Theme } from "./theme.ts";

/** The box that the bodies are in, the second axis up. */
export interface World {
  readonly min: readonly number[];
  readonly max: readonly number[];
}

/**
 * How much of a world's height is worth showing: some room above the heap that its bodies will
 * make. They fall in from above.
 */
export function shownHeight({ min, max }: World, radii: Float32Array): number {
  const sides = max.map((high, axis) => high - (min[axis] ?? 0));
  const [width = 1, height = 1, depth] = sides;
  const [floor, packing, roundness] = depth === undefined ? [width, 0.8, Math.PI] : [width * depth, 0.58, (4 / 3) * Math.PI];
  const filled = radii.reduce((sum, radius) => sum + roundness * radius ** sides.length, 0);
  const largest = radii.reduce((most, radius) => Math.max(most, radius), 0);
  return Math.min(height, Math.max((1.35 * filled) / (packing * floor), 2.5 * largest));
}

/** What one picture shows. `positions` holds the centers one body after another. */
export interface Picture {
  readonly positions: Float32Array;
  /** The pairs to draw lines between, if any: a0, b0, a1, b1, ... */
  readonly pairs?: Uint32Array | undefined;
}

/** Draws the bodies of one simulation on one canvas. */
export interface View {
  /** A new set of bodies in a new world. `tints` are from 0 to 1 along the theme's ramp. */
  begin(world: World, radii: Float32Array, tints: Float32Array): void;
  setTheme(theme: Theme): void;
  /** In CSS pixels. */
  resize(width: number, height: number): void;
  draw(picture: Picture): void;
}
