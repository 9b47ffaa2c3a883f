/** What a search counts; `null` is not counted. */
export interface Counts {
  readonly tests: number | null;
  readonly axisOverlaps: number | null;
  readonly pairs: number | null;
  readonly comparisons: number | null;
  readonly swaps: number | null;
}

/** One line of counters: what it is called, what it means, and where its number comes from. */
export interface Counter<T> {
  readonly key: string;
  readonly label: string;
  readonly meaning: string;
  /** The text to show; `null` if the algorithm does not count this. */
  readonly read: (shown: T) => string | null;
}

const whole = new Intl.NumberFormat("en", { maximumFractionDigits: 0 });

/** A count with thousands separators. */
export const formatCount = (count: number): string => whole.format(count);

const count = (value: number | null): string | null => (value === null ? null : whole.format(value));

/** What brute force tests: each of `n` bodies with each other, once. */
export const bruteForceTests = (n: number): number => (n * (n - 1)) / 2;

/** What every search counts, in the order shown. Each counter means the same for every algorithm. */
export const WORK: readonly Counter<Counts>[] = [
  {
    key: "tests",
    label: "Tests",
    meaning: "pairs of boxes handed to the box test; 0 for a sweep on every axis, which checks flags instead",
    read: ({ tests }) => count(tests),
  },
  {
    key: "axis-overlaps",
    label: "Axis overlaps",
    meaning: "pairs whose intervals overlap on the swept axis; for a sweep on every axis, summed over the axes",
    read: ({ axisOverlaps }) => count(axisOverlaps),
  },
  { key: "pairs", label: "Pairs", meaning: "pairs whose boxes overlap on every axis", read: ({ pairs }) => count(pairs) },
  { key: "comparisons", label: "Sort comparisons", meaning: "how often the sort compared two endpoints", read: ({ comparisons }) => count(comparisons) },
  { key: "swaps", label: "Sort swaps", meaning: "how often the sort swapped two endpoints", read: ({ swaps }) => count(swaps) },
];

/** The lines of some counters, as they are written when the site is built. */
export const counterRows = (counters: readonly Counter<never>[]): string =>
  counters.map(({ key, label, meaning }) => `<div class="counter" data-counter="${key}"><dt title="${meaning}">${label}</dt><dd>–</dd></div>`).join("");

/** Fills in the counters under `root`. `missing` says why a number is not there. */
export function showCounters<T>(root: Element, counters: readonly Counter<T>[], shown: T | undefined, missing = ""): void {
  for (const { key, read } of counters) {
    const cell = root.querySelector<HTMLElement>(`[data-counter="${key}"] dd`);
    const text = shown === undefined ? null : read(shown);
    if (!cell) continue;
    if (cell.textContent !== (text ?? "–")) cell.textContent = text ?? "–";
    cell.title = text === null && shown !== undefined ? missing : "";
  }
}
