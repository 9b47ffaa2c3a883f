// How work grows with the number of boxes: the pairs, and the operations measured in docs/.

import complexity from "../../../../docs/complexity.json" with { type: "json" };
import { letter, line, path, svg, text } from "../../svg.ts";

const count = new Intl.NumberFormat("en").format;
const short = new Intl.NumberFormat("en", { notation: "compact" }).format;

/** The pairs of few balls, as lines: 5, 10 and 20. */
export function allPairs(): string {
  const groups = [5, 10, 20].map((balls, group) => {
    const [x, y, radius] = [95 + 190 * group, 92, 74];
    const at = (ball: number): readonly [number, number] => {
      const angle = (2 * Math.PI * ball) / balls - Math.PI / 2;
      return [x + radius * Math.cos(angle), y + radius * Math.sin(angle)];
    };
    let pairs = 0;
    let lines = "";
    for (let a = 0; a < balls; a++) {
      for (let b = a + 1; b < balls; b++, pairs++) lines += line(...at(a), ...at(b), "pair");
    }
    const dots = Array.from({ length: balls }, (_, ball) => `<circle cx="${at(ball)[0].toFixed(1)}" cy="${at(ball)[1].toFixed(1)}" r="5" class="dot"/>`);
    return lines + dots.join("") + text(x, 194, `${balls} balls, ${pairs} pairs`);
  });
  return svg("all-pairs", 570, 204, "Rings of 5, 10 and 20 balls with a line for each pair: 10, 45 and 190 lines.", groups.join(""));
}

const CURVES = [
  { method: "global pairwise", sort: null, name: "global pairwise", color: 4 },
  { method: "sorted pairwise", sort: "insertion sort", name: "sorted pairwise", color: 3 },
  { method: "swap-driven sweep", sort: null, name: "swap-driven, one axis", color: 1 },
  { method: "swap-driven sweep on every axis", sort: null, name: "swap-driven, every axis", color: 0 },
] as const;

/** A plot of curves: where it lies, in units of the figure. */
interface Frame {
  readonly left: number;
  readonly top: number;
  readonly width: number;
  readonly height: number;
}

/**
 * Operations per frame against the number of boxes, both as powers, in a square world that moves a little: once with the
 * names beside the curves, and for narrow screens once with the names below.
 */
export function measured(): string {
  const wide: Frame = { left: 64, top: 16, width: 300, height: 280 };
  const narrow: Frame = { left: 46, top: 16, width: 284, height: 240 };
  const wideCurves = curvesIn(wide);
  // Labels stand in a column at the right, in the order of the curves and far enough apart.
  let below = -Infinity;
  const beside = wideCurves.map(({ endX, endY, name, slope }) => {
    below = Math.max(endY, below + 54);
    const x = wide.left + wide.width;
    return line(endX + 3, endY, x + 12, below, "leader") +
      text(x + 18, below + 1, name, "label", "start") +
      text(x + 18, below + 24, `grows like n^${slope.toFixed(2)}`, "label small", "start");
  });
  // A letter at the end of each curve leads to its name: color is not the only sign.
  let above = -Infinity;
  const ends = curvesIn(narrow).map(({ endX, endY, name, slope }, place) => {
    above = Math.max(endY, above + 15);
    const y = narrow.top + narrow.height + 66 + 26 * place;
    return text(endX + 12, above + 5, letter(place), "label strong") +
      text(4, y, letter(place), "label strong", "start") +
      text(24, y, `${name}: n^${slope.toFixed(2)}`, "label", "start");
  });
  const says = wideCurves.map(({ name, slope }) => `${name} grows like n to the power ${slope.toFixed(2)}`).join("; ");
  const description = `Operations per frame against the number of boxes in a square world that moves a little, on logarithmic scales. ${says}.`;
  const figure = (name: string, frame: Frame, width: number, height: number, labels: readonly string[]): string =>
    svg(name, width, height, description, gridIn(frame) + curvesIn(frame).map(({ drawn }) => drawn).join("") + labels.join(""));
  return figure("measured", wide, 660, 340, beside) + figure("measured-narrow", narrow, 350, 400, ends);
}

const xIn = ({ left, width }: Frame, n: number): number => left + (width * (Math.log2(n) - 8)) / 8;
const yIn = ({ top, height }: Frame, operations: number): number => top + height - (height * (Math.log10(operations) - 2.5)) / 6;

function gridIn(frame: Frame): string {
  const { left, top, width, height } = frame;
  return [
    ...[256, 4096, 65536].map((n) => line(xIn(frame, n), top, xIn(frame, n), top + height, "grid") + text(xIn(frame, n), top + height + 20, count(n), "label small")),
    ...[3, 4, 5, 6, 7, 8].map((power) => {
      const y = yIn(frame, 10 ** power);
      return line(left, y, left + width, y, "grid") + text(left - 8, y + 4, short(10 ** power), "label small", "end");
    }),
    text(left + width / 2, top + height + 38, "number of boxes", "label small"),
    text(left + 8, top + 14, "operations", "label small", "start"),
  ].join("");
}

/** The curves in a frame, the one that ends highest first. */
function curvesIn(frame: Frame): { drawn: string; endX: number; endY: number; name: string; slope: number }[] {
  const curves = CURVES.map(({ method, sort, name, color }) => {
    const variant = complexity.variants.find((found) => found.method === method && (found.sort ?? null) === sort);
    const row = variant?.rows.find((found) => found.world === "square");
    if (!row) throw new Error(`docs/complexity.json has no ${method} in a square`);
    const points = row.n.map((n, i) => [xIn(frame, n), yIn(frame, row.operations[i] as number)] as const);
    const [endX, endY] = points.at(-1) as readonly [number, number];
    return { drawn: path(points, "curve", color), endX, endY, name, slope: row.slope };
  });
  return curves.sort((a, b) => a.endY - b.endY);
}
