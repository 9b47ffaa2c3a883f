// The recorded results, in the format of bench/README.md as far as the page shows it.

export interface Times {
  readonly median_ns: number;
  readonly ratio: number | null;
  readonly peak_bytes: number | null;
}

type Outcome = { readonly Timed: Times } | { readonly Untimed: { readonly why: string } };

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
  readonly load: number | null;
  readonly results: readonly Entry[];
}

interface Machine {
  readonly cpu: string;
  readonly cores: number;
  readonly load: number | null;
  readonly system: string;
}

/** A file as it was kept. */
export interface Recorded {
  readonly date: string;
  readonly machine: Machine;
  readonly cases?: readonly Case[];
}

/** A file, and whose results it has. */
export interface Run extends Recorded {
  readonly kind: "native" | "javascript";
}

/** The sweep that a good developer writes in an hour: beside the alternatives, and not one of them. */
export const PLAIN = /^plain\b/;

export function timesOf({ outcome }: Entry): Times | undefined {
  return "Timed" in outcome ? outcome.Timed : undefined;
}

/** Settings that no alternative has: more threads, or the same boxes once more; and in JavaScript native code. */
const NOT_COMPARED = /^native|, (again|fresh|two at once|\d+ threads)$/;

/** The time of sweep-and-prune in ns, under the conditions of the alternatives: one thread, boxes in another order at each call. */
export function fastestOwn(one: Case): number | undefined {
  const times = one.results.filter((entry) => !entry.alternative && !NOT_COMPARED.test(entry.name)).flatMap((entry) => timesOf(entry) ?? []);
  return times.length > 0 ? Math.min(...times.map(({ median_ns }) => median_ns)) : undefined;
}

/** The name of the fastest library of a case, under the conditions of all: the one that tables mark and sentences name. */
export function fastest(one: Case): string | undefined {
  const timed = one.results.filter(({ name }) => !NOT_COMPARED.test(name)).flatMap((entry) => {
    const times = timesOf(entry);
    return times ? [{ name: entry.name, ns: times.median_ns }] : [];
  });
  return timed.sort((a, b) => a.ns - b.ns)[0]?.name;
}

/** The fastest that is not sweep-and-prune, also if it is the plain sweep, and how many times as long it takes. */
export function fastestOther(one: Case): { name: string; ratio: number } | undefined {
  const own = fastestOwn(one);
  const alternatives = one.results.filter((entry) => entry.alternative || PLAIN.test(entry.name));
  const timed = alternatives.flatMap((entry) => (timesOf(entry) ? [{ name: entry.name, ns: timesOf(entry)?.median_ns ?? 0 }] : []));
  const first = timed.sort((a, b) => a.ns - b.ns)[0];
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

export const count = (value: number): string => Math.round(value).toLocaleString("en");
