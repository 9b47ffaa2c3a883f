import type { PlayerState } from "../algorithms/player.js";
import type { TraceEvent } from "../algorithms/trace.js";
import type { Decorations } from "./decorations.js";
import { type Detection, hasFlags } from "./detection.js";
import type { Explanation } from "./explain.js";
import { type Options, WIDTH } from "./options.js";
import { type ColorName, rainbow, type Theme } from "./theme.js";

/** What one picture shows. */
export interface Scene {
  readonly positions: Float32Array;
  readonly radii: Float32Array;
  /** Where the balls were at the last two detections. */
  readonly jump: { readonly from: Float32Array | undefined; readonly to: Float32Array };
  readonly state: PlayerState;
  /** The event at work. */
  readonly event: TraceEvent | undefined;
  /** Where the sweep line is, and the balls that it touches. */
  readonly lineAt: number | undefined;
  readonly touched: readonly number[];
  /** Whether what a scan finds is not to be seen yet. */
  readonly isScanHidden: boolean;
  /** The edges whose swap is flashed. */
  readonly flashing: ReadonlySet<number>;
  readonly options: Options;
  readonly labels: readonly string[];
  /** The balls that the visitor has chosen. */
  readonly chosen: readonly number[];
  /** The axis that is swept, or the first to be. */
  readonly axis: number;
  /** The pairs that should have been found. */
  readonly missed: Detection["missed"];
  /** The gap that an explanation speaks of. */
  readonly gap: Explanation["gap"];
  /** The color of what is to stand out. */
  readonly emphasis: string | undefined;
}

/** Draws the world into a context that is scaled to it. */
export function drawScene(context: CanvasRenderingContext2D, scene: Scene, theme: Theme): void {
  context.clearRect(0, 0, WIDTH, scene.options.world.height);
  context.lineJoin = "round";
  context.lineCap = "butt";
  const painter = new Painter(context, scene, theme);
  painter.focusBand();
  painter.edges();
  painter.jumps();
  painter.balls();
  painter.overlaps();
  painter.missed();
  painter.event();
  painter.sweepLine();
  painter.chosen();
  painter.explanation();
  painter.labels();
}

class Painter {
  readonly #context: CanvasRenderingContext2D;
  readonly #scene: Scene;
  readonly #theme: Theme;

  constructor(context: CanvasRenderingContext2D, scene: Scene, theme: Theme) {
    this.#context = context;
    this.#scene = scene;
    this.#theme = theme;
  }

