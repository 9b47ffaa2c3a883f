import { type Boxes, checkBoxes, type Dimensions, writeRows } from "../boxes/boxes.js";
import { checkFits, Code, type Engine, type Passed } from "../wasm/engine.js";
import type { Core } from "../wasm/init.js";
import { OutOfMemoryError } from "../wasm/errors.js";
import { forgotten, Handle } from "../wasm/handle.js";
import { StaleProxyError } from "./stale-proxy-error.js";
import { bufferOf, lengthOf } from "../wasm/typed.js";
import { copy, guard, view } from "../wasm/views.js";
import { readCorners, refuseCorners } from "./arguments.js";
import type { WorldExports } from "./core.js";
import type { BroadPhaseOptions, Changes } from "./types.js";

/**
 * A broad phase in WebAssembly's memory: calls it, writes its arguments where it reads them, and
 * makes views of its answers.
 *
 * A method of a broad phase first reads and checks all its arguments, which may run any code of the user: that calls
 * this broad phase, or frees it. Then it writes them, and makes its call.
 */
export class WorldMemory {
  readonly dimensions: Dimensions;
  readonly isDouble: boolean;
  /** How many dimensions the boxes are stored in: at least those that they have. */
  readonly stored: Dimensions;
  /** Whether arrays that it gives out are views of memory. */
  readonly isView: boolean;
  readonly #handle: Handle<WorldExports>;
  readonly #numbersAt: number;
  #numbers = new Float64Array(0);
  #rows: Float32Array | Float64Array | undefined;
  /** How many updates ended with an error one after another. What the last one found and could not give comes with the next. */
  #failures = 0;
  #ids: Float64Array | undefined;
  /** The views that calls gave out last: the first array of a call, the second. */
  readonly #given: Float64Array[] = [];

  constructor(dimensions: Dimensions, isDouble: boolean, isView: boolean, handle: Handle<WorldExports>) {
    this.dimensions = dimensions;
    this.isDouble = isDouble;
    this.isView = isView;
    // The core has no type for 1D boxes, nor for 2D in double precision: js/wasm/src/broad_phase/stored.rs.
    this.stored = isDouble ? 3 : (Math.max(2, dimensions) as Dimensions);
    this.#handle = handle;
    this.#numbersAt = handle.call((exports, world) => exports.world_numbers(world)) >>> 0;
    forgotten?.register(this, handle);
  }

  /** An empty broad phase. */
  static create(core: Core<WorldExports>, options: Required<BroadPhaseOptions>): WorldMemory {
    const { dimensions, precision, report, margin, prediction, views } = options;
    const isDouble = precision === "double";
    const handle = newWorld(core.engine(), dimensions, isDouble, margin, prediction, report === "fat");
    return new WorldMemory(dimensions, isDouble, views, handle);
  }

  /** The started core. */
  get engine(): Engine<WorldExports> {
    return this.#handle.engine;
  }

  /** Frees the memory. Freeing it twice is not an error. */
  free(): void {
    this.#handle.free();
  }

  /** Throws if no call can be made, because this was freed. */
  checkUsable(): void {
    this.#handle.checkUsable();
  }

  /** Makes a call that cannot fail and overwrites no view. */
  ask(ask: (exports: WorldExports, world: number) => number): number {
    return this.#handle.call(ask);
  }

  /** Makes a call and throws its error. */
  call(call: (exports: WorldExports, world: number) => number, passed?: Passed): void {
    const handle = this.#handle;
    const { engine } = handle;
    engine.calls++;
    let code: number;
    try {
      code = handle.call(call);
    } catch (error) {
      // The call stopped halfway, so the state cannot be used any more.
      if (error instanceof OutOfMemoryError) handle.discard();
      throw error;
    }
    if (code !== Code.Ok) this.#refuse(code, passed);
  }

  /** Throws the error of a call. */
  #refuse(code: number, passed: Passed | undefined): void {
    const { engine } = this;
    if (code === Code.StaleProxy) throw new StaleProxyError(engine.detail(0), passed?.ids?.[engine.detail(0)] ?? NaN);
    if (code === Code.InvalidArgument) {
      const [name, count] = passed?.boxes?.[0] ?? [];
      const box = name === "boxes" && count! > 1 ? `the box of query ${engine.detail(0)}` : "`box`";
      throw new RangeError(`${box} is inverted, or a coordinate is too large for single precision`);
    }
    engine.check(code, passed, passed?.read ?? ((set, index, axis) => this.#corners(passed?.boxes === undefined, set, index, axis)));
  }

  /** The corners of a box that a call passed: in the rows, or among the numbers. */
  #corners(isRow: boolean, set: number, index: number, axis: number): readonly [min: number, max: number] {
    const { stored } = this;
    const numbers = isRow ? this.rowsFor(index + 1) : this.numbers(); // the memory may have grown since they were written
    const at = (isRow ? index : set) * 2 * stored + axis;
    return [numbers[at]!, numbers[at + stored]!];
  }

