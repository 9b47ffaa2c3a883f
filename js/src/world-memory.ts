import { type Boxes, checkBoxes, checkNumbers, type Dimensions, writeRows } from "./boxes.js";
import { checkFits, type Engine } from "./engine.js";
import { OutOfMemoryError } from "./errors.js";
import { guard, view } from "./views.js";
import type { BroadPhaseOptions, Changes, Numbers } from "./world.js";
import { worldCore, type WorldExports } from "./world-core.js";

/**
 * A world as it lies in memory: how it is called, where what a call needs is written, and where its
 * answer is.
 */
export class WorldMemory {
  readonly dimensions: Dimensions;
  /** On how many axes the boxes are stored, at least those that they have. */
  readonly stored: Dimensions;
  readonly isDouble: boolean;
  readonly #owned: Owned;
  readonly #numbersAt: number;
  #numbers: Float64Array | undefined;
  #rows: Float32Array | Float64Array | undefined;
  #ids: Float64Array | undefined;
  #out: Float64Array | undefined;
  #begun: Float64Array | undefined;
  #ended: Float64Array | undefined;

  /**
   * Makes a world.
   *
   * @throws `RangeError` for a margin or prediction that is negative, infinite or NaN.
   */
  constructor(options: Required<BroadPhaseOptions>) {
    const { dimensions, precision, report, margin, prediction } = options;
    this.dimensions = dimensions;
    this.isDouble = precision === "double";
    // There is no core for doubles in the plane, nor for a line: see js/wasm/src/broad_phase/.
    this.stored = this.isDouble ? 3 : (Math.max(2, dimensions) as Dimensions);
    const engine = worldCore.engine();
    const { world_new, world_numbers } = engine.exports;
    const world = world_new(this.stored, Number(this.isDouble), margin, prediction, Number(report === "fat"));
    if (world === 0) throw new RangeError("margin and prediction must be finite and not negative");
    this.#owned = { engine, world };
    this.#numbersAt = world_numbers(world) >>> 0;
    forgotten?.register(this, this.#owned, this.#owned);
  }

  /** Frees the world; to free it twice is no error. */
  free(): void {
    forgotten?.unregister(this.#owned);
    release(this.#owned);
  }

  /** The exports, of a world that was not freed. */
  exports(): WorldExports {
    if (this.#owned.world === 0) throw new TypeError("this BroadPhase was freed");
    return this.#owned.engine.exports;
  }

  /** Asks what cannot fail, and overwrites no view. */
  ask(ask: (exports: WorldExports, world: number) => number): number {
    return ask(this.exports(), this.#owned.world);
  }

  /** Makes a call and throws what its code stands for. */
  call(call: (exports: WorldExports, world: number) => number): void {
    const owned = this.#owned;
    const exports = this.exports();
    owned.engine.calls++;
    try {
      owned.engine.check(call(exports, owned.world));
    } catch (error) {
      // It stopped half-way: there is no world left to go on with.
      if (error instanceof OutOfMemoryError) this.free();
      throw error;
    }
  }

  /** Makes a call and returns the numbers that it tells of. */
  answer(call: (exports: WorldExports, world: number) => number): Float64Array {
    this.call(call);
    const { engine } = this.#owned;
    const { buffer } = engine.exports.memory;
    this.#out = view(Float64Array, this.#out, buffer, engine.detail(0), engine.detail(1));
    return guard(engine, this.#out);
  }

  /** What the call of an update told of, as views of memory. */
  changes(into: Changes): void {
    const { engine } = this.#owned;
    const { buffer } = engine.exports.memory;
    const [at, total, begun] = [engine.detail(0), engine.detail(1), this.numbers()[0]!];
    this.#begun = view(Float64Array, this.#begun, buffer, at, begun);
    this.#ended = view(Float64Array, this.#ended, buffer, at + 8 * begun, total - begun);
    into.begun = guard(engine, this.#begun);
    into.ended = guard(engine, this.#ended);
  }

  /** A copy of the bytes that the last call told of. */
  bytes(): Uint8Array<ArrayBuffer> {
    const { engine } = this.#owned;
    return new Uint8Array(engine.exports.memory.buffer, engine.detail(0), engine.detail(1)).slice();
  }

  /** The 64 bits that the last call told of. */
  bits(): bigint {
    const { engine } = this.#owned;
    return (BigInt(engine.detail(1)) << 32n) | BigInt(engine.detail(0));
  }

  /** The numbers that go in and out, where they are now. */
  numbers(): Float64Array {
    const { buffer } = this.exports().memory;
    return (this.#numbers = view(Float64Array, this.#numbers, buffer, this.#numbersAt, 16));
  }

  /** Writes a box from separate numbers; a missing one becomes NaN, which no box may hold. */
  writeBox(at: number, a: number, b: number, c: number = NaN, d: number = NaN, e: number = NaN, f: number = NaN): void {
    const [numbers, stored] = [this.numbers(), this.stored];
    switch (this.dimensions) {
      case 1:
        this.#writeAxes(numbers, at, a, 0, 0);
        this.#writeAxes(numbers, at + stored, b, 0, 0);
        break;
      case 2:
        this.#writeAxes(numbers, at, a, b, 0);
        this.#writeAxes(numbers, at + stored, c, d, 0);
        break;
      case 3:
        this.#writeAxes(numbers, at, a, b, c);
        this.#writeAxes(numbers, at + stored, d, e, f);
    }
  }

  #writeAxes(numbers: Float64Array, at: number, x: number, y: number, z: number): void {
    numbers[at] = x;
    numbers[at + 1] = y;
    if (this.stored === 3) numbers[at + 2] = z;
  }

  /** Writes one or two corners; numbers on axes that the world does not have are 0. */
  writeNumbers(at: number, values: Numbers, corners: number, name: string): void {
    const { dimensions } = this;
    const given = checkNumbers(values, name);
    if (given.length !== corners * dimensions) {
      throw new RangeError(`${name} must be ${corners * dimensions} numbers, not ${given.length}`);
    }
    const numbers = this.numbers();
    for (let corner = 0; corner < corners; corner++) {
      for (let axis = 0; axis < this.stored; axis++) {
        numbers[at + corner * this.stored + axis] = axis < dimensions ? given[corner * dimensions + axis]! : 0;
      }
    }
  }

  /** The rows of memory for `count` boxes. */
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

  /** Writes boxes to the rows, unless they are there, and returns how many they are. */
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

  /** Writes ids to their array, unless they are there. */
  writeIds(ids: Numbers): void {
    const kept = this.keepIds(ids);
    const into = this.idsFor(kept.length);
    if (!isSame(kept, into)) into.set(kept);
  }

  /** The ids, copied if what is written before them could move them. */
  keepIds(ids: Numbers): Numbers {
    return this.#keep(ids, this.#ids);
  }

  /** The numbers, copied if they lie in memory that may grow, unless just where they will be read. */
  #keep<T extends Numbers>(numbers: T, written: Float32Array | Float64Array | undefined): T {
    const isOutside = !ArrayBuffer.isView(numbers) || numbers.buffer !== this.exports().memory.buffer;
    return isOutside || (written && isSame(numbers, written)) ? numbers : (numbers.slice() as unknown as T);
  }
}

/** Whether an array lies where another does. */
function isSame(a: Numbers, b: Float32Array | Float64Array): boolean {
  return ArrayBuffer.isView(a) && a.buffer === b.buffer && a.byteOffset === b.byteOffset;
}

/** What a world holds on the other side: a handle, or 0 once it is freed. */
interface Owned {
  readonly engine: Engine<WorldExports>;
  world: number;
}

function release(owned: Owned): void {
  if (owned.world !== 0) owned.engine.exports.world_free(owned.world);
  owned.world = 0;
}

/** Frees the worlds that nobody freed and nobody can reach. */
const forgotten =
  typeof FinalizationRegistry === "undefined" ? undefined : new FinalizationRegistry<Owned>(release);
