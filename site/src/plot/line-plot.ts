// Lines over steps, drawn on a canvas a few times a second: what a plotting library takes several
// milliseconds for, and a live picture has not got.

export interface Line {
  /** What stands at its end, if there is room. */
  readonly name: string;
  readonly color: string;
  /** One value a step; `null` leaves a gap. */
  readonly values: readonly (number | null)[];
}

interface PlotOptions {
  readonly lines: readonly Line[];
  /** The step of the first value. */
  readonly first: number;
  /** How many steps there is room for. */
  readonly steps: number;
  readonly logarithmic: boolean;
  /** What is plotted upwards, with its unit. */
  readonly label: string;
  readonly ink: string;
  readonly muted: string;
  readonly grid: string;
}

const LEFT = 62;
const RIGHT = 10;
/** The room for names at the ends of lines, in a plot of at least `NAMED_FROM` pixels. */
const NAMES = 150;
const NAMED_FROM = 480;
const NAME_HEIGHT = 15;
const TOP = 30;
const BOTTOM = 34;

/** Draws a plot that fills the canvas, whose size in CSS pixels is given. */
export function drawLines(canvas: HTMLCanvasElement, width: number, height: number, options: PlotOptions): void {
  const { lines, first, steps, logarithmic, label, ink, muted, grid } = options;
  const isNamed = width >= NAMED_FROM;
  const right = isNamed ? NAMES : RIGHT;
  const context = fitted(canvas, width, height);
  context.font = "12px system-ui, sans-serif";
  context.clearRect(0, 0, width, height);

  const scale = scaleOf(lines.flatMap(({ values }) => values.filter((value) => value !== null)), logarithmic);
  const x = (place: number): number => LEFT + (place / Math.max(steps - 1, 1)) * (width - LEFT - right);
  const y = (value: number): number => height - BOTTOM - scale.at(value) * (height - TOP - BOTTOM);

  context.strokeStyle = grid;
  context.fillStyle = muted;
  context.lineWidth = 1;
  context.textAlign = "right";
  context.textBaseline = "middle";
  for (const tick of scale.ticks) {
    const level = Math.round(y(tick)) + 0.5;
    line(context, LEFT, level, width - right, level);
    context.fillText(formatTick(tick), LEFT - 8, level);
  }
  context.textAlign = "center";
  context.textBaseline = "top";
  const every = niceStep(steps / Math.max(Math.floor((width - LEFT - right) / 80), 1));
  for (let step = Math.ceil(first / every) * every; step < first + steps; step += every) {
    context.fillText(formatTick(step), x(step - first), height - BOTTOM + 8);
  }
  context.textAlign = "right";
  context.fillText("step", width - right, height - 13);
  context.textAlign = "left";
  context.fillStyle = ink;
  context.fillText(`↑ ${label}${logarithmic ? ", logarithmic" : ""}`, 0, 4);

  context.lineJoin = "round";
  context.lineWidth = 2;
  const ends: { name: string; color: string; x: number; y: number }[] = [];
  for (const { name, color, values } of lines) {
    context.strokeStyle = color;
    context.beginPath();
    let pen = false;
    values.forEach((value, place) => {
      if (value === null || (logarithmic && value <= 0)) pen = false;
      else if (pen) context.lineTo(x(place), y(value));
      else {
        context.moveTo(x(place), y(value));
        pen = true;
      }
    });
    context.stroke();
    // The newest value: all that there is at first.
    const last = values.length - 1;
    const newest = values[last];
    if (newest == null || (logarithmic && newest <= 0)) continue;
    context.fillStyle = color;
    context.beginPath();
    context.arc(x(last), y(newest), 3, 0, 2 * Math.PI);
    context.fill();
    if (isNamed) ends.push({ name, color, x: x(last) + 8, y: y(newest) });
  }
  // From the top down, each at least a line below the one before.
  context.textBaseline = "middle";
  let level = -Infinity;
  for (const end of ends.sort((a, b) => a.y - b.y)) {
    level = Math.max(end.y, level + NAME_HEIGHT);
    context.fillStyle = end.color;
    context.fillText(end.name, end.x, level, width - end.x);
  }
}

/** Physical pixels for one CSS pixel; more than two cannot be seen and cost dearly. */
export const pixelRatio = (): number => Math.min(devicePixelRatio, 2);

/** The context of a canvas of this size in CSS pixels, sharp on this screen. */
export function fitted(canvas: HTMLCanvasElement, width: number, height: number): CanvasRenderingContext2D {
  const ratio = pixelRatio();
  const [wide, high] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== wide || canvas.height !== high) [canvas.width, canvas.height] = [wide, high];
  const context = canvas.getContext("2d");
  if (!context) throw new Error("This browser cannot draw on a canvas.");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return context;
}

interface Scale {
  /** From 0 at the bottom to 1 at the top. */
  at(value: number): number;
  readonly ticks: readonly number[];
}

function scaleOf(values: readonly number[], logarithmic: boolean): Scale {
  if (!logarithmic) {
    const most = Math.max(...values, 0) || 1;
    const step = niceStep(most / 4);
    const top = Math.ceil(most / step) * step;
    return { at: (value) => value / top, ticks: range(0, Math.round(top / step)).map((i) => i * step) };
  }
  const positive = values.filter((value) => value > 0);
  const low = Math.floor(Math.log10(Math.min(...positive, positive.length > 0 ? Infinity : 1)));
  const high = Math.max(Math.ceil(Math.log10(Math.max(...positive, 1e-9))), low + 1);
  const every = Math.ceil((high - low) / 6);
  return {
    at: (value) => (Math.log10(value) - low) / (high - low),
    ticks: range(0, Math.floor((high - low) / every)).map((i) => 10 ** (low + i * every)),
  };
}

const range = (from: number, to: number): number[] => Array.from({ length: to - from + 1 }, (_, i) => from + i);

/** The least of 1, 2, 5, 10, 20, 50, ... and their fractions that is not below `step`. */
function niceStep(step: number): number {
  const power = 10 ** Math.floor(Math.log10(step));
  return [1, 2, 5, 10].map((digit) => digit * power).find((nice) => nice >= step * 0.999) ?? step;
}

const compact = new Intl.NumberFormat("en", { notation: "compact", maximumSignificantDigits: 3 });
const formatTick = (value: number): string => compact.format(Number(value.toPrecision(6)));

function line(context: CanvasRenderingContext2D, x0: number, y0: number, x1: number, y1: number): void {
  context.beginPath();
  context.moveTo(x0, y0);
  context.lineTo(x1, y1);
  context.stroke();
}
