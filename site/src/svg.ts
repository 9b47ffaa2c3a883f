// What all figures are drawn with. Colors are classes of article.css, so that a figure is light or
// dark with its page.

import type { Box } from "./box.ts";

/** A whole figure. `description` says what it shows, for readers who do not see it. */
export function svg(name: string, width: number, height: number, description: string, inside: string): string {
  return `<svg class="figure" data-figure="${name}" viewBox="0 0 ${width} ${height}" width="${width}" height="${height}" role="img" aria-label="${description}">${inside}</svg>`;
}

/** What a shape is, and the box of the figures in whose color it is drawn, if so. */
const drawn = (kind: string, box?: number): string => `class="${kind}"${box === undefined ? "" : ` style="--body:var(--figure-${box})"`}`;

export const line = (x1: number, y1: number, x2: number, y2: number, kind: string, box?: number): string =>
  `<line x1="${round(x1)}" y1="${round(y1)}" x2="${round(x2)}" y2="${round(y2)}" ${drawn(kind, box)}/>`;

export const rect = ({ left, top, right, bottom }: Omit<Box, "id">, kind: string, box?: number): string =>
  `<rect x="${round(left)}" y="${round(top)}" width="${round(right - left)}" height="${round(bottom - top)}" ${drawn(kind, box)}/>`;

export const text = (x: number, y: number, words: string | number, kind = "label", anchor: "start" | "middle" | "end" = "middle"): string =>
  `<text x="${round(x)}" y="${round(y)}" text-anchor="${anchor}" class="${kind}">${words}</text>`;

export const path = (points: readonly (readonly [x: number, y: number])[], kind: string, box?: number): string =>
  `<path d="M${points.map(([x, y]) => `${round(x)} ${round(y)}`).join("L")}" ${drawn(kind, box)}/>`;

/** A box with its letter. */
export const body = (box: Box, kind = "body"): string =>
  rect(box, kind, box.id) + text((box.left + box.right) / 2, (box.top + box.bottom) / 2 + 6, letter(box.id), "name");

/** Letters for the first of boxes. */
export const letter = (id: number): string => String.fromCharCode(65 + id);

export function round(value: number): number {
  return Math.round(value * 10) / 10;
}
