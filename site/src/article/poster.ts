// The first picture of a demo as a drawing in the page: for slow starts, for print, and where there are no scripts.
// It is drawn when the site is built, from the same compiled simulation that the demo runs.

import { readFileSync } from "node:fs";
import { Simulation } from "../../../classroom/simulation/wasm/simulation.js";

const WIDTH = 600;
await Simulation.load(readFileSync(new URL("../../../classroom/demo/dist/simulation.wasm", import.meta.url)));

type Ball = readonly [x: number, y: number, radius: number];

/** Puts its poster into each `<sap-demo ...></sap-demo>` of a page. */
export function withPosters(page: string): string {
  return page.replace(/<sap-demo([^>]*)><\/sap-demo>/g, (_, attributes: string) => `<sap-demo${attributes}>${poster(attributes)}</sap-demo>`);
}

function poster(attributes: string): string {
  const attribute = (name: string): string | undefined => new RegExp(`\\b${name}="([^"]*)"`).exec(attributes)?.[1];
  const height = /\bstrip\b/.test(attributes) ? 160 : 400;
  const balls = ballsOf(attribute("balls") ?? "5", Number(attribute("seed") ?? 1), height);
  const walls = attribute("walls")?.split(",").map(Number) ?? [];
  const labels = attribute("labels")?.split(",") ?? [];
  const isRainbow = /\brainbow\b/.test(attributes);
  const discs = balls.map(([x, y, radius], ball) => {
    if (walls.includes(ball)) return `<rect x="${x - radius}" y="0" width="${2 * radius}" height="${height}"/>`;
    const fill = isRainbow ? ` style="fill:oklch(0.78 0.13 ${Math.round((360 * ball) / balls.length + 20)})"` : "";
    const label = labels.length === balls.length ? `<text x="${x}" y="${y}" dy=".35em"${isRainbow ? ' style="fill:#1c2126"' : ""}>${labels[ball]}</text>` : "";
    return `<circle cx="${x}" cy="${y}" r="${radius}"${fill}/>${label}`;
  });
  const links = overlapping(walls.length > 0 || /\bpredict\b/.test(attributes) ? [] : balls).map(([[ax, ay], [bx, by]]) => `M${ax} ${ay}L${bx} ${by}`);
  return `<svg class="poster" viewBox="0 0 ${WIDTH} ${height}" aria-hidden="true">${discs.join("")}<path d="${links.join("")}"/></svg>`;
}

/** Given balls, or random ones as `classroom/demo/src/element/world.ts` makes them. */
function ballsOf(text: string, seed: number, height: number): Ball[] {
  const rounded = (value: number): number => Math.round(value * 10) / 10;
  if (text.startsWith("[")) return (JSON.parse(text) as number[][]).map(([x = 0, y = 0, radius = 0]) => [x, y, radius]);
  const bodies = Number(text);
  const size = Math.min(height / 10, Math.sqrt((0.2 * WIDTH * height) / (Math.PI * bodies)));
  const simulation = new Simulation({ scene: "bouncing", bodies, size, spread: 2, seed, width: WIDTH, height, counting: false });
  const { positions, radii } = simulation;
  const balls = Array.from(radii, (radius, ball): Ball => [rounded(positions[2 * ball]!), rounded(positions[2 * ball + 1]!), rounded(radius)]);
  simulation.free();
  return balls;
}

/** The pairs whose boxes overlap. */
function overlapping(balls: readonly Ball[]): [Ball, Ball][] {
  return balls.flatMap((a, at) =>
    balls.slice(at + 1).flatMap((b): [Ball, Ball][] => (Math.max(Math.abs(a[0] - b[0]), Math.abs(a[1] - b[1])) <= a[2] + b[2] ? [[a, b]] : [])),
  );
}
