/** The arrays that views of memory are. */
export type Typed = Float32Array | Float64Array | Uint32Array | Uint8Array;

/** The last view if it still is the one asked for, which saves the garbage, or a new one. */
export function view<T extends Typed>(
  Type: new (buffer: ArrayBuffer, at: number, length: number) => T,
  last: Typed | undefined,
  buffer: ArrayBuffer,
  at: number,
  length: number,
): T {
  const isSame =
    last instanceof Type && last.buffer === buffer && last.byteOffset === at && last.length === length;
  return isSame ? last : new Type(buffer, at, length);
}

/** What knows whether its memory may have changed since. */
interface Clock {
  /** Whether views are to be watched. */
  readonly isDevelopment: boolean;
  /** How many calls have been made that may overwrite what a view shows. */
  readonly calls: number;
}

/** The views that stand behind what {@link guard} returned. */
const guarded = new WeakMap<object, Typed>();

/** A view that {@link guard} gave out, for a call that takes it; other values as they are. */
export function unguard(value: unknown): unknown {
  const view = typeof value === "object" && value !== null ? guarded.get(value) : undefined;
  if (view === undefined) return value;
  (value as Typed).length; // throws if it is stale
  return view;
}

/**
 * The view itself; in development mode something like it, which throws when it is used after it
 * has become stale.
 */
export function guard<T extends Typed>(clock: Clock, view: T): T {
  if (!clock.isDevelopment) return view;
  const { calls } = clock;
  const check = (): void => {
    if (clock.calls !== calls) {
      throw new TypeError("this view is stale: views are valid until the next call of sweep-and-prune; copy it first");
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
