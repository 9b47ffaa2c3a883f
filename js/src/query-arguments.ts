import { describe } from "./describe.js";

/** @internal A length that may be infinite. */
export function checkLength(value: unknown, name: string): number {
  if (typeof value !== "number") throw new TypeError(`\`${name}\` must be a number, not ${describe(value)}`);
  if (!(value >= 0)) throw new RangeError(`\`${name}\` is ${value}; it must be 0 or more`);
  return value;
}

/** @internal A whole number below 2^32. */
export function checkCount(value: unknown, name: string): number {
  if (!(Number.isInteger(value) && (value as number) >= 0 && (value as number) < 2 ** 32)) {
    throw new RangeError(`\`${name}\` is ${describe(value)}; it must be a whole number from 0 to 2^32 - 1`);
  }
  return value as number;
}
