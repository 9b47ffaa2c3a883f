// The first picture of a demo as a drawing in the page: for slow starts, for print, and where there are no scripts.
// It is drawn when the site is built, of the world that the demo itself begins with.

import { readFileSync } from "node:fs";
import { readOptions, WIDTH } from "../../../classroom/demo/src/element/options.ts";
import { addVariants } from "../../../classroom/demo/src/element/variants.ts";
import { World } from "../../../classroom/demo/src/element/world.ts";
import { Simulation } from "../../../classroom/simulation/wasm/simulation.js";
import { broken } from "../classroom/broken.ts";
import type { Attributes } from "../shell/tags.ts";
import { round } from "../svg.ts";

await Simulation.load(readFileSync(new URL("../../../classroom/demo/dist/simulation.wasm", import.meta.url)));
addVariants(broken);

type Ball = readonly [x: number, y: number, radius: number];

/** The poster of a demo with these attributes. */
export function poster(attributes: Attributes): string {
  const { world: begin, labels, isRainbow, predicts } = readOptions((name) => attributes[name] ?? null);
  const { height, walls } = begin;
  const world = new World(begin);
  const positions = world.positions();
  const balls = Array.from(world.radii, (radius, ball): Ball => [round(positions[2 * ball]!), round(positions[2 * ball + 1]!), round(radius)]);
  world.free();
  const discs = balls.map(([x, y, radius], ball) => {
    if (walls.includes(ball)) return `<rect x="${x - radius}" y="0" width="${2 * radius}" height="${height}"/>`;
    const fill = isRainbow ? ` style="fill:oklch(0.78 0.13 ${Math.round((360 * ball) / balls.length + 20)})"` : "";
    const label = labels?.length === balls.length ? `<text x="${x}" y="${y}" dy=".35em"${isRainbow ? ' style="fill:#1c2126"' : ""}>${labels![ball]}</text>` : "";
    return `<circle cx="${x}" cy="${y}" r="${radius}"${fill}/>${label}`;
  });
  const links = overlapping(walls.length > 0 || predicts ? [] : balls).map(([[ax, ay], [bx, by]]) => `M${ax} ${ay}L${bx} ${by}`);
  return `<svg class="poster" viewBox="0 0 ${WIDTH} ${height}" aria-hidden="true">${discs.join("")}<path d="${links.join("")}"/></svg>`;
}

/** The pairs whose boxes overlap. */
function overlapping(balls: readonly Ball[]): [Ball, Ball][] {
  return balls.flatMap((a, at) =>
    balls.slice(at + 1).flatMap((b): [Ball, Ball][] => (Math.max(Math.abs(a[0] - b[0]), Math.abs(a[1] - b[1])) <= a[2] + b[2] ? [[a, b]] : [])),
  );
}
