// What a swap of two neighbors in the endpoint array means.

import { line, svg, text } from "./svg.ts";

const CASES = [
  { before: "A)  (B", after: "(B  A)", one: [10, 60], two: [75, 125], moved: [40, 90], says: "an overlap begins" },
  { before: "(A  B)", after: "B)  (A", one: [60, 110], two: [15, 80], moved: [92, 142], says: "an overlap ends" },
  { before: "(A  (B", after: "(B  (A", one: [15, 125], two: [35, 105], moved: [50, 140], says: "nothing changes" },
  { before: "A)  B)", after: "B)  A)", one: [44, 96], two: [35, 105], moved: [62, 114], says: "nothing changes" },
] as const;

/** The four cases: before, after, and what follows. A moves right. */
export function swapCases(): string {
  const rows = CASES.map(({ one, two, moved, before, after, says }, row) => {
    const y = 20 + 92 * row;
    const picture = (x: number, a: readonly [number, number]): string =>
      line(x + a[0], y, x + a[1], y, "bar body-0") + text(x + a[0] - 5, y + 5, "A", "label small", "end") +
      line(x + two[0], y + 22, x + two[1], y + 22, "bar body-1") + text(x + two[0] - 5, y + 27, "B", "label small", "end");
    return (
      picture(10, one) + text(190, y + 16, "→", "label") + picture(220, moved) +
      text(85, y + 52, before, "mono") + text(295, y + 52, after, "mono") +
      text(375, y + 16, says, "label", "start")
    );
  });
  return svg(
    "swap-cases",
    570,
    352,
    `Four swaps of neighbors. ${CASES.map(({ before, after, says }) => `${before} becomes ${after}: ${says}`).join(". ")}.`,
    rows.join(""),
  );
}
