import { type Boxes, checkBoxes, checkNumbers, type Dimensions, isNamed, readBox, readPoint, writeRows } from "./boxes.js";
import { checkFits, type Core, type Engine, type Passed } from "./engine.js";
import { OutOfMemoryError } from "./errors.js";
import { result, view } from "./views.js";
import { refuseCorners } from "./world-arguments.js";
import type { WorldExports } from "./world-core.js";
import type { Box, BroadPhaseOptions, Changes, Numbers, Point } from "./world-types.js";

/**
 * A broad phase in WebAssembly's memory: calls it, writes its arguments where it reads them, and
 * makes views of its answers.
 */
export class WorldMemory {
  readonly dimensions: Dimensions;
  readonly isDouble: boolean;
  /** How many dimensions the boxes are stored in: at least those that they have. */
  readonly stored: Dimensions;
  /** Whether arrays that it gives out are views of memory. */
  readonly isView: boolean;
  readonly #owned: Owned;
  readonly #numbersAt: number;
  #numbers: Float64Array | undefined;
  #rows: Float32Array | Float64Array | undefined;
  #ids: Float64Array | undefined;
  #out: Float64Array | undefined;
  #begun: Float64Array | undefined;
  #ended: Float64Array | undefined;

  constructor(dimensions: Dimensions, isDouble: boolean, isView: boolean, owned: Owned) {
    this.dimensions = dimensions;
    this.isDouble = isDouble;
    this.isView = isView;
    // The core has no type for 1D boxes, nor for 2D in double precision: js/wasm/src/broad_phase/stored.rs.
    this.stored = isDouble ? 3 : (Math.max(2, dimensions) as Dimensions);
    this.#owned = owned;
    this.#numbersAt = owned.engine.exports.world_numbers(owned.world) >>> 0;
    forgotten?.register(this, owned);
  }

  /** An empty broad phase. */
  static create(core: Core<WorldExports>, options: Required<BroadPhaseOptions>): WorldMemory {
    const { dimensions, precision, report, margin, prediction, views } = options;
    const isDouble = precision === "double";
    const engine = core.engine();
    const world = engine.exports.world_new(dimensions, Number(isDouble), margin, prediction, Number(report === "fat"));
    if (world === 0) throw new RangeError("`margin` or `prediction` does not fit in single precision");
    return new WorldMemory(dimensions, isDouble, views, { engine, world });
  }

  /** The started core. */
  get engine(): Engine<WorldExports> {
    return this.#owned.engine;
  }

