import { html, type TemplateResult } from "lit";
import { hasFlags } from "./detection.js";
import type { Detecting } from "./options.js";
import type { Counts } from "./run.js";

/** What a counter is called. */
const names = {
  tests: "tests",
  flagChecks: "flag checks",
  axisOverlaps: "axis overlaps",
  pairs: "pairs",
  comparisons: "comparisons",
  swaps: "swaps",
} as const satisfies Record<keyof Counts, string>;

/** The counters that apply to a method: flags take the place of tests, and some methods sweep or sort nothing. */
function countersOf(detecting: Detecting): (keyof Counts)[] {
  const { like, sort } = detecting;
  const isPairwise = like.includes("pairwise");
  const sorts = like !== "global pairwise";
  // The moves of other sorts are not swaps.
  const swaps = like.startsWith("swap-driven") || sort === "insertion sort" || sort === "quicksort";
  const shown: [keyof Counts, boolean][] = [
    ["tests", !hasFlags(detecting)],
    ["flagChecks", hasFlags(detecting)],
    ["axisOverlaps", !isPairwise],
    ["pairs", true],
    ["comparisons", sorts],
    ["swaps", sorts && swaps],
  ];
  return shown.flatMap(([key, applies]) => (applies ? [key] : []));
}

/** The work of a method, which is the first of its counters, and what that counts. */
export function workOf(detecting: Detecting, counts: Counts): { readonly count: number; readonly name: string } {
  const key = hasFlags(detecting) ? "flagChecks" : "tests";
  return { count: counts[key], name: names[key] };
}

/** Numbers with their names, which are short enough for a phone. Before there is a method, their place. */
export function counters(counts: Counts, detecting: Detecting | undefined): TemplateResult {
  return html`<dl class="counters" part="counters">
    ${(detecting ? countersOf(detecting) : []).map(
      (key) => html`<div><dt>${names[key]}</dt><dd data-counter=${names[key].replace(" ", "-")}>${counts[key].toLocaleString("en")}</dd></div>`,
    )}
  </dl>`;
}
