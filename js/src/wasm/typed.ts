/**
 * What typed arrays are by themselves. Their properties can be overridden, by a subclass or on the array: a `length`
 * that is another each time, a `buffer` that runs code. These cannot.
 */
const getter = (key: string | symbol): (() => unknown) =>
  Object.getOwnPropertyDescriptor(Object.getPrototypeOf(Uint8Array.prototype), key)!.get!;

// Each is a constant of its own, so that engines compile it to what the property itself compiles to.
const tag = getter(Symbol.toStringTag);
const length = getter("length");
const buffer = getter("buffer");

/** The name of its type, for arrays of other realms too; `undefined` for anything else. */
export const tagOf = (value: unknown): string | undefined => tag.call(value) as string | undefined;

/** How many numbers it has: 0 if its buffer is detached. */
export const lengthOf = (array: ArrayLike<unknown>): number => length.call(array) as number;

/** Its buffer. */
export const bufferOf = (array: ArrayBufferView): ArrayBufferLike => buffer.call(array) as ArrayBufferLike;
