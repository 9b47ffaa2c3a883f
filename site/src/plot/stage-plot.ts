// What a picture costs, stage upon stage, over the last moments.

import { fitted } from "./line-plot.ts";

/** A sixtieth of a second. */
const FRAME_MS = 1000 / 60;
const LEFT = 46;
const TOP = 20;

interface StagesOptions {
  /** By moment, milliseconds by stage. */
  readonly moments: readonly (readonly number[])[];
  /** How many moments there is room for. */
  readonly room: number;
  /** By stage. */
  readonly colors: readonly string[];
  readonly ink: string;
  readonly muted: string;
}

/** Fills the canvas: time upwards, at least a frame high, the newest moment at the right. */
export function drawStages(canvas: HTMLCanvasElement, { moments, room, colors, ink, muted }: StagesOptions): void {
  const { clientWidth: width, clientHeight: height } = canvas;
  const context = fitted(canvas, width, height);
  context.clearRect(0, 0, width, height);
  context.font = "12px system-ui, sans-serif";
  context.fillStyle = ink;
  context.textBaseline = "top";
  context.textAlign = "left";
  context.fillText("↑ milliseconds, stage upon stage", 0, 0);

  const totals = moments.map((stages) => stages.reduce((sum, ms) => sum + ms, 0));
  const top = niceTop(Math.max(FRAME_MS * 1.2, ...totals));
  const y = (ms: number): number => height - 1 - (ms / top) * (height - TOP - 8);
  const bar = (width - LEFT) / room;
  moments.forEach((stages, moment) => {
    const left = width - (moments.length - moment) * bar;
    let base = 0;
    stages.forEach((ms, stage) => {
      context.fillStyle = colors[stage] ?? ink;
      context.fillRect(left, y(base + ms), Math.max(bar - 0.5, 0.5), y(base) - y(base + ms));
      base += ms;
    });
  });

  // The line of a frame, or, where it would lie on the floor, of the top.
  const level = FRAME_MS / top < 0.12 ? top : FRAME_MS;
  context.textBaseline = "middle";
  context.textAlign = "right";
  context.fillStyle = muted;
  context.fillText(level === top ? String(top) : FRAME_MS.toFixed(1), LEFT - 8, y(level));
  context.strokeStyle = muted;
  context.setLineDash([3, 3]);
  context.beginPath();
  context.moveTo(LEFT, Math.round(y(level)) + 0.5);
  context.lineTo(width, Math.round(y(level)) + 0.5);
  context.stroke();
  context.setLineDash([]);
}

/** The least of 20, 50, 100, 200, ... that is not below. */
function niceTop(ms: number): number {
  const power = 10 ** Math.floor(Math.log10(ms));
  return [2, 5, 10].map((digit) => digit * power).find((nice) => nice >= ms) ?? 10 * power;
}
