import {
  InvalidBoxError,
  NotInitializedError,
  OutOfMemoryError,
  SnapshotError,
  StaleProxyError,
  SweepAndPruneError,
} from "./errors.js";

/** What every build of js/wasm/ exports. Pointers and counts come as signed numbers: `>>> 0` makes them whole. */
export interface Exports {
  readonly memory: WebAssembly.Memory;
  readonly __stack_pointer: WebAssembly.Global<"i32">;
  status(): number;
}

/** The codes that js/wasm/src/status.rs gives. */
const enum Code {
  Ok = 0,
  InvalidBox = 1,
  OutOfMemory = 2,
  StaleProxy = 4,
  InvalidArgument = 5,
  InvalidSnapshot = 6,
}

/** Takes pairs, as words of memory; whether it wants more. */
export type Each = (at: number, count: number) => boolean;

/** Refuses what memory cannot hold; the core would see its size modulo 2^32. */
export function checkFits(bytes: number): void {
  if (!(bytes < 2 ** 32)) throw new OutOfMemoryError();
}

/** A compiled core at work, and what its calls need around them. */
export class Engine<E extends Exports> {
  /** Set while a call of {@link stream} is under way. */
  #each: Each = () => false;
  #stackTop = 0;
  #statusAt = 0;
  #words = new Uint32Array(0);
  /** How many calls have been made that may overwrite what a view shows; see {@link guard}. */
  calls = 0;

  private constructor(
    readonly exports: E,
    readonly isDevelopment: boolean,
  ) {}

  static async start<E extends Exports>(module: WebAssembly.Module, known: string, isDevelopment: boolean): Promise<Engine<E>> {
    let engine: Engine<E>;
    const imports = {
      fail: (isOutOfMemory: number) => engine.#fail(isOutOfMemory !== 0),
      each: (at: number, count: number) => engine.#each(at >>> 0, count >>> 0),
    };
    // Not `new WebAssembly.Instance`, which some browsers refuse on the main thread.
    const instance = await WebAssembly.instantiate(module, { sweep_and_prune: imports });
    if (!(known in instance.exports)) throw new TypeError("`wasm` is the compiled core of another entry, or of something else");
    engine = new Engine(instance.exports as unknown as E, isDevelopment);
    engine.#stackTop = engine.exports.__stack_pointer.value;
    engine.#statusAt = (engine.exports.status() >>> 0) / 4;
    return engine;
  }

  /** All of memory as words: to be asked for again after each call, which may let it grow. */
  words(): Uint32Array {
    // Growing the memory detaches the view of what it was, which leaves it with length 0.
    if (this.#words.length === 0) this.#words = new Uint32Array(this.exports.memory.buffer);
    return this.#words;
  }

  /** A word of detail about the last call: which box, which axis, where, how many. */
  detail(word: 0 | 1): number {
    return this.words()[this.#statusAt + word]!;
  }

  /** Throws what a code other than `Ok` stands for. */
  check(code: number): void {
    switch (code) {
      case Code.Ok:
        return;
      case Code.InvalidBox:
        throw new InvalidBoxError(this.detail(0), this.detail(1));
      case Code.OutOfMemory:
        throw new OutOfMemoryError();
      case Code.StaleProxy:
        throw new StaleProxyError(this.detail(0));
      case Code.InvalidArgument:
        throw new RangeError(`argument ${this.detail(0)} is NaN, infinite, negative or inverted where it must not be`);
      case Code.InvalidSnapshot:
        throw new SnapshotError(this.detail(0), this.detail(1));
      default:
        throw new SweepAndPruneError(`internal error ${code}: please report it`);
    }
  }

  /**
   * Makes a call that hands pairs to `each`. What `each` throws ends the search, and is thrown
   * from here: Rust's frames are left by returning. Within `each` other calls are allowed.
   */
  stream(call: () => number, each: Each): void {
    const outer = this.#each;
    let thrown: { error: unknown } | undefined;
    this.#each = (at, count) => {
      // The frames of the call under way stay where they are if a call within `each` fails.
      const stackTop = this.#stackTop;
      this.#stackTop = this.exports.__stack_pointer.value;
      try {
        return each(at, count);
      } catch (error) {
        thrown = { error };
        return false;
      } finally {
        this.#stackTop = stackTop;
      }
    };
    try {
      const code = call();
      if (thrown) throw thrown.error;
      this.check(code);
    } finally {
      this.#each = outer;
    }
  }

  /**
   * Rust calls this where it can go on no further. Throwing skips its frames, so that the stack
   * pointer has to be put back to where it was when JavaScript called.
   */
  #fail(isOutOfMemory: boolean): never {
    this.exports.__stack_pointer.value = this.#stackTop;
    throw isOutOfMemory ? new OutOfMemoryError() : new SweepAndPruneError("internal error: please report it");
  }
}

/** One of the compiled cores: at first none, then an engine, started once. */
export class Core<E extends Exports> {
  #engine: Engine<E> | undefined;

  /** `known` is the name of an export that only this core has. */
  constructor(readonly known: string & keyof E) {}

  /** The engine, once {@link start} is done. */
  engine(): Engine<E> {
    if (this.#engine === undefined) throw new NotInitializedError();
    return this.#engine;
  }

  async start(module: WebAssembly.Module, isDevelopment: boolean): Promise<void> {
    this.#engine = await Engine.start<E>(module, this.known, isDevelopment);
  }
}
