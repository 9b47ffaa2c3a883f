import { describe } from "./describe.js";
import { OutOfMemoryError } from "./errors.js";

/** The arrays that views of memory are. */
export type Typed = Float32Array | Float64Array | Uint32Array | Uint8Array;

/** The last view of this memory if it still shows this part, which avoids garbage, or a new one. */
export function view<T extends Typed>(
  Type: new (buffer: ArrayBuffer, at: number, length: number) => T,
  last: Typed | undefined,
  buffer: ArrayBuffer,
  at: number,
  length: number,
): T {
  // Growing the memory detaches views, which leaves them at 0, where nothing lies.
  const isSame = last instanceof Type && last.byteOffset === at && last.length === length;
  return isSame ? last : new Type(buffer, at, length);
}

/** Tells whether memory may have changed. */
interface Clock {
  /** Whether to check the use of views. */
  readonly isDevelopment: boolean;
  /** How many calls have been made that may overwrite what a view shows. */
  readonly calls: number;
}

/** The views behind the proxies that {@link guard} returned. */
const guarded = new WeakMap<object, Typed>();

/** The view behind a proxy of {@link guard}; other values are returned as they are. */
export function unguard(value: unknown): unknown {
  const view = typeof value === "object" && value !== null ? guarded.get(value) : undefined;
  if (view === undefined) return value;
  (value as Typed).length; // throws if it is stale
  return view;
}

/**
 * A copy of a view.
 *
 * @throws {@link OutOfMemoryError} if JavaScript cannot allocate it.
 */
export function copy<T extends Typed>(view: T): T {
  // Faster than `slice`, which fills the memory with zeros first.
  return allocate(() => new (view.constructor as new (of: T) => T)(view));
}

/** A new array; if there is no memory for it, it throws {@link OutOfMemoryError}. */
export function allocate<T>(make: () => T): T {
  try {
    return make();
  } catch {
    throw new OutOfMemoryError();
  }
}

/** @internal The option `views`, checked. */
export function checkViews(views: unknown): boolean {
  if (views !== undefined && typeof views !== "boolean") throw new TypeError(`\`views\` must be true or false, not ${describe(views)}`);
  return views === true;
}

/** The view itself; in development mode a proxy of it that throws if it is used when it is stale. */
export function guard<T extends Typed>(clock: Clock, view: T): T {
  if (!clock.isDevelopment) return view;
  const { calls } = clock;
  const check = (): void => {
    if (clock.calls !== calls) {
      throw new TypeError("this view is stale: views are valid until the next call; copy it first");
    }
  };
  const proxy = new Proxy(view, {
    get(target, key) {
      check();
      const value: unknown = Reflect.get(target, key, target);
      return typeof value === "function" && key !== "constructor" ? value.bind(target) : value;
    },
    set(target, key, value) {
      check();
      return Reflect.set(target, key, value, target);
    },
  });
  guarded.set(proxy, view);
  return proxy;
}
