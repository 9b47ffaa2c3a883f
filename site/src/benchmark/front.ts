// What the benchmark page says first, written when the site is built: one sentence, and sweep-and-prune beside five
// alternatives that many people know, in each language, from the recorded run in which most was measured.

import { REPOSITORY } from "../shell/pages.ts";
import { bars } from "./bars.ts";
import { type Case, duration, type Entry, fastestOther, fastestOwn, PLAIN, type Run, significant } from "./results.ts";

/** The case that is shown. */
const SHOWN = { scene: "uniform", dimensions: 2, boxes: 10_000 };

/** The alternatives that are shown, by their names in the results. */
const WELL_KNOWN: Readonly<Record<Run["kind"], Readonly<Record<string, string>>>> = {
  native: { "PhysX ABP": "PhysX", rstar: "rstar", "Boost.Geometry": "Boost.Geometry", parry: "Parry", CGAL: "CGAL" },
  javascript: { flatbush: "flatbush", rbush: "rbush", "matter-js": "Matter.js", "box-intersect": "box-intersect", "rapier 2D, SIMD": "Rapier" },
};

/** What the page has where no run was kept. */
const NOTHING = { sentence: "How fast is sweep-and-prune compared with other libraries? Measure it here.", tables: "" };

/** The sentence and the two tables. */
export function front(runs: readonly Run[]): { sentence: string; tables: string } {
  const shown = (["native", "javascript"] as const).flatMap((kind) => {
    const run = runs.find((run) => run.kind === kind);
    const one = run?.cases?.find(({ scene, dimensions, boxes }) => scene === SHOWN.scene && dimensions === SHOWN.dimensions && boxes === SHOWN.boxes);
    return run && one ? [{ kind, run, one }] : [];
  });
  if (shown.length === 0) return NOTHING;
  const parts = shown.map(({ kind, one }) => {
    const other = fastestOther(one);
    const language = kind === "native" ? "Rust" : "JavaScript";
    return `in ${language} in ${duration(fastestOwn(one) ?? NaN)}, ${significant(other?.ratio ?? NaN)} times faster than the fastest alternative (${other?.name ?? "none"})`;
  });
  const measured = shown.map(({ kind, run, one }) => {
    const what = `${one.pairs.toLocaleString("en")} pairs; ${run.machine.cpu}, ${run.date}`;
    return kind === "native" ? `Rust and C++: ${what}` : `JavaScript: ${what}`;
  });
  const sentence = `sweep-and-prune finds all overlapping pairs among ${SHOWN.boxes.toLocaleString("en")} boxes ${parts.join(", and ")}.`;
  const tables = `
    <div class="fronts">${shown.map(({ kind, one }) => bars(one, kind === "native" ? "Rust and C++" : "JavaScript", entriesOf(kind, one), WELL_KNOWN[kind])).join("")}</div>
    <p class="quiet">
      Time of one call, from raw boxes to stored pairs, on one thread; lower is better, and the bars are logarithmic. The scene is “${SHOWN.scene}” in 2D:
      ${SHOWN.boxes.toLocaleString("en")} random boxes. ${measured.join(". ")}.
      <a href="#here-heading">Measure in your own browser</a>, or see <a href="${REPOSITORY}/blob/main/bench/RESULTS.md">all libraries and scenes</a>.
    </p>`;
  return { sentence, tables };
}

/** Sweep-and-prune, the well-known alternatives, a plain sweep, and the fastest of all others, which the sentence names. */
function entriesOf(kind: Run["kind"], one: Case): Entry[] {
  const named = new Set([...Object.keys(WELL_KNOWN[kind]), "sweep-and-prune", fastestOther(one)?.name]);
  return one.results.filter(({ name }) => named.has(name) || PLAIN.test(name));
}
