// Boxes and their shadows on the axes.

import type { Box } from "../../box.ts";
import { overlaps } from "../../listings/overlaps.js";
import { body, letter, line, rect, svg, text } from "../../svg.ts";

/** Two boxes that overlap on one axis only, and their shadows. */
export function boxTest(): string {
  const boxes: Box[] = [
    { id: 0, left: 90, top: 30, right: 250, bottom: 110 },
    { id: 1, left: 200, top: 140, right: 330, bottom: 210 },
  ];
  const [a, b] = boxes as [Box, Box];
  if (overlaps(a, b)) throw new Error("they are meant to be apart");
  const shadows = boxes.map((box, at) =>
    [
      line(box.left, 250 + 14 * at, box.right, 250 + 14 * at, "bar", at),
      line(40 - 14 * at, box.top, 40 - 14 * at, box.bottom, "bar", at),
    ].join(""),
  );
  const both = rect({ left: b.left, top: 236, right: a.right, bottom: 276 }, "mark");
  const gap = rect({ left: 14, top: a.bottom, right: 54, bottom: b.top }, "gap");
  return svg(
    "box-test",
    400,
    300,
    "Box A lies above and to the left of box B. Their shadows on the horizontal axis overlap; those on the vertical axis do not, so the boxes are apart.",
    both + gap + boxes.map((box) => body(box)).join("") + shadows.join("") +
      text(225, 294, "overlap on x") + text(62, 130, "apart on y", "label", "start"),
  );
}

/** Three boxes in a row: two gaps, and the third that follows from them. */
export function transitivity(): string {
  const boxes: Box[] = [
    { id: 0, left: 10, top: 60, right: 130, bottom: 140 },
    { id: 1, left: 200, top: 20, right: 320, bottom: 110 },
    { id: 2, left: 395, top: 50, right: 510, bottom: 150 },
  ];
  const gaps = [0, 1].map((at) => {
    const [one, next] = [boxes[at] as Box, boxes[at + 1] as Box];
    return rect({ left: one.right, top: 170, right: next.left, bottom: 186 }, "gap") +
      text((one.right + next.left) / 2, 202, `${letter(at)} ends first`, "label small");
  });
  const [a, , c] = boxes as [Box, Box, Box];
  const whole = line(a.right, 222, c.left, 222, "arrow") + text((a.right + c.left) / 2, 240, "so A ends before C begins: no test needed");
  const bars = boxes.map(({ id, left, right }) => line(left, 178, right, 178, "bar", id)).join("");
  return svg(
    "transitivity",
    520,
    252,
    "Boxes A, B and C from left to right, with a gap between A and B and a gap between B and C. So there is one between A and C.",
    boxes.map((box) => body(box)).join("") + gaps.join("") + bars + whole,
  );
}