  /** Makes a call and returns the ids that it reports. */
  answer(call: (exports: WorldExports, world: number) => number, passed?: Passed): Float64Array {
    this.call(call, passed);
    return this.give(this.engine.detail(0), this.engine.detail(1));
  }

  /** Numbers that lie in memory, as a call returns them: a copy, which stays valid; or with the option `views` a view. */
  give(at: number, count: number, which = 0): Float64Array {
    const { engine } = this;
    const given = (this.#given[which] = view(Float64Array, this.#given[which], engine.buffer, at, count));
    return this.isView ? guard(engine, given) : copy(given);
  }

  /** Updates, and writes what changed. */
  update(into: Changes): void {
    // Counted until all has arrived; not where the call throws, which then changed nothing.
    this.call((exports, world) => [exports.world_update(world, this.#failures), this.#failures++][0]!);
    const { engine } = this;
    const [at, total, begun] = [engine.detail(0), engine.detail(1), this.numbers()[0]!];
    into.begun = this.give(at, begun);
    into.ended = this.give(at + 8 * begun, total - begun, 1);
    this.#failures = 0;
  }

  /** The numbers that go in and out, where they are now. */
  numbers(): Float64Array {
    this.#handle.checkUsable();
    // Growing the memory detaches the view, which leaves it with length 0.
    if (this.#numbers.length === 0) this.#numbers = new Float64Array(this.engine.buffer, this.#numbersAt, 16);
    return this.#numbers;
  }

  /** Writes a box, from one object or from separate numbers: as many as it has, and nothing else. */
  writeBox(a: unknown, b: unknown, c: unknown, d: unknown, e: unknown, f: unknown, more: unknown): void {
    if (typeof a === "object" && a !== null) {
      if (b !== undefined) throw new TypeError(`there are more arguments than \`box\``);
      this.write(0, readCorners(a, this.dimensions, "box"));
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

  /** Writes corners that were read, with zeros on the axes that the user's boxes do not have. */
  write(at: number, given: Float64Array): void {
    const { dimensions, stored } = this;
    const numbers = this.numbers();
    for (let from = 0; from < given.length; from += dimensions, at += stored) {
      for (let axis = 0; axis < stored; axis++) numbers[at + axis] = axis < dimensions ? given[from + axis]! : 0;
    }
  }

  /** Rows in memory for `count` boxes. */
  rowsFor(count: number): Float32Array | Float64Array {
    const length = 2 * this.stored * count;
    checkFits(length * (this.isDouble ? 8 : 4));
    const at = this.#handle.call((exports, world) => exports.world_rows(world, count)) >>> 0;
    if (at === 0) throw new OutOfMemoryError();
    const Floats: FloatsType = this.isDouble ? Float64Array : Float32Array;
    return (this.#rows = view(Floats, this.#rows, this.engine.buffer, at, length));
  }

  /** Writes boxes to the rows, unless they are already there, and returns how many there are. */
  writeRows(boxes: Boxes): number {
    const rows = checkBoxes(boxes, this.dimensions);
    const count = lengthOf(rows) / (2 * this.dimensions);
    const kept = this.#keep(rows, this.#rows);
    const into = this.rowsFor(count);
    if (kept !== into) writeRows(kept, this.dimensions, into, this.stored);
    return count;
  }

  /** The array of memory for `count` ids. */
  idsFor(count: number): Float64Array {
    checkFits(count * 8);
    const at = this.#handle.call((exports, world) => exports.world_ids_in(world, count)) >>> 0;
    if (at === 0) throw new OutOfMemoryError();
    return (this.#ids = view(Float64Array, this.#ids, this.engine.buffer, at, count));
  }

  /** Writes ids that were kept to their array, unless they are already there. */
  writeIds(kept: Floats): void {
    const into = this.idsFor(lengthOf(kept));
    if (kept !== into) into.set(kept);
  }

  /** The ids, copied if writing other arguments first could move them. */
  keepIds(ids: Floats): Floats {
    return this.#keep(ids, this.#ids);
  }

  /** The numbers, copied if they lie in memory that may grow, unless they are the array that the core will read. */
  #keep(numbers: Floats, written: Floats | undefined): Floats {
    if (numbers === written) return numbers;
    return bufferOf(numbers) === this.engine.buffer ? new Float64Array(numbers) : numbers;
  }
}

type Floats = Float32Array | Float64Array;
type FloatsType = new (buffer: ArrayBuffer, at: number, length: number) => Floats;

/** An empty broad phase of the core. */
export function newWorld(
  engine: Engine<WorldExports>,
  dimensions: Dimensions,
  isDouble: boolean,
  margin = 0,
  prediction = 0,
  isFat = false,
): Handle<WorldExports> {
  const at = engine.call((exports) => exports.world_new(dimensions, isDouble ? 1 : 0, margin, prediction, isFat ? 1 : 0));
  // The cores for events have some numbers of dimensions each.
  if (at === 0) throw new RangeError("`margin` or `prediction` does not fit in single precision, or `wasm` is of another entry");
  return new Handle(engine, at, "BroadPhase", (exports, world) => exports.world_free(world));
}
