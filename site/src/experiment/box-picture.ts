// Boxes on a canvas, those of a pair highlighted.

import { fitted } from "../plot/line-plot.ts";

/** Of more boxes than this no outlines are drawn: they take as long as the boxes, and are not missed. */
const MOST_OUTLINED = 2_000;

export interface BoxColors {
  readonly box: string;
  readonly highlighted: string;
  readonly line: string;
  /** Of the frame around the box that is selected. */
  readonly selected: string;
}

/** What part of the world is shown, and how large. */
export interface Window2 {
  /** The middle, on the first two axes. */
  readonly x: number;
  readonly y: number;
  /** CSS pixels a unit. */
  readonly scale: number;
}

/** The window that shows all boxes, with a little room around them; the second axis up. */
export function windowOf(boxes: Float32Array, dimensions: number, width: number, height: number): Window2 {
  const row = 2 * dimensions;
  let [left, bottom, right, top] = [Infinity, Infinity, -Infinity, -Infinity];
  for (let at = 0; at < boxes.length; at += row) {
    left = Math.min(left, boxes[at] as number);
    bottom = Math.min(bottom, boxes[at + 1] as number);
    right = Math.max(right, boxes[at + dimensions] as number);
    top = Math.max(top, boxes[at + dimensions + 1] as number);
  }
  if (left > right) return { x: 0.5, y: 0.5, scale: Math.min(width, height) };
  const least = Number.MIN_VALUE;
  const scale = 0.94 * Math.min(width / Math.max(right - left, least), height / Math.max(top - bottom, least));
  return { x: (left + right) / 2, y: (bottom + top) / 2, scale: Number.isFinite(scale) && scale > 0 ? scale : 1 };
}

/**
 * Draws every box as seen along the axes beyond the second, those of `pairs` highlighted. Boxes outside the
 * window cost nothing but a look.
 */
export function drawBoxes(
  canvas: HTMLCanvasElement,
  size: { readonly width: number; readonly height: number },
  { x, y, scale }: Window2,
  boxes: Float32Array,
  dimensions: number,
  pairs: Uint32Array,
  colors: BoxColors,
  selected: number | undefined,
): void {
  const { width, height } = size;
  const context = fitted(canvas, width, height);
  context.clearRect(0, 0, width, height);
  const row = 2 * dimensions;
  const highlighted = new Uint8Array(boxes.length / row);
  for (const box of pairs) highlighted[box] = 1;
  let marked: readonly [number, number, number, number] | undefined;
  const outlined = highlighted.length <= MOST_OUTLINED;
  for (const layer of [0, 1]) {
    context.fillStyle = layer === 0 ? colors.box : colors.highlighted;
    for (let box = 0; box < highlighted.length; box++) {
      if (highlighted[box] !== layer) continue;
      const at = box * row;
      const left = width / 2 + ((boxes[at] as number) - x) * scale;
      const right = width / 2 + ((boxes[at + dimensions] as number) - x) * scale;
      const top = height / 2 - ((boxes[at + dimensions + 1] as number) - y) * scale;
      const bottom = height / 2 - ((boxes[at + 1] as number) - y) * scale;
      if (right < 0 || left > width || bottom < 0 || top > height) continue;
      // Large coordinates are cut to what is seen; small boxes are seen all the same.
      const [l, t] = [Math.max(left, -4), Math.max(top, -4)];
      const wide = Math.max(Math.min(right, width + 4) - l, 1);
      const high = Math.max(Math.min(bottom, height + 4) - t, 1);
      context.fillRect(l, t, wide, high);
      if (outlined && wide > 5 && high > 5) {
        context.strokeStyle = colors.line;
        context.lineWidth = 1;
        context.strokeRect(l + 0.5, t + 0.5, wide - 1, high - 1);
      }
      if (box === selected) marked = [l, t, wide, high];
    }
  }
  if (!marked) return;
  // Dashed, a little outside: color is not the only sign.
  context.strokeStyle = colors.selected;
  context.lineWidth = 2;
  context.setLineDash([5, 3]);
  context.strokeRect(marked[0] - 3, marked[1] - 3, marked[2] + 6, marked[3] + 6);
  context.setLineDash([]);
}
