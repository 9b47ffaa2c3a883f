// The recorded results, in the format of bench/README.md as far as the page shows it.

type Outcome = { readonly Timed: { readonly median_ns: number } } | { readonly Untimed: { readonly why: string } };

export interface Entry {
  readonly name: string;
  /** Whether it is another library, not sweep-and-prune in some setting. */
  readonly alternative: boolean;
  readonly outcome: Outcome;
}

export interface Case {
  readonly scene: string;
  readonly dimensions: number;
  readonly boxes: number;
  readonly pairs: number;
  readonly reference: string;
  readonly results: readonly Entry[];
}

/** A file as it was kept. */
export interface Recorded {
  readonly date: string;
  readonly machine: { readonly cpu: string };
  readonly cases?: readonly Case[];
}

/** A file, and whose results it has. */
export interface Run extends Recorded {
  readonly kind: "native" | "javascript";
}

/** The sweep that a good developer writes in an hour: beside the alternatives, and not one of them. */
export const PLAIN = /^plain\b/;

/** The entries that were timed, the fastest first. */
export function timed(entries: readonly Entry[]): (Entry & { readonly ns: number })[] {
  return entries.flatMap((entry) => ("Timed" in entry.outcome ? [{ ...entry, ns: entry.outcome.Timed.median_ns }] : [])).sort((a, b) => a.ns - b.ns);
}

/** Settings that no alternative has: more threads, or the same boxes once more; and in JavaScript native code. */
const NOT_COMPARED = /^native|, (again|fresh|two at once|\d+ threads)$/;

/** The time of sweep-and-prune in ns, under the conditions of the alternatives: one thread, boxes in another order at each call. */
export function fastestOwn(one: Case): number | undefined {
  return timed(one.results).find((entry) => !entry.alternative && !NOT_COMPARED.test(entry.name))?.ns;
}

/** The name of the fastest library of a case, under the conditions of all: the one that tables mark and sentences name. */
export function fastest(one: Case): string | undefined {
  return timed(one.results).find(({ name }) => !NOT_COMPARED.test(name))?.name;
}

/** The fastest that is not sweep-and-prune, also if it is the plain sweep, and how many times as long it takes. */
export function fastestOther(one: Case): { name: string; ratio: number } | undefined {
  const own = fastestOwn(one);
  const first = timed(one.results).find((entry) => entry.alternative || PLAIN.test(entry.name));
  return first && own ? { name: first.name, ratio: first.ns / own } : undefined;
}

/** A number of nanoseconds with a unit that suits it. */
export function duration(ns: number): string {
  if (ns < 1e3) return `${significant(ns)} ns`;
  if (ns < 1e6) return `${significant(ns / 1e3)} µs`;
  if (ns < 1e9) return `${significant(ns / 1e6)} ms`;
  return `${significant(ns / 1e9)} s`;
}

export function significant(value: number): string {
  return value >= 100 ? value.toFixed(0) : String(Number(value.toPrecision(value >= 10 ? 3 : 2)));
}
