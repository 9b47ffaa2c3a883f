import type { Theme } from "./theme.ts";
import { fitted } from "../plot/line-plot.ts";
import { type Picture, shownHeight, type View, type World } from "./view.ts";

/** Bodies of one shade are drawn as one path: the fewer shades, the fewer paths. */
const SHADES = 24;
/** Left around the world, in CSS pixels. */
const PADDING = 10;

/** Discs on a two-dimensional canvas. */
export class DiscView implements View {
  #size = { width: 0, height: 0 };
  #theme: Theme;
  #world: World = { min: [0, 0], max: [1, 1] };
  #shownHeight = 1;
  #radii: Float32Array = new Float32Array(0);
  /** The bodies of each shade. */
  #shades: number[][] = [];
  #colors: string[] = [];

  constructor(private readonly canvas: HTMLCanvasElement, theme: Theme) {
    this.#theme = theme;
    this.setTheme(theme);
  }

  begin(world: World, radii: Float32Array, tints: Float32Array): void {
    this.#world = world;
    this.#shownHeight = shownHeight(world, radii);
    this.#radii = radii;
    this.#shades = Array.from({ length: SHADES }, () => []);
    tints.forEach((tint, body) => this.#shades[Math.round(tint * (SHADES - 1))]?.push(body));
  }

  setTheme(theme: Theme): void {
    this.#theme = theme;
    this.#colors = Array.from({ length: SHADES }, (_, shade) => mixRamp(theme.ramp, shade / (SHADES - 1)));
  }

  resize(width: number, height: number): void {
    this.#size = { width, height };
  }

  draw({ positions, pairs = new Uint32Array() }: Picture): void {
    const { width, height } = this.#size;
    const context = fitted(this.canvas, width, height);
    const [left = 0, bottom = 0] = this.#world.min;
    const worldWidth = (this.#world.max[0] ?? 1) - left;
    const scale = Math.min((width - 2 * PADDING) / worldWidth, (height - PADDING) / this.#shownHeight);
    const wall = (width - worldWidth * scale) / 2;
    const floor = height - PADDING;
    const x = (body: number): number => wall + ((positions[2 * body] ?? 0) - left) * scale;
    const y = (body: number): number => floor - ((positions[2 * body + 1] ?? 0) - bottom) * scale;

    context.clearRect(0, 0, width, height);
    context.fillStyle = this.#theme.floor;
    context.fillRect(0, floor, width, height - floor);
    context.fillRect(0, 0, wall, height);
    context.fillRect(wall + worldWidth * scale, 0, wall, height);

    // A hair's breadth between bodies that touch.
    const gap = Math.min(0.35, 0.1 * (this.#radii[0] ?? 0) * scale);
    this.#shades.forEach((bodies, shade) => {
      context.beginPath();
      for (const body of bodies) {
        const radius = Math.max((this.#radii[body] ?? 0) * scale - gap, 0.5);
        context.moveTo(x(body) + radius, y(body));
        context.arc(x(body), y(body), radius, 0, 2 * Math.PI);
      }
      context.fillStyle = this.#colors[shade] ?? this.#theme.edge;
      context.fill();
    });
    context.beginPath();
    for (let at = 0; at < pairs.length; at += 2) {
      context.moveTo(x(pairs[at]!), y(pairs[at]!));
      context.lineTo(x(pairs[at + 1]!), y(pairs[at + 1]!));
    }
    context.strokeStyle = this.#theme.line;
    context.lineWidth = 1.5;
    context.stroke();
  }
}

/** The color at `t`, from 0 to 1, of a ramp of colors. */
function mixRamp(ramp: readonly string[], t: number): string {
  const at = t * (ramp.length - 1);
  const below = Math.min(Math.floor(at), ramp.length - 2);
  return `color-mix(in srgb, ${ramp[below + 1]} ${100 * (at - below)}%, ${ramp[below]})`;
}
