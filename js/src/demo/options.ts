import type { RunnerOptions } from "../runner.js";
import { type Decorations, readDecorations } from "./decorations.js";

/** The world, in its own units. Pictures scale it. */
export const WIDTH = 600;
export const HEIGHT = 400;

/** What an attribute says that cannot be done. Its message is for whoever wrote the page. */
export class OptionError extends Error {
  override readonly name = "OptionError";
}

/** A ball as it is given: its centre and radius; its velocity, in units a second, if it has one. */
export type Row = readonly [x: number, y: number, radius: number, vx?: number, vy?: number];

/** How the world moves from one tick to the next. */
export const motions = ["bounce", "drift", "teleport", "rest"] as const;
export type Motion = (typeof motions)[number];

/** What begins a world. */
export interface WorldOptions {
  readonly balls: number | readonly Row[];
  readonly seed: number;
  readonly motion: Motion;
  /** Whether balls bounce off each other, not only off walls. */
  readonly bounces: boolean;
  /** The ball that is thrown about, where one is. */
  readonly focus: number;
}

/** What runs over it. */
export type Detecting = Required<Pick<RunnerOptions, "method" | "sort" | "axis" | "focus">>;

/** All that the attributes of a demo say, understood. */
export interface Options {
  readonly world: WorldOptions;
  readonly detecting: Detecting;
  readonly decorations: Decorations;
  /** Ticks of motion between two detections, beside the one that there always is. */
  readonly skip: number;
  readonly speed: number;
  readonly isStatic: boolean;
  readonly isDraggable: boolean;
  readonly labels: readonly string[] | "emoji" | undefined;
  readonly focus: number | undefined;
}

type Strategy = Pick<Detecting, "method"> & Partial<Pick<Detecting, "sort">>;

/** What each `strategy` runs. The last three are the names of an older element. */
export const strategies: Readonly<Record<string, Strategy>> = {
  pairwise: { method: "global pairwise" },
  "sorted-pairwise": { method: "sorted pairwise" },
  endpoints: { method: "endpoint sweep" },
  "one-to-n": { method: "one-to-n scan" },
  sweep: { method: "endpoint sweep" },
  "sweep-all-axes": { method: "endpoint sweep on every axis" },
  swap: { method: "swap-driven sweep" },
  "swap-all-axes": { method: "swap-driven sweep on every axis" },
  "sap-nativesort": { method: "sorted pairwise", sort: "standard library" },
  "sap-quicksort": { method: "endpoint sweep", sort: "quicksort" },
  "sap-insertionsort": { method: "endpoint sweep", sort: "insertion sort" },
};

const sorts = {
  native: "standard library",
  quicksort: "quicksort",
  insertion: "insertion sort",
  merge: "merge sort",
  timsort: "Timsort",
} as const satisfies Record<string, Detecting["sort"]>;

const axes = {
  x: 0,
  y: 1,
  widest: "largest variance",
  longest: "longest extent",
  "fewest-overlaps": "fewest expected overlaps",
} as const satisfies Record<string, Detecting["axis"]>;

/** Demonstrations of errors: what each is made of. `js/wasm/src/labs.rs` has the wrong algorithms. */
export const labs: Readonly<Record<string, { method: Detecting["method"]; motion: Motion | undefined }>> = {
  "strict-ties": { method: "strict ties (wrong)", motion: "rest" },
  "wrong-start": { method: "sorted start (wrong)", motion: undefined },
  "centre-sort": { method: "sort by centre (wrong)", motion: undefined },
  "one-to-n": { method: "one-to-n scan", motion: undefined },
  teleport: { method: "swap-driven sweep", motion: "teleport" },
};

/** The most balls: what each of them is tested against stays in the tens of thousands. */
const MOST_BALLS = 400;
const MOST_SKIPPED = 600;
const MOST_TICKS = 3600;

/** The attributes that say what a demo does, all of them text. */
export const attributes = [
  "strategy",
  "sort",
  "axis",
  "balls",
  "seed",
  "skip-interval",
  "speed",
  "decorations",
  "static",
  "draggable",
  "rainbow",
  "no-bounce",
  "boxes",
  "array",
  "paused",
  "labels",
  "focus",
  "explain",
  "predict",
  "motion",
  "lab",
  "start",
  "heading",
  "no-counters",
  "no-controls",
  "aria-label",
] as const;
export type Attribute = (typeof attributes)[number];

/**
 * Reads the attributes.
 *
 * @throws {@link OptionError} for the first that cannot be done.
 */
