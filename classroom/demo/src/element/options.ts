import type { RunnerOptions } from "../algorithms/runner.js";
import type { DemoProgram, Row } from "./types.js";
import { type Decorations, readDecorations } from "./decorations.js";
import { OptionError } from "./option-error.js";
import { variants } from "./variants.js";

/** The world, in its own units. Pictures scale it. */
export const WIDTH = 600;
export const HEIGHT = 400;
/** A world that is only a strip. */
const STRIP_HEIGHT = 160;

/** How the world moves from one tick to the next. */
export type Motion = "bounce" | "drift" | "teleport" | "rest";

/** What begins a world. */
export interface WorldOptions {
  readonly balls: number | readonly Row[];
  readonly seed: number;
  readonly motion: Motion;
  /** Whether balls bounce off each other, not only off walls. */
  readonly bounces: boolean;
  readonly height: number;
  /** The balls that stand for walls: their boxes are as high as the world. */
  readonly walls: readonly number[];
  /** The ball that is thrown about, where one is. */
  readonly focus: number;
}

/** What runs over it. */
export interface Detecting extends Required<Pick<RunnerOptions, "method" | "sort" | "axis" | "focus">> {
  /** The method that it looks like: itself, or that of which it is a broken form. */
  readonly like: RunnerOptions["method"];
}

/** All that the attributes of a demo say, understood. */
export interface Options {
  readonly world: WorldOptions;
  readonly detecting: Detecting;
  readonly decorations: Decorations;
  /** Ticks of motion between two detections, beside the one that there always is. */
  readonly skip: number;
  readonly speed: number;
  /**
   * Whether a detection takes swept boxes, which enclose a ball here and at the last detection. If `off`, it takes
   * the boxes as they are, and what only the swept ones would find is marked as missed.
   */
  readonly swept: "off" | "on" | undefined;
  readonly isStatic: boolean;
  readonly isDraggable: boolean;
  readonly labels: readonly string[] | "emoji" | undefined;
  readonly focus: number | undefined;
  readonly isRainbow: boolean;
  readonly hasBoxes: boolean;
  /** Whether two balls may be chosen, to be told why they were tested or not. */
  readonly explains: boolean;
  /** Whether the swaps since a ball was taken are counted, flashed and listed. */
  readonly hasSwapLog: boolean;
  /** Whether each event is asked for before it is shown. */
  readonly predicts: boolean;
  readonly heading: string;
  readonly hasCounters: boolean;
  readonly hasControls: boolean;
  /** What runs in the place of the compiled algorithm, if anything does. */
  readonly program: DemoProgram | undefined;
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

const motions: Readonly<Record<Motion, Motion>> = { bounce: "bounce", drift: "drift", teleport: "teleport", rest: "rest" };

/** The most balls: what each of them is tested against stays in the tens of thousands. */
const MOST_BALLS = 400;
const MOST_SKIPPED = 600;
export const MOST_TICKS = 3600;

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
  "swap-log",
  "motion",
  "strip",
  "walls",
  "swept",
  "variant",
  "start",
  "stop",
  "heading",
  "no-counters",
  "no-controls",
  "embed-url",
  "aria-label",
] as const;
export type Attribute = (typeof attributes)[number];

/** Those of them that are there or not. */
export const booleans: ReadonlySet<Attribute> = new Set<Attribute>([
  "static",
  "draggable",
  "rainbow",
  "no-bounce",
  "boxes",
  "array",
  "paused",
  "explain",
  "predict",
  "swap-log",
  "strip",
  "no-counters",
  "no-controls",
]);

/** Whether the value of one of them says that it is there: `"false"` does not. */
export function isOn(value: string | null): boolean {
  return value !== null && value !== "false";
}

/**
 * Reads the attributes.
 *
 * @throws {@link OptionError} for the first that cannot be done.
 */
