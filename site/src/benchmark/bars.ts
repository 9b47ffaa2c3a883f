// A table of libraries with their times as bars: in the page, and for what is measured in the browser.

import { duration, type Entry, fastest, fastestOwn, PLAIN, significant, timed, type Case } from "./results.ts";

/** The shortest bar, in percent; the longest is 100. */
const SHORTEST = 6;

/** A case as a table: sweep-and-prune first, then the others from the fastest on, and what was not timed. `labels` are names that people know. */
export function bars(one: Case, caption: string, entries: readonly Entry[], labels: Readonly<Record<string, string>> = {}): string {
  const own = fastestOwn(one) ?? NaN;
  const first = fastest(one);
  const ranked = timed(entries).map((entry) => ({ ...entry, isOwn: !entry.alternative && !PLAIN.test(entry.name) }));
  ranked.sort((a, b) => Number(b.isOwn) - Number(a.isOwn));
  const all = ranked.map(({ ns }) => ns);
  const [least, most] = [Math.min(...all), Math.max(...all)];
  // Logarithmic: one slow library would leave nothing of the other bars.
  const width = (ns: number): number => (most > least ? SHORTEST + ((100 - SHORTEST) * Math.log(ns / least)) / Math.log(most / least) : 100);
  const rows = ranked.map(({ name, isOwn, ns }) => {
    const ratio = isOwn || Number.isNaN(own) ? "" : `× ${significant(ns / own)}`;
    const last = name === first ? `${ratio} fastest` : ratio;
    const label = labels[name] ?? (PLAIN.test(name) ? "no library: a plain sweep" : name);
    const kind = isOwn ? "own" : PLAIN.test(name) ? "plain" : "";
    return `<tr class="${kind}" data-library="${name}"><th scope="row">${label.replace(/[._]/g, "$&<wbr>")}</th><td class="bar" aria-hidden="true"><span style="width: ${width(ns).toFixed(1)}%"></span></td><td>${duration(ns)}</td><td>${last}</td></tr>`;
  });
  const untimed = entries.flatMap(({ name, outcome }) =>
    "Untimed" in outcome ? [`<tr data-library="${name}"><th scope="row">${labels[name] ?? name}</th><td colspan="3" class="why quiet">${outcome.Untimed.why}</td></tr>`] : [],
  );
  return `<table><caption>${caption}</caption><thead class="visually-hidden"><tr><th scope="col">Library</th><td></td><th scope="col">Time</th><th scope="col">Times as long as sweep-and-prune</th></tr></thead><tbody>${[...rows, ...untimed].join("")}</tbody></table>`;
}
