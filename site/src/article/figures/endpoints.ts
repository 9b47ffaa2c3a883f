// The endpoint array, and the line that sweeps over it: both as the listings make them.

import type { Box } from "../../box.ts";
import { endpointsOf } from "../../listings/endpoints.js";
import { quicksort } from "../../listings/quicksort.js";
import { sweep } from "../../listings/sweep.js";
import { body, letter, line, rect, svg, text } from "../../svg.ts";

const BOXES: readonly Box[] = [
  { id: 0, left: 30, top: 20, right: 190, bottom: 85 },
  { id: 1, left: 130, top: 100, right: 240, bottom: 165 },
  { id: 2, left: 215, top: 30, right: 395, bottom: 120 },
  { id: 3, left: 300, top: 135, right: 350, bottom: 175 },
  { id: 4, left: 430, top: 60, right: 530, bottom: 150 },
];
const WIDTH = 560;
const FLOOR = 190;

function sorted(): { box: Box; isLeft: boolean; at: number }[] {
  const endpoints = endpointsOf(BOXES);
  quicksort(endpoints);
  return endpoints;
}

const bodies = (highlighted: readonly Box[] = []): string => BOXES.map((box) => body(box, highlighted.includes(box) ? "body highlighted" : "body")).join("");

export function endpointArray(): string {
  const entries = sorted();
  const step = WIDTH / entries.length;
  const drawn = entries.map(({ box, isLeft, at }, place) => {
    const x = step * (place + 0.5);
    return (
      line(at, box.top, at, FLOOR, "drop") +
      line(at, FLOOR, x, 222, "drop") +
      rect({ left: x - 20, top: 224, right: x + 20, bottom: 256 }, "cell", box.id) +
      text(x, 246, isLeft ? `(${letter(box.id)}` : `${letter(box.id)})`, "mono")
    );
  });
  return svg(
    "endpoint-array",
    WIDTH,
    262,
    `Five boxes, and under them their ten endpoints in order: ${entries.map(({ box, isLeft }) => (isLeft ? `(${letter(box.id)}` : `${letter(box.id)})`)).join(" ")}.`,
    drawn.join("") + bodies(),
  );
}

/** The moment at which the line enters the fourth box: what it touches, and what it has found. */
export function sweepLine(): string {
  const at = (BOXES[3] as Box).left;
  const inside = BOXES.filter(({ left, right }) => left <= at && right >= at);
  const pairs: string[] = [];
  sweep(sorted(), (a: Box, b: Box) => pairs.push(`${letter(a.id)}-${letter(b.id)}`));
  const bars = BOXES.map(({ id, left, right }) => line(left, FLOOR + 14 + 11 * id, right, FLOOR + 14 + 11 * id, left > at ? "bar later" : "bar", id));
  return svg(
    "sweep-line",
    WIDTH,
    280,
    `A vertical line has just entered box D and touches ${inside.map(({ id }) => letter(id)).join(" and ")}. Pairs found in the whole sweep: ${pairs.join(", ")}.`,
    bodies(inside) + bars.join("") + line(at, 6, at, 256, "sweep") +
      text(at + 6, 272, `touching = { ${inside.map(({ id }) => letter(id)).join(", ")} }`, "mono"),
  );
}
