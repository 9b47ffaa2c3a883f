import { fitted } from "../plot/line-plot.ts";
import { type MovingBoxes, WORLD_HEIGHT } from "./moving-boxes.ts";

/** More lines than this from one box are a solid area: of more, only some are drawn. */
const MOST_LINES = 1_000;

/** Resolved colors, as a canvas takes them. */
export interface HeroColors {
  readonly overlap: string;
  readonly test: string;
  readonly line: string;
  readonly outline: string;
  readonly stage: string;
}

/** What one picture shows. */
interface HeroPicture {
  readonly boxes: MovingBoxes;
  /** The pairs that overlap: `a0, b0, a1, b1, ...`. */
  readonly pairs: Uint32Array;
  /** Where the sweep line stands. */
  readonly line: number;
  /** The boxes that it touches, the one that it entered last at the end. */
  readonly touched: readonly number[];
  /** The boxes that the last of those is tested against. */
  readonly partners: readonly number[];
}

/** Draws a world that fills the canvas. A box that overlaps is filled; the others are outlines. */
export function drawBoxes(canvas: HTMLCanvasElement, width: number, height: number, picture: HeroPicture, colors: HeroColors): void {
  const context = fitted(canvas, width, height);
  const { boxes, pairs, line, touched, partners } = picture;
  const { rows, count } = boxes;
  const scale = height / WORLD_HEIGHT;
  context.clearRect(0, 0, width, height);

  const isOverlapping = new Uint8Array(count);
  for (const box of pairs) isOverlapping[box] = 1;
  const rectOf = (box: number): [x: number, y: number, width: number, height: number] => {
    const [left, top] = [rows[4 * box]!, rows[4 * box + 1]!];
    return [left * scale + 0.5, top * scale + 0.5, Math.max((rows[4 * box + 2]! - left) * scale - 1, 1), Math.max((rows[4 * box + 3]! - top) * scale - 1, 1)];
  };
  // One by one: ten thousand rectangles in one path take a phone a tenth of a second.
  context.fillStyle = `color-mix(in srgb, ${colors.overlap} 72%, ${colors.stage})`;
  for (let box = 0; box < count; box++) if (isOverlapping[box]) context.fillRect(...rectOf(box));
  for (const layer of [0, 1]) {
    context.strokeStyle = layer === 0 ? colors.outline : colors.overlap;
    context.lineWidth = layer === 0 ? 1 : 1.5;
    for (let box = 0; box < count; box++) if (isOverlapping[box] === layer) context.strokeRect(...rectOf(box));
  }

  // On a seam of the background's color the line is seen over boxes of any color.
  const at = line * scale;
  for (const [color, wide] of [[colors.stage, 5], [colors.line, 2.5]] as const) {
    context.beginPath();
    context.moveTo(at, 0);
    context.lineTo(at, height);
    context.strokeStyle = color;
    context.lineWidth = wide;
    context.stroke();
  }
  context.beginPath();
  for (const box of touched) context.rect(...rectOf(box));
  context.globalAlpha = 0.25;
  context.fillStyle = colors.line;
  context.fill();
  context.globalAlpha = 1;
  context.strokeStyle = colors.line;
  context.lineWidth = 2;
  context.stroke();

  const entered = touched.at(-1);
  if (entered === undefined) return;
  const middle = (box: number): [number, number] => [((rows[4 * box]! + rows[4 * box + 2]!) / 2) * scale, ((rows[4 * box + 1]! + rows[4 * box + 3]!) / 2) * scale];
  const isFew = partners.length <= 60;
  context.beginPath();
  const every = Math.ceil(partners.length / MOST_LINES);
  for (const [at, partner] of partners.entries()) {
    if (at % every !== 0) continue;
    context.moveTo(...middle(entered));
    context.lineTo(...middle(partner));
  }
  // On a seam as well, where there are few enough to be seen one by one.
  for (const [color, wide] of [[colors.stage, 7], [colors.test, 3.5]] as const) {
    if (!isFew && color === colors.stage) continue;
    context.strokeStyle = color;
    context.lineWidth = isFew ? wide : 0.75;
    context.stroke();
  }
  context.strokeStyle = colors.test;
  context.lineWidth = 3.5;
  context.strokeRect(...rectOf(entered));
}
