// What a swap of two neighbors in the endpoint array means.

import { letter, line, rect, svg, text } from "./svg.ts";

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

/** One right endpoint carried over three left endpoints: a small sweep line of its own. */
export function miniSweep(): string {
  const others = [
    { left: 210, right: 330 },
    { left: 260, right: 440 },
    { left: 330, right: 400 },
    { left: 430, right: 520 },
  ];
  const [from, to] = [170, 370];
  const met = others.filter(({ left }) => left > from && left <= to);
  const bars = others.map(({ left, right }, at) => {
    const y = 70 + 24 * at;
    const highlighted = left <= to;
    return line(left, y, right, y, `bar body-${at + 1}${highlighted ? "" : " later"}`) + text(right + 10, y + 5, letter(at + 1), "label small", "start") +
      (highlighted ? `<circle cx="${left}" cy="${y}" r="6" class="hit"/>` : "");
  });
  return svg(
    "mini-sweep",
    560,
    190,
    `The right endpoint of A moves from left to right and passes the left endpoints of ${met.length} boxes; each time two endpoints swap, and an overlap begins.`,
    rect({ left: from, top: 20, right: to, bottom: 156 }, "mark") +
      line(40, 36, from, 36, "bar body-0") + line(from, 36, to, 36, "bar body-0 grown") + text(30, 41, "A", "label small", "end") +
      line(to, 16, to, 160, "sweep") + bars.join("") + line(from, 174, to, 174, "arrow") +
      text((from + to) / 2, 190, `${met.length} swaps, ${met.length} overlaps begin`),
  );
}
