import type { Engine, Exports } from "./engine.js";
import { InterruptedError } from "./errors.js";

/**
 * An object of the core. Every call with it goes through {@link Handle.call}, so that none is made with an object that
 * was freed, and none after one that ended halfway.
 *
 * The arguments of a call are read and checked before: what is read from an object of the user may run any code.
 */
export class Handle<E extends Exports> {
  /** Where the object is; 0 once it is freed. */
  #at: number;
  /** Whether the last call threw, which may have been halfway. */
  #hasThrown = false;

  /** `name` is that of the class that the user sees. */
  constructor(
    readonly engine: Engine<E>,
    at: number,
    readonly name: string,
    readonly release: (exports: E, at: number) => void,
  ) {
    this.#at = at >>> 0;
  }

  /** Makes a call of the core, which must not run any code of the user with access to this object. */
  call<R>(call: (exports: E, at: number) => R): R {
    if (this.#at === 0 || this.#hasThrown) this.checkUsable();
    this.#hasThrown = true;
    const result = this.engine.call(call, this.#at);
    this.#hasThrown = false;
    return result;
  }

  /** Throws if no call can be made. */
  checkUsable(): void {
    if (this.#at === 0) throw new TypeError(`this ${this.name} was freed`);
    // The first word of an object says whether a call is under way.
    if (this.#hasThrown && this.engine.words()[this.#at / 4] !== 0) throw new InterruptedError(this.name);
  }

  /** Frees the memory, except of an object whose call ended halfway: its parts could be freed twice. Freeing twice is not an error. */
  free(): void {
    this.engine.calls++;
    if (this.#at) this.engine.call(this.release, this.#at);
    this.#at = 0;
  }

  /** Frees the memory after a call that ran out of memory, which leaves the parts of an object whole. */
  discard(): void {
    this.engine.words()[this.#at / 4] = 0;
    this.free();
  }
}

/** Frees the objects whose owners were garbage collected. */
export const forgotten: FinalizationRegistry<{ free(): void }> | undefined =
  typeof FinalizationRegistry === "undefined" ? undefined : new FinalizationRegistry((object) => object.free());
