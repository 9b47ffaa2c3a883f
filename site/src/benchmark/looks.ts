// What each library is drawn with. It is the same in every plot of a page, whatever else is in it.

import type { Entry } from "./results.ts";
import { PLAIN } from "./results.ts";

export interface Look {
  readonly color: string;
  /** As of an SVG stroke; none for a full line. */
  readonly dash: string;
  /** Of the line; 0 where there is none. */
  readonly width: number;
  readonly symbol: "circle" | "square" | "triangle" | "diamond" | "star" | "cross" | "wye";
  /** Or an outline. */
  readonly isFull: boolean;
}

export type Looks = (name: string) => Look;

export const COLORS = 8;
/** One fewer than colors, so that two lines of one color have different symbols. */
const SYMBOLS = ["square", "triangle", "diamond", "star", "cross", "wye", "circle"] as const;
const DASHES = ["7 4", "2 3", "10 3 2 3", "4 2", "1 5"] as const;

/** Lines of sweep-and-prune are thick and in one color, each with its dash; alternatives have colors and symbols. */
export function looksOf(libraries: readonly Pick<Entry, "name" | "alternative">[]): Looks {
  const named = (of: (entry: Pick<Entry, "name" | "alternative">) => boolean): string[] => [...new Set(libraries.filter(of).map(({ name }) => name))];
  const own = named(({ alternative }) => !alternative);
  const alternatives = named(({ name, alternative }) => alternative && !PLAIN.test(name));
  return (name) => {
    const mine = own.indexOf(name);
    if (mine === 0) return { color: "var(--line-own)", dash: "", width: 3.5, symbol: "circle", isFull: true };
    if (mine > 0) {
      const at = mine - 1;
      return { color: "var(--line-own)", dash: DASHES[at % DASHES.length] ?? "", width: 2.25, symbol: SYMBOLS[at % SYMBOLS.length] ?? "circle", isFull: false };
    }
    if (PLAIN.test(name)) return { color: "var(--ink)", dash: "2 4", width: 1.75, symbol: "circle", isFull: false };
    const at = alternatives.indexOf(name);
    return { color: `var(--line-${(at % COLORS) + 1})`, dash: "", width: 1.5, symbol: SYMBOLS[at % SYMBOLS.length] ?? "circle", isFull: true };
  };
}