export function readOptions(attribute: (name: Attribute) => string | null, program?: DemoProgram): Options {
  const variantName = attribute("variant");
  const variant = variantName === null ? undefined : choose("variant", variants(), variantName);
  const get = (name: Attribute): string | null => attribute(name) ?? variant?.defaults[name] ?? null;
  const has = (name: Attribute): boolean => isOn(get(name));
  const strategy = choose("strategy", strategies, get("strategy") ?? "sorted-pairwise");
  const axis = get("axis") ?? "x";
  const height = has("strip") ? STRIP_HEIGHT : HEIGHT;
  // A method that a variant adds is known to the compiled algorithms that come with it.
  const method = (variant?.method as Detecting["method"] | undefined) ?? (axis === "all" ? onAllAxes(strategy.method) : strategy.method);
  const balls = readBalls(get("balls") ?? "5", height);
  const count = typeof balls === "number" ? balls : balls.length;
  const focus = get("focus") === null ? undefined : number("focus", get("focus")!, 0, MOST_BALLS - 1);
  if (focus !== undefined && focus >= count) {
    throw new OptionError(`focus="${focus}": there are ${count} balls, numbered from 0`);
  }
  return {
    world: {
      balls,
      seed: number("seed", get("seed") ?? "1", 0, Number.MAX_SAFE_INTEGER),
      motion: choose("motion", motions, get("motion") ?? "bounce"),
      bounces: !has("no-bounce"),
      height,
      walls: readWalls(get("walls"), count),
      focus: focus ?? 0,
    },
    detecting: {
      method,
      like: variant?.like ?? method,
      sort: get("sort") === null ? (strategy.sort ?? "standard library") : choose("sort", sorts, get("sort")!),
      axis: choose("axis", { ...axes, all: 0 }, axis),
      focus: focus ?? 0,
    },
    decorations: readDecorations(get("decorations") ?? "", {
      array: has("array"),
      // There has to be something to guess.
      checks: has("explain") || (has("predict") && method !== "one-to-n scan" && !/array|sweep/.test(get("decorations") ?? "")),
    }),
    skip: number("skip-interval", get("skip-interval") ?? "0", 0, MOST_SKIPPED),
    speed: number("speed", get("speed") ?? "1", 0.01, 100, false),
    swept: get("swept") === null ? undefined : choose("swept", { off: "off", on: "on" } as const, get("swept")!),
    isStatic: has("static"),
    isDraggable: get("draggable") !== "false" && (!has("predict") || has("static")),
    labels: readLabels(get("labels")),
    focus,
    isRainbow: has("rainbow"),
    hasBoxes: has("boxes"),
    explains: has("explain"),
    hasSwapLog: has("swap-log"),
    predicts: has("predict"),
    heading: get("heading") ?? "",
    hasCounters: !has("no-counters"),
    hasControls: !has("no-controls"),
    program,
  };
}

/** Whether a visitor guesses what a scan finds: as a whole, because its steps would tell. */
export function asksOfScan({ predicts, detecting }: Pick<Options, "predicts" | "detecting">): boolean {
  return predicts && detecting.method === "one-to-n scan";
}

/** Whether another seed makes another world: random balls, or given ones that get their speed from the seed. */
export function hasSeed({ world, isStatic }: Options): boolean {
  const { balls, motion } = world;
  if (typeof balls === "number") return balls > 0;
  return !isStatic && motion === "bounce" && balls.some((row) => row.length === 3);
}

/** A seed by chance, short enough to be read out. */
export function newSeed(): string {
  return String(1 + Math.floor(Math.random() * 999_999));
}

/** Whether a world of the one goes on as a world of the other. */
export function isWorldKept(before: Options, after: Options): boolean {
  return JSON.stringify([before.world, before.isStatic]) === JSON.stringify([after.world, after.isStatic]);
}

/** How many ticks to run before anything is shown. */
export function readStart(text: string | null): number {
  return text === null ? 0 : number("start", text, 0, MOST_TICKS);
}

/** Which stop of the first detection to show; -1 is its beginning. */
export function readStop(text: string | null): number | undefined {
  return text === null ? undefined : number("stop", text, -1, Number.MAX_SAFE_INTEGER);
}

function choose<V>(attribute: Attribute, choices: Readonly<Record<string, V>>, name: string): V {
  const key = name.trim();
  if (!Object.hasOwn(choices, key)) {
    throw new OptionError(`${attribute}="${name}" is unknown; use one of ${Object.keys(choices).join(", ")}`);
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
    throw new OptionError(`${attribute}="${text}": it must be a ${whole ? "whole " : ""}number from ${least} to ${most}`);
  }
  return value;
}

function readWalls(text: string | null, count: number): number[] {
  return (text ?? "").split(",").filter((word) => word.trim() !== "").map((word) => number("walls", word, 0, count - 1));
}

function readBalls(text: string, height: number): number | Row[] {
  if (!text.trim().startsWith("[")) return number("balls", text, 0, MOST_BALLS);
  let rows: unknown;
  try {
    rows = JSON.parse(text);
  } catch {
    throw new OptionError(`balls: this list is not valid JSON; write it like [[x, y, radius], ...]`);
  }
  if (!Array.isArray(rows) || rows.length > MOST_BALLS) {
    throw new OptionError(`balls: the list must have at most ${MOST_BALLS} rows`);
  }
  return rows.map((row, index) => checkBall(row, index, height));
}

function checkBall(row: unknown, index: number, height: number): Row {
  const isRow = Array.isArray(row) && (row.length === 3 || row.length === 5) && row.every(Number.isFinite);
  if (!isRow) throw new OptionError(`balls: number ${index} must be [x, y, radius] or [x, y, radius, vx, vy], in numbers`);
  const [x, y, radius] = row as unknown as Row;
  const fits = radius > 0 && x >= radius && x <= WIDTH - radius && y >= radius && y <= height - radius;
  if (!fits) throw new OptionError(`balls: number ${index} must lie inside the ${WIDTH} x ${height} world, with a radius above 0`);
  return row as unknown as Row;
}

function readLabels(text: string | null): Options["labels"] {
  if (text === null || text.trim() === "") return undefined;
  return text.trim() === "emoji" ? "emoji" : text.split(",").map((label) => label.trim());
}