  /** Frees the memory. Freeing it twice is not an error. */
  free(): void {
    release(this.#owned);
  }

  /** The exports, unless this was freed. */
  exports(): WorldExports {
    if (this.#owned.world === 0) throw new TypeError("this BroadPhase was freed");
    return this.#owned.engine.exports;
  }

  /** Makes a call that cannot fail and overwrites no view. */
  ask(ask: (exports: WorldExports, world: number) => number): number {
    return ask(this.exports(), this.#owned.world);
  }

  /** Makes a call and throws its error. */
  call(call: (exports: WorldExports, world: number) => number, passed?: Passed): void {
    const owned = this.#owned;
    const exports = this.exports();
    owned.engine.calls++;
    try {
      owned.engine.check(call(exports, owned.world), passed);
    } catch (error) {
      // The call stopped halfway, so the state cannot be used any more.
      if (error instanceof OutOfMemoryError) this.free();
      throw error;
    }
  }

  /** Makes a call and returns the ids that it reports. */
  answer(call: (exports: WorldExports, world: number) => number, passed?: Passed): Float64Array {
    this.call(call, passed);
    const { engine } = this.#owned;
    const { buffer } = engine.exports.memory;
    this.#out = view(Float64Array, this.#out, buffer, engine.detail(0), engine.detail(1));
    return result(engine, this.#out, this.isView);
  }

  /** Updates, and writes what changed. */
  update(into: Changes): void {
    this.call((exports, world) => exports.world_update(world));
    const { engine } = this.#owned;
    const { buffer } = engine.exports.memory;
    const [at, total, begun] = [engine.detail(0), engine.detail(1), this.numbers()[0]!];
    this.#begun = view(Float64Array, this.#begun, buffer, at, begun);
    this.#ended = view(Float64Array, this.#ended, buffer, at + 8 * begun, total - begun);
    try {
      into.begun = result(engine, this.#begun, this.isView);
      into.ended = result(engine, this.#ended, this.isView);
    } catch (error) {
      this.free(); // the next update would not report these changes
      throw error;
    }
  }

  /** The numbers that go in and out, where they are now. */
  numbers(): Float64Array {
    const { buffer } = this.exports().memory;
    return (this.#numbers = view(Float64Array, this.#numbers, buffer, this.#numbersAt, 16));
  }

  /** Writes a box, from one object or from separate numbers: as many as it has, and nothing else. */
  writeBox(a: unknown, b: unknown, c: unknown, d: unknown, e: unknown, f: unknown, more: unknown): void {
    if (typeof a === "object" && a !== null) {
      if (b !== undefined) throw new TypeError(`there are more arguments than \`box\``);
      this.writeCorners(0, a as Box, 2, "box");
      return;
    }
    const [numbers, stored] = [this.numbers(), this.stored];
    switch (this.dimensions) {
      case 1:
        if (typeof a !== "number" || typeof b !== "number" || c !== undefined) break;
        this.#writeAxes(numbers, 0, a, 0, 0);
        this.#writeAxes(numbers, stored, b, 0, 0);
        return;
      case 2:
        if (typeof a !== "number" || typeof b !== "number" || typeof c !== "number" || typeof d !== "number" || e !== undefined) break;
        this.#writeAxes(numbers, 0, a, b, 0);
        this.#writeAxes(numbers, stored, c, d, 0);
        return;
      case 3:
        if (typeof a !== "number" || typeof b !== "number" || typeof c !== "number") break;
        if (typeof d !== "number" || typeof e !== "number" || typeof f !== "number" || more !== undefined) break;
        this.#writeAxes(numbers, 0, a, b, c);
        this.#writeAxes(numbers, stored, d, e, f);
        return;
    }
    refuseCorners(this.dimensions, [a, b, c, d, e, f]);
  }

  #writeAxes(numbers: Float64Array, at: number, x: number, y: number, z: number): void {
    numbers[at] = x;
    numbers[at + 1] = y;
    if (this.stored === 3) numbers[at + 2] = z;
  }

  /**
   * Writes one or two corners, with zeros on the axes that the user's boxes do not have. The core
   * checks whether a box is valid; what a `rule` says is checked here.
   */
  writeCorners(at: number, values: Point | Box, corners: 1 | 2, name: string, rule?: "finite" | "a number"): void {
    const { dimensions } = this;
    const given = isNamed(values) ? readCorners(values, dimensions, corners, name) : checkNumbers(values, name);
    if (given.length !== corners * dimensions) {
      throw new RangeError(`\`${name}\` has ${given.length} numbers; in ${dimensions}D it must have ${corners * dimensions}`);
    }
    const wrong = rule ? given.findIndex((x) => (rule === "finite" ? !Number.isFinite(x) : Number.isNaN(x))) : -1;
    if (wrong >= 0) throw new RangeError(`\`${name}[${wrong}]\` is ${given[wrong]}; it must be ${rule}`);
    const numbers = this.numbers();
    for (let corner = 0; corner < corners; corner++) {
      for (let axis = 0; axis < this.stored; axis++) {
        numbers[at + corner * this.stored + axis] = axis < dimensions ? given[corner * dimensions + axis]! : 0;
      }
    }
  }

  /** Rows in memory for `count` boxes. */
  rowsFor(count: number): Float32Array | Float64Array {
    const exports = this.exports();
    const length = 2 * this.stored * count;
    checkFits(length * (this.isDouble ? 8 : 4));
    const at = exports.world_rows(this.#owned.world, count) >>> 0;
    if (at === 0) throw new OutOfMemoryError();
    const { buffer } = exports.memory;
    return (this.#rows =
      this.isDouble
        ? view(Float64Array, this.#rows, buffer, at, length)
        : view(Float32Array, this.#rows, buffer, at, length));
  }

  /** Writes boxes to the rows, unless they are already there, and returns how many there are. */
  writeRows(boxes: Boxes): number {
    const rows = checkBoxes(boxes, this.dimensions);
    const count = rows.length / (2 * this.dimensions);
    const kept = this.#keep(rows, this.#rows);
    const into = this.rowsFor(count);
    if (!isSame(kept, into)) writeRows(kept, this.dimensions, into, this.stored);
    return count;
  }

  /** The array of memory for `count` ids. */
  idsFor(count: number): Float64Array {
    const exports = this.exports();
    checkFits(count * 8);
    const at = exports.world_ids_in(this.#owned.world, count) >>> 0;
    if (at === 0) throw new OutOfMemoryError();
    return (this.#ids = view(Float64Array, this.#ids, exports.memory.buffer, at, count));
  }

  /** Writes ids to their array, unless they are already there. */
  writeIds(ids: Numbers): void {
    const kept = this.keepIds(ids);
    const into = this.idsFor(kept.length);
    if (!isSame(kept, into)) into.set(kept);
  }

  /** The ids, copied if writing other arguments first could move them. */
  keepIds(ids: Numbers): Numbers {
    return this.#keep(ids, this.#ids);
  }

  /** The numbers, copied if they lie in memory that may grow, unless they lie where the core will read them. */
  #keep<T extends Numbers>(numbers: T, written: Float32Array | Float64Array | undefined): T {
    const isOutside = !ArrayBuffer.isView(numbers) || numbers.buffer !== this.exports().memory.buffer;
    return isOutside || (written && isSame(numbers, written)) ? numbers : (numbers.slice() as unknown as T);
  }
}

/** The corners of a box that is an object, or the coordinates of a point that is one. */
function readCorners(value: object, dimensions: Dimensions, corners: 1 | 2, name: string): Float64Array {
  if (corners === 1) return readPoint(value, dimensions, name);
  const numbers = new Float64Array(2 * dimensions);
  readBox(value, dimensions, `\`${name}\``, numbers, 0);
  return numbers;
}

/** Whether an array lies where another does. */
function isSame(a: Numbers, b: Float32Array | Float64Array): boolean {
  return ArrayBuffer.isView(a) && a.buffer === b.buffer && a.byteOffset === b.byteOffset;
}

/** The handle of the core's object, or 0 once it is freed. */
export interface Owned {
  readonly engine: Engine<WorldExports>;
  world: number;
}

export function release(owned: Owned): void {
  if (owned.world !== 0) owned.engine.exports.world_free(owned.world);
  owned.world = 0;
}

/** Frees the handles of objects that were garbage collected. */
const forgotten =
  typeof FinalizationRegistry === "undefined" ? undefined : new FinalizationRegistry<Owned>(release);
