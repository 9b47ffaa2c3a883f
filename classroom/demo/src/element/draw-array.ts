import type { PlayerState } from "../algorithms/player.js";
import type { TraceEvent } from "../algorithms/trace.js";
import type { Options } from "./options.js";
import { rainbow, type Theme } from "./theme.js";

/** What the array of endpoints looks like at one moment. */
interface ArrayScene {
  readonly state: PlayerState;
  readonly event: TraceEvent | undefined;
  readonly options: Options;
  readonly labels: readonly string[];
  /** The edges that the sort has moved in this detection. */
  readonly moved: ReadonlySet<number>;
  readonly chosen: readonly number[];
  /** The edge at the sweep line. */
  readonly lineEdge: number | undefined;
  /** Whether what a scan finds is not to be seen yet. */
  readonly isScanHidden: boolean;
  /** The edges whose swap is flashed. */
  readonly flashing: ReadonlySet<number>;
}

/** How many cells stand in a row. */
const CELLS = 16;
const CELL_HEIGHT = 30;
const GAP = 6;

/** The height of the arrays in CSS pixels, by the number of endpoints on each axis and the number of axes. */
export function arrayHeight(endpoints: number, axes: number): number {
  return Math.max(1, axes) * (Math.max(1, Math.ceil(endpoints / CELLS)) * CELL_HEIGHT + GAP) - GAP + 4;
}

/** Draws the arrays: `(A` is where A begins, `A)` where it ends. */
export function drawArray(context: CanvasRenderingContext2D, width: number, scene: ArrayScene, theme: Theme): void {
  const { state } = scene;
  context.clearRect(0, 0, width, 10_000);
  let top = 2;
  state.arrays.forEach((array, axis) => {
    if (array.length === 0) return;
    const isCurrent = axis === state.arrayAxis;
    drawOne(context, array.map(({ edge }) => edge), { ...scene, event: isCurrent ? scene.event : undefined }, { top, width, isCurrent }, theme);
    top += Math.ceil(array.length / CELLS) * CELL_HEIGHT + GAP;
  });
}

/** The ball whose endpoint stands at a point of the drawn arrays. */
export function ballAt(arrays: PlayerState["arrays"], width: number, x: number, y: number): number | undefined {
  let top = 2;
  for (const array of arrays) {
    const { perRow, cell } = cellsOf(array.length, width);
    const [row, column] = [Math.floor((y - top) / CELL_HEIGHT), Math.floor(x / cell)];
    const place = array[row * perRow + column];
    if (row >= 0 && column < perRow && place) return place.edge >> 1;
    if (array.length > 0) top += Math.ceil(array.length / CELLS) * CELL_HEIGHT + GAP;
  }
  return undefined;
}

/** How many cells stand in a row, and how wide each is. */
function cellsOf(count: number, width: number): { perRow: number; cell: number } {
  const perRow = Math.min(CELLS, Math.max(count, 8));
  return { perRow, cell: Math.min(46, width / perRow) };
}

interface Place {
  readonly top: number;
  readonly width: number;
  readonly isCurrent: boolean;
}

function drawOne(context: CanvasRenderingContext2D, edges: number[], scene: ArrayScene, place: Place, theme: Theme): void {
  const { event, options, labels, chosen, moved, lineEdge, isScanHidden, flashing } = scene;
  const { decorations, focus, isRainbow } = options;
  const { perRow, cell } = cellsOf(edges.length, place.width);
  const height = CELL_HEIGHT - 4;
  const comparison = decorations.array?.comparison ?? theme.comparison;
  const swap = decorations.array?.swap ?? theme.swap;
  const compared = event?.kind === "compare" ? [event["a"], event["b"]] : [];
  const swapped = event?.kind === "swap" ? [event["a"], event["b"]] : [...flashing];
  const ends = focus === undefined ? [] : [edges.indexOf(2 * focus), edges.indexOf(2 * focus + 1)];
  const [begin = -1, end = -1] = ends;
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.font = `600 ${Math.min(15, cell * 0.5)}px ui-monospace, monospace`;
  edges.forEach((edge, index) => {
    const x = (index % perRow) * cell;
    const y = place.top + Math.floor(index / perRow) * CELL_HEIGHT;
    const ball = edge >> 1;
    const isWithin = decorations.edges?.focus === true && !isScanHidden && index >= begin && index <= end && begin >= 0;
    const isAtLine = place.isCurrent && decorations.sweep !== undefined && lineEdge === edge;
    context.fillStyle = isRainbow ? rainbow(ball, labels.length) : theme.stage;
    if (isWithin) context.fillStyle = theme.inside;
    if (swapped.includes(edge)) context.fillStyle = swap;
    if (compared.includes(edge)) context.fillStyle = comparison;
    context.fillRect(x + 1, y, cell - 2, height);
    const isHighlighted = swapped.includes(edge) || compared.includes(edge);
    context.lineWidth = isAtLine || isHighlighted || chosen.includes(ball) ? 3 : 1;
    context.strokeStyle = isAtLine ? theme.sweep : isHighlighted ? theme.ink : chosen.includes(ball) ? theme.chosen : theme.line;
    context.strokeRect(x + 1, y, cell - 2, height);
    const name = labels[ball] || String(ball);
    if (decorations.array?.isSortShown && moved.has(edge)) {
      context.fillStyle = swap;
      context.fillRect(x + 1, y + height - 4, cell - 2, 4);
    }
    context.fillStyle = isHighlighted ? theme.stage : isRainbow && !isWithin ? "#1c2126" : theme.ink;
    context.fillText(edge % 2 === 0 ? `(${name}` : `${name})`, x + cell / 2, y + height / 2 + 1);
  });
}
