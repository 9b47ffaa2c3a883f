// What the benchmark page says first, written when the site is built: one sentence, and sweep-and-prune beside five
// alternatives that many people know, in each language, from the newest recorded runs.

import { type Case, duration, fastestAlternative, fastestOwn, PLAIN, type Run, significant, timesOf } from "./results.ts";

/** The case that is shown. */
const SHOWN = { scene: "uniform", dimensions: 2, boxes: 10_000 };

/** The alternatives that are shown, by their names in the results. */
const WELL_KNOWN: Readonly<Record<Run["kind"], Readonly<Record<string, string>>>> = {
  native: { "PhysX ABP": "PhysX", rstar: "rstar", "Boost.Geometry": "Boost.Geometry", parry: "Parry", CGAL: "CGAL" },
  javascript: { flatbush: "flatbush", rbush: "rbush", "matter-js": "Matter.js", "box-intersect": "box-intersect", "rapier 2D, SIMD": "Rapier" },
};

/** The page with the sentence and the two tables; without them where no run was kept. */
export function insertFront(page: string, runs: readonly Run[]): string {
  const { sentence, tables } = front(runs) ?? { sentence: "How fast is sweep-and-prune compared with other libraries? Measure it here.", tables: "" };
  return page.replace("<benchmark-sentence></benchmark-sentence>", () => sentence).replace("<benchmark-front></benchmark-front>", () => tables);
}

function front(runs: readonly Run[]): { sentence: string; tables: string } | undefined {
  const shown = (["native", "javascript"] as const).flatMap((kind) => {
    const run = runs.find((run) => run.kind === kind);
    const one = run?.cases.find(({ scene, dimensions, boxes }) => scene === SHOWN.scene && dimensions === SHOWN.dimensions && boxes === SHOWN.boxes);
    return run && one ? [{ kind, run, one }] : [];
  });
  if (shown.length === 0) return undefined;
  const parts = shown.map(({ kind, one }) => {
    const fastest = fastestAlternative(one);
    const language = kind === "native" ? "Rust" : "JavaScript";
    return `in ${language} in ${duration(fastestOwn(one) ?? NaN)}, ${significant(fastest?.ratio ?? NaN)} times faster than the fastest alternative (${fastest?.name ?? "none"})`;
  });
  const { machine, date } = shown[0]!.run;
  const sentence = `sweep-and-prune finds all overlapping pairs among ${SHOWN.boxes.toLocaleString("en")} boxes ${parts.join(", and ")}.`;
  const tables = `
    <div class="fronts">${shown.map(({ kind, one }) => table(kind, one)).join("")}</div>
    <p class="note">
      Time of one call, from raw boxes to stored pairs, on one thread; lower is better. The scene is “${SHOWN.scene}” in 2D:
      ${SHOWN.boxes.toLocaleString("en")} random boxes, ${shown[0]!.one.pairs.toLocaleString("en")} pairs. ${machine.cpu}, ${date}.
      <a href="#here-heading">Measure in your own browser</a>, or see <a href="#recorded-heading">all libraries and scenes</a>.
    </p>`;
  return { sentence, tables };
}

function table(kind: Run["kind"], one: Case): string {
  const own = fastestOwn(one) ?? NaN;
  const named = (name: string): number | undefined => {
    const entry = one.results.find((entry) => entry.name === name);
    return entry && timesOf(entry)?.median_ns;
  };
  const rows = Object.entries(WELL_KNOWN[kind]).flatMap(([name, label]) => {
    const time = named(name);
    return time === undefined ? [] : [{ label, time, is: "" }];
  });
  const plain = one.results.find(({ name }) => PLAIN.test(name));
  const plainTime = plain && timesOf(plain)?.median_ns;
  rows.sort((a, b) => a.time - b.time);
  const longest = Math.max(...rows.map(({ time }) => time));
  const all = [{ label: "sweep-and-prune", time: own, is: "own" }, ...rows, ...(plainTime ? [{ label: "no library: a plain sweep", time: plainTime, is: "plain" }] : [])];
  const lines = all.map(
    ({ label, time, is }) =>
      `<tr class="${is}"><th scope="row">${label}</th><td class="bar" aria-hidden="true"><span style="width: ${Math.min(100, Math.max(0.5, (100 * time) / longest)).toFixed(1)}%"></span></td><td>${duration(time)}</td><td>${is === "own" ? "" : `× ${significant(time / own)}`}</td></tr>`,
  );
  const title = kind === "native" ? "Rust and C++" : "JavaScript";
  return `<table><caption>${title}</caption><thead class="visually-hidden"><tr><th scope="col">Library</th><td></td><th scope="col">Time</th><th scope="col">Times as long as sweep-and-prune</th></tr></thead><tbody>${lines.join("")}</tbody></table>`;
}
