import type { Theme } from "./theme.ts";

/** The box that the bodies are in: from the origin to `size`, the second axis up. */
export interface World {
  readonly size: readonly number[];
}

/** What one picture shows. `positions` holds the centres one body after another. */
export interface Picture {
  readonly positions: Float32Array;
  /** Pairs of bodies whose boxes overlap, a0, b0, a1, b1, .. Empty unless asked for. */
  readonly pairs: Uint32Array;
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

/** Physical pixels for one CSS pixel; more than two cannot be seen and cost dearly. */
export const pixelRatio = (): number => Math.min(devicePixelRatio, 2);