export function readOptions(get: (name: Attribute) => string | null): Options {
  const has = (name: Attribute): boolean => get(name) !== null;
  const lab = has("lab") ? choose("lab", labs, get("lab")!) : undefined;
  const strategy = choose("strategy", strategies, get("strategy") ?? "sorted-pairwise");
  const axis = get("axis") ?? "x";
  const method = lab?.method ?? (axis === "all" ? onAllAxes(strategy.method) : strategy.method);
  const focus = has("focus") ? number("focus", get("focus")!, 0, MOST_BALLS - 1) : undefined;
  const decorations = readDecorations(get("decorations") ?? "", {
    array: has("array"),
    checks: has("explain") || has("predict"),
  });
  const balls = readBalls(get("balls") ?? "5");
  const count = typeof balls === "number" ? balls : balls.length;
  if (focus !== undefined && focus >= count) {
    throw new OptionError(`focus="${focus}": there are ${count} balls, the first of which is 0`);
  }
  const motion = has("motion") ? choose("motion", Object.fromEntries(motions.map((name) => [name, name])), get("motion")!) : "bounce";
  return {
    world: {
      balls,
      seed: number("seed", get("seed") ?? "1", 0, Number.MAX_SAFE_INTEGER),
      motion: lab?.motion ?? (motion as Motion),
      bounces: !has("no-bounce"),
      focus: focus ?? 0,
    },
    detecting: {
      method,
      sort: has("sort") ? choose("sort", sorts, get("sort")!) : (strategy.sort ?? "standard library"),
      axis: axis === "all" ? 0 : choose("axis", { ...axes, all: 0 }, axis),
      focus: focus ?? 0,
    },
    decorations,
    skip: number("skip-interval", get("skip-interval") ?? "0", 0, MOST_SKIPPED),
    speed: number("speed", get("speed") ?? "1", 0.01, 100, false),
    isStatic: has("static"),
    isDraggable: has("draggable") && get("draggable") !== "false",
    labels: readLabels(get("labels")),
    focus,
  };
}

/** How many ticks to run before anything is shown. */
export function readStart(text: string | null): number {
  return text === null ? 0 : number("start", text, 0, MOST_TICKS);
}

function choose<V>(attribute: Attribute, choices: Readonly<Record<string, V>>, name: string): V {
  const key = name.trim();
  if (!Object.hasOwn(choices, key)) {
    throw new OptionError(`${attribute}="${name}": there is ${Object.keys(choices).join(", ")}`);
  }
  return choices[key]!;
}

function onAllAxes(method: Strategy["method"]): Strategy["method"] {
  if (method === "endpoint sweep") return "endpoint sweep on every axis";
  if (method === "swap-driven sweep") return "swap-driven sweep on every axis";
  return method;
}

function number(attribute: Attribute, text: string, least: number, most: number, whole = true): number {
  const value = text.trim() === "" ? NaN : Number(text);
  if (!(value >= least && value <= most) || (whole && !Number.isInteger(value))) {
    throw new OptionError(`${attribute}="${text}": expected a ${whole ? "whole " : ""}number from ${least} to ${most}`);
  }
  return value;
}

function readBalls(text: string): number | Row[] {
  if (!text.trim().startsWith("[")) return number("balls", text, 0, MOST_BALLS);
  let rows: unknown;
  try {
    rows = JSON.parse(text);
  } catch {
    throw new OptionError(`balls: the list is no JSON; expected [[x, y, radius], ...]`);
  }
  if (!Array.isArray(rows) || rows.length > MOST_BALLS) {
    throw new OptionError(`balls: expected a list of at most ${MOST_BALLS}`);
  }
  return rows.map(checkBall);
}

function checkBall(row: unknown, index: number): Row {
  const isRow = Array.isArray(row) && (row.length === 3 || row.length === 5) && row.every(Number.isFinite);
  if (!isRow) throw new OptionError(`balls: number ${index} is not [x, y, radius] or [x, y, radius, vx, vy]`);
  const [x, y, radius] = row as unknown as Row;
  const fits = radius > 0 && x >= radius && x <= WIDTH - radius && y >= radius && y <= HEIGHT - radius;
  if (!fits) throw new OptionError(`balls: number ${index} is not inside the ${WIDTH} x ${HEIGHT} world`);
  return row as unknown as Row;
}

function readLabels(text: string | null): Options["labels"] {
  if (text === null || text.trim() === "") return undefined;
  return text.trim() === "emoji" ? "emoji" : text.split(",").map((label) => label.trim());
}
