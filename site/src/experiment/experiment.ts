// The compiled experiment of site/wasm: scenes in motion, and runners that find their pairs. Its layout
// is described in site/wasm/src/lib.rs. Each thread has one experiment.

import scalarWasm from "../generated/experiment.wasm?url";
import simdWasm from "../generated/experiment.simd.wasm?url";
import type { Counts } from "../panel/counters.ts";
import { hasSimd } from "../simd.ts";

/** The axes by name. */
const AXIS_NAMES: readonly string[] = ["x", "y", "z"];

/** A world. The same numbers and names give the same boxes, step for step, bit for bit. */
export interface WorldOptions {
  readonly dimensions: 2 | 3;
  readonly scene: string;
  readonly motion: string;
  readonly boxes: number;
  readonly seed: number;
  /** How much larger the boxes are than the scene's. */
  readonly size: number;
  /** The largest factor over the least. */
  readonly spread: number;
  /** Boxes of the visitor's own, rows of min corner and max corner: then scene, size and spread are not read. */
  readonly own?: Float32Array;
}

/** How a runner finds the pairs, by names that `Lists` has. */
export interface RunnerOptions {
  readonly algorithm: string;
  readonly sort: string;
  /** A rule, or one of `AXIS_NAMES`. */
  readonly axis: string;
}

/** A scene or a motion. */
interface Named {
  readonly name: string;
  readonly description: string;
}

/** Every name that the options may hold. */
export interface Lists {
  readonly algorithms: readonly string[];
  readonly sorts: readonly string[];
  readonly axes: readonly string[];
  readonly scenes: readonly (Named & { readonly dimensions: readonly [least: number, most: number] })[];
  readonly motions: readonly Named[];
}

/** What one run did. The counts mean the same for every algorithm. */
export interface Report extends Counts {
  /** Milliseconds from boxes to the list of all pairs, unobserved. */
  readonly ms: number;
  readonly pairs: number;
  /** 16 hexadecimal digits: the same for the same pairs, in whatever order. */
  readonly fingerprint: string;
}

/** What a first run would cost. */
interface Forecast {
  readonly tests: number;
  /** Overlaps that the algorithm would have to keep in memory. */
  readonly kept: number;
}

type Exports = Record<string, (...numbers: number[]) => number>;

export class Experiment {
  readonly lists: Lists;
  readonly #exports: Exports;
  readonly #memory: WebAssembly.Memory;
  #dimensions = 2;
  #boxes = 0;
  /** By runner, how many pairs its last run found. */
  #found: number[] = [];

  private constructor(instance: WebAssembly.Instance) {
    const { memory, ...exports } = instance.exports;
    this.#memory = memory as WebAssembly.Memory;
    this.#exports = exports as unknown as Exports;
    const named = (line: string): Named => {
      const [name = "", description = ""] = line.split("\t");
      return { name, description };
    };
    this.lists = {
      algorithms: this.#names(0),
      sorts: this.#names(1),
      axes: [...this.#names(2), ...AXIS_NAMES],
      scenes: this.#names(3).map((line) => {
        const [, , least, most] = line.split("\t");
        return { ...named(line), dimensions: [Number(least), Number(most)] as const };
      }),
      motions: this.#names(4).map(named),
    };
  }

  static async load(): Promise<Experiment> {
    const response = await fetch(new URL(hasSimd() ? simdWasm : scalarWasm, self.location.href));
    if (!response.ok) throw new Error(`the experiment could not be loaded: ${response.status}`);
    const env = { now: () => performance.now() };
    return new Experiment((await WebAssembly.instantiate(await response.arrayBuffer(), { env })).instance);
  }

  /**
   * Makes a world at its first step, and forgets the one before. With `keep`, own boxes of as many dimensions leave the
   * runners there: they go on from what they have kept.
   */
  begin(options: WorldOptions, keep = false): void {
    const { lists } = this;
    const place = (list: readonly Named[], name: string): number => list.findIndex((item) => item.name === name);
    const { dimensions, scene, motion, boxes, seed, size, spread, own } = options;
    if (own) {
      const at = this.#call("experiment_rows", own.length);
      if (at === 0) throw new RangeError("the experiment does not take that many boxes");
      new Float32Array(this.#memory.buffer, at, own.length).set(own);
    }
    // Boxes that are placed in each step, as those of balls, need no motion.
    this.#area().set([dimensions, place(lists.scenes, scene), Math.max(place(lists.motions, motion), 0), boxes, seed, size, spread]);
    if (own) this.#attempt("experiment_place", Number(keep));
    else this.#attempt("experiment_begin");
    this.#dimensions = dimensions;
    this.#boxes = own ? own.length / (2 * dimensions) : boxes;
    if (!keep) this.#found = [];
  }

  advance(): void {
    this.#attempt("experiment_advance");
  }

  /** Rows of min corner and max corner: a view of the experiment's memory, until the next call. */
  get boxes(): Float32Array {
    return new Float32Array(this.#memory.buffer, this.#call("experiment_boxes"), 2 * this.#dimensions * this.#boxes);
  }

  /** How many pairs there are, without storing any. */
  countPairs(): number {
    return this.#exports["experiment_count_pairs"]?.() ?? -1;
  }

  /** Adds a runner. They are numbered from 0. */
  enter(options: RunnerOptions): void {
    this.#attempt("experiment_enter", ...this.#indices(options), 1);
  }

  forecast(options: RunnerOptions): Forecast {
    this.#attempt("experiment_forecast", ...this.#indices(options));
    const [tests = 0, kept = 0] = this.#area();
    return { tests, kept };
  }

  /** Lets a runner find the pairs of the world as it is; counted, if asked, on a copy. */
  run(runner: number, counting: boolean): Report {
    this.#attempt("experiment_run", runner, Number(counting));
    const [ms = 0, pairs = 0, upper = 0, lower = 0, ...counts] = this.#area();
    const hex = (half: number): string => half.toString(16).padStart(8, "0");
    const counted = (count = -1): number | null => (count < 0 ? null : count);
    this.#found[runner] = pairs;
    return {
      ms,
      pairs,
      fingerprint: hex(upper) + hex(lower),
      tests: counted(counts[0]),
      axisOverlaps: counted(counts[1]),
      comparisons: counted(counts[2]),
      swaps: counted(counts[3]),
    };
  }

  /** The pairs of a runner's last run, `a0, b0, a1, b1, ..`: a view, until the next call. */
  pairs(runner: number): Uint32Array {
    const at = this.#call("experiment_pairs", runner);
    return new Uint32Array(this.#memory.buffer, at, 2 * (this.#found[runner] ?? 0));
  }

  #indices({ algorithm, sort, axis }: RunnerOptions): [number, number, number] {
    const { algorithms, sorts, axes } = this.lists;
    return [algorithms.indexOf(algorithm), sorts.indexOf(sort), axes.indexOf(axis)];
  }

  #names(kind: number): string[] {
    const at = this.#call("experiment_names", kind);
    return new TextDecoder().decode(new Uint8Array(this.#memory.buffer, at, this.#area()[0])).split("\n");
  }

  /** The numbers that both sides exchange: a new view each time, because memory moves when it grows. */
  #area(): Float64Array {
    return new Float64Array(this.#memory.buffer, this.#call("experiment_area"), 16);
  }

  #call(name: string, ...numbers: number[]): number {
    return (this.#exports[name]?.(...numbers) ?? 0) >>> 0;
  }

  #attempt(name: string, ...numbers: number[]): void {
    if (this.#call(name, ...numbers) !== 0) throw new RangeError("the experiment does not have what it was asked for");
  }
}