  /** The width of a line of this color: of what is to stand out, twice that. */
  #wide(color: ColorName, width: number): number {
    return this.#scene.emphasis === color ? 2 * width + 1 : width;
  }

  get #height(): number {
    return this.#scene.options.world.height;
  }

  /** The boxes of the last detection and of the one before it (dashed); and those that enclose both, if they are used. */
  jumps(): void {
    const { options, jump, radii } = this.#scene;
    if (!options.swept) return;
    this.#context.strokeStyle = this.#theme.edge;
    this.#context.fillStyle = this.#theme.edge;
    this.#context.lineWidth = 1.5;
    for (const [ball, radius] of radii.entries()) {
      if (options.world.walls.includes(ball)) continue;
      const rect = (positions: Float32Array): [number, number, number, number] => [positions[2 * ball]! - radius, positions[2 * ball + 1]! - radius, 2 * radius, 2 * radius];
      const to = rect(jump.to);
      this.#context.strokeRect(...to);
      if (!jump.from) continue;
      const from = rect(jump.from);
      this.#context.setLineDash([4, 3]);
      this.#context.strokeRect(...from);
      this.#context.setLineDash([]);
      if (options.swept !== "on") continue;
      const [left, top] = [Math.min(from[0], to[0]), Math.min(from[1], to[1])];
      const size = [Math.abs(from[0] - to[0]) + 2 * radius, Math.abs(from[1] - to[1]) + 2 * radius] as const;
      this.#context.globalAlpha = 0.2;
      this.#context.fillRect(left, top, ...size);
      this.#context.globalAlpha = 1;
      this.#context.strokeRect(left, top, ...size);
    }
  }

  balls(): void {
    const { radii, touched, options } = this.#scene;
    const { decorations, isRainbow, hasBoxes } = options;
    const active = new Set(decorations.sweep ? touched : []);
    const inside = decorations.sweep?.inside ?? this.#theme.inside;
    this.#context.lineWidth = 1.5;
    // Large ones first, so that none is hidden.
    const balls = Array.from(radii.keys()).sort((a, b) => radii[b]! - radii[a]!);
    for (const ball of balls) {
      const fill = active.has(ball) ? inside : isRainbow ? rainbow(ball, radii.length) : this.#theme.ball;
      this.#disc(ball, radii[ball]!);
      this.#context.fillStyle = fill;
      this.#context.fill();
      this.#context.strokeStyle = this.#theme.muted;
      this.#context.lineWidth = active.has(ball) ? this.#wide("inside", 1.5) : 1.5;
      this.#context.stroke();
      if (hasBoxes) this.#box(ball, this.#theme.muted);
    }
  }

  /** The interval of the ball in focus, on the axis. */
  focusBand(): void {
    const { options, axis } = this.#scene;
    const { decorations, focus } = options;
    if (!decorations.edges?.focus || focus === undefined || this.#scene.isScanHidden) return;
    const [low, high] = this.#interval(focus, axis);
    this.#context.globalAlpha = 0.16;
    this.#context.fillStyle = decorations.edges.inside ?? this.#theme.chosen;
    if (axis === 0) this.#context.fillRect(low, 0, high - low, this.#height);
    else this.#context.fillRect(0, low, WIDTH, high - low);
    this.#context.globalAlpha = 1;
  }

  /** Where each interval begins and ends, drawn to the foot of the picture. */
  edges(): void {
    const { edges } = this.#scene.options.decorations;
    if (!edges) return;
    const { axis, state } = this.#scene;
    const axes = state.arrays.length > 1 ? state.arrays.keys() : [axis];
    for (const axis of axes) this.#edgesOn(axis, edges);
    this.#context.setLineDash([]);
  }

  #edgesOn(axis: number, edges: NonNullable<Decorations["edges"]>): void {
    const { radii, options, isScanHidden, flashing } = this.#scene;
    const { focus } = options;
    const outside = (edges.focus ? edges.outside : undefined) ?? this.#theme.edge;
    const inside = (edges.focus ? edges.inside : undefined) ?? this.#theme.chosen;
    const within = edges.focus && focus !== undefined && !isScanHidden ? this.#interval(focus, axis) : undefined;
    for (let ball = 0; ball < radii.length; ball++) {
      for (const [side, at] of this.#interval(ball, axis).entries()) {
        const isInside = within !== undefined && at >= within[0] && at <= within[1];
        const isFlashing = flashing.has(2 * ball + side);
        this.#context.strokeStyle = isFlashing ? this.#theme.swap : isInside ? inside : outside;
        this.#context.lineWidth = isFlashing ? 5 : isInside ? this.#wide("chosen", 2) : this.#wide("edge", 1);
        this.#context.setLineDash(side === 0 ? [] : [4, 3]);
        this.#across(axis, at, this.#center(ball)[1 - axis]!);
      }
    }
  }

  /** The pairs found so far. */
  overlaps(): void {
    const { options, state } = this.#scene;
    if (this.#scene.isScanHidden || !(options.decorations.checks || options.predicts)) return;
    if (hasFlags(options.detecting)) this.#flags();
    this.#context.strokeStyle = this.#theme.overlap;
    this.#context.lineWidth = this.#wide("overlap", 2);
    for (let i = 0; i + 1 < state.overlaps.length; i += 2) {
      const [a, b] = [state.overlaps[i]!, state.overlaps[i + 1]!];
      // Where boxes are shown: dashed if only the boxes overlap.
      this.#context.setLineDash(options.hasBoxes && !this.#touch(a, b) ? [6, 5] : []);
      this.#between(a, b);
    }
    this.#context.setLineDash([]);
  }

  /** The pairs that overlap on one axis, as far as is known. */
  #flags(): void {
    const { overlaps, axisOverlaps } = this.#scene.state;
    this.#context.strokeStyle = this.#theme.edge;
    this.#context.lineWidth = this.#wide("edge", 2);
    this.#context.setLineDash([2, 5]);
    const pairs = new Set<string>();
    for (let i = 0; i + 1 < overlaps.length; i += 2) pairs.add(`${overlaps[i]} ${overlaps[i + 1]}`);
    for (const { a, b } of axisOverlaps) if (!pairs.has(`${a} ${b}`)) this.#between(a, b);
    this.#context.setLineDash([]);
  }

  missed(): void {
    this.#context.strokeStyle = this.#theme.sweep;
    this.#context.lineWidth = this.#wide("sweep", 4);
    this.#context.setLineDash([3, 5]);
    for (const [a, b] of this.#scene.missed) this.#between(a, b);
    this.#context.setLineDash([]);
  }

  event(): void {
    const { event, options } = this.#scene;
    const check = options.decorations.checks?.color ?? this.#theme.check;
    if (event?.kind === "test" || event?.kind === "overlap" || event?.kind === "axis overlap") {
      const [a, b] = [Number(event["a"]), Number(event["b"])];
      this.#context.strokeStyle = check;
      this.#context.lineWidth = this.#wide("check", 5);
      this.#between(a, b);
      this.#context.lineWidth = this.#wide("check", 4);
      for (const ball of [a, b]) {
        this.#disc(ball, this.#scene.radii[ball]! - 1);
        this.#context.stroke();
      }
    } else if (event?.kind === "prune") {
      this.#gap(Number(event["axis"]), Number(event["left"]), Number(event["right"]), this.#theme.skip);
    }
  }

  sweepLine(): void {
    const { options, lineAt, state } = this.#scene;
    const { sweep } = options.decorations;
    if (!sweep || lineAt === undefined) return;
    this.#context.strokeStyle = sweep.line ?? this.#theme.sweep;
    this.#context.lineWidth = this.#wide("sweep", 2.5);
    this.#across(state.arrayAxis, lineAt, undefined);
  }

  chosen(): void {
    const { chosen, options } = this.#scene;
    const { focus } = options;
    this.#context.strokeStyle = this.#theme.chosen;
    this.#context.lineWidth = this.#wide("chosen", 3);
    for (const ball of new Set([...chosen, ...(focus === undefined ? [] : [focus])])) {
      this.#context.setLineDash(chosen.includes(ball) ? [6, 4] : []);
      this.#disc(ball, this.#scene.radii[ball]! + 4);
      this.#context.stroke();
    }
    this.#context.setLineDash([]);
  }

  explanation(): void {
    const { gap } = this.#scene;
    if (gap) this.#gap(gap.axis, gap.left, gap.right, this.#theme.skip);
  }

  labels(): void {
    const { labels, radii, options } = this.#scene;
    const { isRainbow } = options;
    this.#context.textAlign = "center";
    this.#context.textBaseline = "middle";
    labels.forEach((label, ball) => {
      if (ball >= radii.length || label === "" || options.world.walls.includes(ball)) return;
      const [x, y] = this.#center(ball);
      const size = Math.max(9, Math.min(radii[ball]! * (label.length > 2 ? 0.7 : 1), 40));
      this.#context.font = `600 ${size}px system-ui, sans-serif`;
      this.#context.fillStyle = isRainbow ? "#1c2126" : this.#theme.ink;
      this.#context.fillText(label, x, y + size * 0.05);
    });
  }

  /** The gap between the right edge of one ball and the left edge of another. */
  #gap(axis: number, left: number, right: number, color: string): void {
    const [, from] = this.#interval(left, axis);
    const [to] = this.#interval(right, axis);
    const [a, b] = [this.#center(left)[1 - axis]!, this.#center(right)[1 - axis]!];
    this.#context.strokeStyle = color;
    this.#context.lineWidth = this.#wide("skip", 2.5);
    const point = (along: number, across: number): [number, number] => (axis === 0 ? [along, across] : [across, along]);
    this.#context.beginPath();
    for (const [at, across] of [[from, a], [to, b]] as const) {
      this.#context.moveTo(...point(at, across - 16));
      this.#context.lineTo(...point(at, across + 16));
    }
    this.#context.stroke();
    this.#context.setLineDash([5, 5]);
    this.#context.beginPath();
    this.#context.moveTo(...point(from, a));
    this.#context.lineTo(...point(to, b));
    this.#context.stroke();
    this.#context.setLineDash([]);
  }

  /** A line across the whole picture, or from `from` to its foot. */
  #across(axis: number, at: number, from: number | undefined): void {
    this.#context.beginPath();
    if (axis === 0) {
      this.#context.moveTo(at, from ?? 0);
      this.#context.lineTo(at, this.#height);
    } else {
      this.#context.moveTo(from ?? WIDTH, at);
      this.#context.lineTo(0, at);
    }
    this.#context.stroke();
  }

  /** Whether two balls touch, not only their boxes. */
  #touch(a: number, b: number): boolean {
    const [[ax, ay], [bx, by]] = [this.#center(a), this.#center(b)];
    return Math.hypot(ax - bx, ay - by) <= this.#scene.radii[a]! + this.#scene.radii[b]!;
  }

  #between(a: number, b: number): void {
    this.#context.beginPath();
    this.#context.moveTo(...this.#center(a));
    this.#context.lineTo(...this.#center(b));
    this.#context.stroke();
  }

  /** The outline of a ball, or of a wall, which is as high as the world. */
  #disc(ball: number, radius: number): void {
    this.#context.beginPath();
    if (this.#scene.options.world.walls.includes(ball)) return this.#context.rect(this.#center(ball)[0] - radius, 0, 2 * radius, this.#height);
    this.#context.arc(...this.#center(ball), Math.max(radius, 0.5), 0, 2 * Math.PI);
  }

  #box(ball: number, color: string): void {
    const [x, y] = this.#center(ball);
    const radius = this.#scene.radii[ball]!;
    this.#context.strokeStyle = color;
    this.#context.lineWidth = 1;
    this.#context.strokeRect(x - radius, y - radius, 2 * radius, 2 * radius);
  }

  #center(ball: number): [number, number] {
    return [this.#scene.positions[2 * ball]!, this.#scene.positions[2 * ball + 1]!];
  }

  #interval(ball: number, axis: number): [number, number] {
    const at = this.#center(ball)[axis === 1 ? 1 : 0];
    const radius = this.#scene.radii[ball]!;
    return [at - radius, at + radius];
  }
}
