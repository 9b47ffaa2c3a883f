import { InvalidBoxError, NotInitializedError, OutOfMemoryError, SweepAndPruneError } from "./errors.js";

/** What js/wasm/ exports. Pointers and counts come as signed numbers: `>>> 0` makes them whole. */
export interface Exports {
  readonly memory: WebAssembly.Memory;
  readonly __stack_pointer: WebAssembly.Global<"i32">;
  status(): number;
  finder_new(dimensions: number, double: number): number;
  finder_rows(finder: number, count: number): number;
  finder_find(finder: number, count: number): number;
  finder_free(finder: number): void;
}

/** The codes that js/wasm/src/status.rs gives. */
const enum Code {
  Ok = 0,
  InvalidBox = 1,
  OutOfMemory = 2,
}

/** The compiled core at work, and what its calls need around them. */
export class Engine {
  readonly #statusAt: number;
  #words = new Uint32Array(0);

  constructor(readonly exports: Exports) {
    this.#statusAt = (exports.status() >>> 0) / 4;
  }

  /** A word of detail about the last call: which box, which axis, where, how many. */
  detail(word: 0 | 1): number {
    // Growing the memory detaches the view of what it was, which leaves it with length 0.
    if (this.#words.length === 0) this.#words = new Uint32Array(this.exports.memory.buffer);
    return this.#words[this.#statusAt + word]!;
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
      default:
        throw new SweepAndPruneError(`internal error ${code}: please report it`);
    }
  }
}

let ready: Engine | undefined;

/** The engine, once {@link startEngine} is done. */
export function engine(): Engine {
  if (ready === undefined) throw new NotInitializedError();
  return ready;
}

/** Starts the engine of every later call. */
export async function startEngine(module: WebAssembly.Module): Promise<void> {
  // Rust calls this where it can go on no further. Throwing skips its frames, so that the stack
  // pointer has to be put back; no call into Rust is ever nested in another.
  const fail = (isOutOfMemory: number): never => {
    stackPointer.value = stackTop;
    throw isOutOfMemory ? new OutOfMemoryError() : new SweepAndPruneError("internal error: please report it");
  };
  // Not `new WebAssembly.Instance`, which some browsers refuse on the main thread.
  const instance = await WebAssembly.instantiate(module, { sweep_and_prune: { fail } });
  const exports = instance.exports as unknown as Exports;
  const stackPointer = exports.__stack_pointer;
  const stackTop = stackPointer.value;
  ready = new Engine(exports);
}
