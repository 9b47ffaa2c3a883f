import { OptionError } from "./option-error.js";

/** A CSS color, or undefined for the theme's own. */
type Color = string | undefined;

/** What is drawn beside the balls, and in which colors. */
export interface Decorations {
  /** Each pair as it is tested, highlighted for this many milliseconds. */
  readonly checks: { readonly color: Color; readonly ms: number } | undefined;
  /** The sweep line, and the balls that it touches. */
  readonly sweep: { readonly line: Color; readonly inside: Color } | undefined;
  /** The endpoints of each ball. */
  readonly edges: { readonly focus: boolean; readonly inside: Color; readonly outside: Color } | undefined;
  /** The array of endpoints under the picture; its comparisons and swaps one by one, if so asked. */
  readonly array: { readonly comparison: Color; readonly swap: Color; readonly isSortShown: boolean } | undefined;
}

/** How long a pair stays highlighted by default. */
const CHECK_MS = 100;

/**
 * Reads `checks[:color][:ms]`, `sweep[:line[:inside]]` and `edges[:focus][:array][:color:color]`,
 * whose colors are for comparisons and swaps in the array or, without `array`, for the edges
 * inside and outside the interval in focus. A list like `checks:#4c8:600, sweep:red, edges:array:orange:blue`.
 *
 * @throws {@link OptionError}
 */
export function readDecorations(text: string, also: { array: boolean; checks: boolean }): Decorations {
  let checks: Decorations["checks"] = also.checks ? { color: undefined, ms: CHECK_MS } : undefined;
  let sweep: Decorations["sweep"];
  let edges: Decorations["edges"];
  let array: Decorations["array"] = also.array ? { comparison: undefined, swap: undefined, isSortShown: false } : undefined;
  for (const part of split(text, ",")) {
    const [name = "", ...words] = split(part, ":");
    const [first, second] = words;
    if (name === "checks") {
      const isTime = first !== undefined && words.length === 1 && /^\d+$/.test(first);
      checks = { color: isTime ? undefined : color(first), ms: milliseconds(isTime ? first : second) };
    } else if (name === "sweep") {
      sweep = { line: color(first), inside: color(second) };
    } else if (name === "edges") {
      const [one, other] = words.filter((word) => word !== "focus" && word !== "array").map(color);
      const hasArray = words.includes("array");
      edges = { focus: words.includes("focus"), inside: hasArray ? undefined : one, outside: hasArray ? undefined : other };
      if (hasArray) array = { comparison: one, swap: other, isSortShown: true };
    } else {
      throw new OptionError(`decorations: "${name}" is unknown; use checks, sweep or edges`);
    }
  }
  return { checks, sweep, edges, array };
}

/** Splits at separators, but not inside parentheses: `rgb(1, 2, 3)` is one item. */
function split(text: string, separator: "," | ":"): string[] {
  const parts = text.split(separator === "," ? /,(?![^(]*\))/ : /:(?![^(]*\))/).map((part) => part.trim());
  return separator === "," ? parts.filter((part) => part !== "") : parts;
}

function color(text: string | undefined): Color {
  if (text === undefined || text === "") return undefined;
  if (typeof CSS !== "undefined" && !CSS.supports("color", text)) {
    throw new OptionError(`decorations: "${text}" is not a CSS color`);
  }
  return text;
}

function milliseconds(text: string | undefined): number {
  if (text === undefined || text === "") return CHECK_MS;
  const ms = Number(text.replace(/ms$/, ""));
  if (!(ms >= 0 && ms <= 60_000)) throw new OptionError(`decorations: "${text}" is not a time; use milliseconds from 0 to 60000`);
  return ms;
}
