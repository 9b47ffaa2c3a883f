import { InvalidBoxError, OutOfMemoryError, SweepAndPruneError } from "./errors.js";

// The types of WebAssembly are not named where declarations show them: not every project has them.

/** A `WebAssembly.Module`. */
export type Module = object;

/** What every compiled core exports. Pointers and counts are signed numbers: `>>> 0` makes them unsigned. */
export interface Exports {
  readonly memory: { readonly buffer: ArrayBuffer };
  readonly __stack_pointer: { value: number };
  status(): number;
}

/** The codes that bindings/wasm/src/status.rs gives. */
export const enum Code {
  Ok = 0,
  InvalidBox = 1,
  OutOfMemory = 2,
  Internal = 3,
  StaleProxy = 4,
  InvalidArgument = 5,
  InvalidSnapshot = 6,
}

/** Takes pairs that lie in memory, and returns whether it wants more. */
export type Each = (at: number, count: number) => boolean;

/** Names what a call passed, for its errors. */
export interface Passed {
  /** The arguments that hold boxes, in the order in which the core counts them, and how many they hold. */
  readonly boxes?: readonly (readonly [name: string, count: number])[];
  /** The ids. */
  readonly ids?: ArrayLike<number>;
  /** Reads the corners of these boxes, if they are not where a call usually writes them. */
  readonly read?: ReadCorners;
}

/** Reads the min and the max of a box that a call passed: which argument, which box of it, which axis. */
type ReadCorners = (set: number, index: number, axis: number) => readonly [min: number, max: number];

/** Refuses what memory cannot hold: the core would see the size modulo 2^32. */
export function checkFits(bytes: number): void {
  if (!(bytes < 2 ** 32)) throw new OutOfMemoryError();
}

/** A compiled core that was started, and what its calls have in common. */
export class Engine<E extends Exports> {
  /** Takes the pairs of a search: set while `streamPairs` makes a call. */
  each: Each = () => false;
  /** Where Rust's stack ends for the calls that are made now: at its top, or, within a callback, below the frames of the outer call. */
  stackTop = 0;
  /** Whether a call threw, so that the stack pointer has yet to be put back; also while a call is under way. */
  isStackLeft = false;
  #statusAt = 0;
  /** All of memory, as words and as bytes: asking WebAssembly for it takes longer. */
  #words = new Uint32Array(0);
  #buffer = this.#words.buffer;
  /** How many calls have been made that may overwrite what a view shows; see {@link guard}. */
  calls = 0;

  private constructor(
    readonly exports: E,
    readonly isDevelopment: boolean,
  ) {}

  static async start<E extends Exports>(module: Module, known: string, isDevelopment: boolean): Promise<Engine<E>> {
    let engine: Engine<E>;
    const imports = {
      // Rust calls this when it cannot continue. Throwing skips its frames: see {@link call}.
      fail: (isOutOfMemory: number) => engine.check(isOutOfMemory === 0 ? Code.Internal : Code.OutOfMemory),
      each: (at: number, count: number) => engine.each(at >>> 0, count >>> 0),
    };
    // Not `new WebAssembly.Instance`, which some browsers refuse on the main thread.
    const instance = await WebAssembly.instantiate(module as WebAssembly.Module, { sweep_and_prune: imports });
    if (!(known in instance.exports)) throw new TypeError("`wasm` is not the compiled core of this entry");
    engine = new Engine(instance.exports as unknown as E, isDevelopment);
    engine.stackTop = engine.exports.__stack_pointer.value;
    engine.#statusAt = (engine.exports.status() >>> 0) / 4;
    return engine;
  }

  /**
   * Makes a call of the core. A call that throws skips Rust's frames, so the next one first puts the stack pointer back.
   * It throws if an import does, and where the engine's own stack runs out, in any function.
   */
  call<R>(call: (exports: E, at: number) => R, at = 0): R {
    if (this.isStackLeft) this.exports.__stack_pointer.value = this.stackTop;
    this.isStackLeft = true;
    const result = call(this.exports, at);
    this.isStackLeft = false;
    return result;
  }

  /** All of memory as words. Call it again after each call of the core, which may let the memory grow. */
  words(): Uint32Array {
    // Growing the memory detaches the view, which leaves it with length 0.
    if (this.#words.length === 0) this.#words = new Uint32Array((this.#buffer = this.exports.memory.buffer));
    return this.#words;
  }

  /** All of memory. Read it again after each call of the core, too. */
  get buffer(): ArrayBuffer {
    this.words();
    return this.#buffer;
  }

  /** A word of detail about the last call: which box, which axis, where, how many. */
  detail(word: 0 | 1): number {
    return this.words()[this.#statusAt + word]!;
  }

  /** Throws the error of a code other than `Ok`: of those that every core has. */
  check(code: number, passed: Passed = {}, read?: ReadCorners): void {
    switch (code) {
      case Code.Ok:
        return;
      case Code.InvalidBox:
        throw invalidBox(this.detail(0), this.detail(1), passed, read);
      case Code.OutOfMemory:
        throw new OutOfMemoryError();
      default:
        throw new SweepAndPruneError(`internal error ${code}: please report it`);
    }
  }
}

/** The box at fault, counted within the argument that holds it. */
function invalidBox(index: number, axis: number, { boxes = [["boxes", Infinity]] }: Passed, read?: ReadCorners): InvalidBoxError {
  let set = 0;
  while (set + 1 < boxes.length && index >= boxes[set]![1]) index -= boxes[set++]![1];
  return new InvalidBoxError(index, axis, boxes[set]![0], ...(read?.(set, index, axis) ?? []));
}
