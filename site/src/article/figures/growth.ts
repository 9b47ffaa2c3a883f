// How work grows with the number of boxes: the pairs, and the operations measured in docs/.

import complexity from "../../../../docs/complexity.json" with { type: "json" };
import { line, path, svg, text } from "./svg.ts";

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
  { method: "global pairwise", sort: null, world: "square", name: "global pairwise" },
  { method: "sorted pairwise", sort: "insertion sort", world: "square", name: "sorted pairwise" },
  { method: "swap-driven sweep", sort: null, world: "square", name: "swap-driven, one axis" },
  { method: "swap-driven sweep on every axis", sort: null, world: "square", name: "swap-driven, every axis" },
] as const;

/** Operations per frame against the number of boxes, both as powers, in a square world that moves a little. */
export function measured(): string {
  const [left, top, width, height] = [64, 16, 300, 280];
  const x = (n: number): number => left + (width * (Math.log2(n) - 8)) / 8;
  const y = (operations: number): number => top + height - (height * (Math.log10(operations) - 2.5)) / 6;
  const grid = [
    ...[256, 4096, 65536].map((n) => line(x(n), top, x(n), top + height, "grid") + text(x(n), top + height + 20, count(n), "label small")),
    ...[3, 4, 5, 6, 7, 8].map((power) => line(left, y(10 ** power), left + width, y(10 ** power), "grid") + text(left - 8, y(10 ** power) + 4, short(10 ** power), "label small", "end")),
  ];
  const curves = CURVES.map(({ method, sort, world, name }, at) => {
    const variant = complexity.variants.find((found) => found.method === method && (found.sort ?? null) === sort);
    const row = variant?.rows.find((found) => found.world === world);
    if (!row) throw new Error(`docs/complexity.json has no ${method} in a ${world}`);
    const points = row.n.map((n, i) => [x(n), y(row.operations[i] as number)] as const);
    const [endX, endY] = points.at(-1) as readonly [number, number];
    return { drawn: path(points, `curve curve-${at}`), endX, endY, name, slope: row.slope };
  });
  // Labels stand in a column at the right, in the order of the curves and far enough apart.
  let below = -Infinity;
  const labels = [...curves.entries()]
    .sort(([, a], [, b]) => a.endY - b.endY)
    .map(([at, { endX, endY, name, slope }]) => {
      below = Math.max(endY, below + 54);
      return line(endX + 3, endY, left + width + 12, below, "leader") +
        text(left + width + 18, below + 1, name, `label curve-name-${at}`, "start") +
        text(left + width + 18, below + 24, `grows like n^${slope.toFixed(2)}`, "label small", "start");
    });
  return svg(
    "measured",
    660,
    340,
    `Operations per frame against the number of boxes in a square world that moves a little, on logarithmic scales. ${curves.map(({ name, slope }) => `${name} grows like n to the power ${slope.toFixed(2)}`).join("; ")}.`,
    grid.join("") + curves.map(({ drawn }) => drawn).join("") + labels.join("") + text(left + width / 2, top + height + 38, "number of boxes", "label small") + text(left + 8, top + 14, "operations", "label small", "start"),
  );
}
