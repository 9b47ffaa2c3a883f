import type { FilterWords } from "./world-core.js";

/**
 * Which bodies may pair. Two do if their boxes overlap and
 *
 * 1. at least one of them is not static;
 * 2. they are of the same group, other than 0, and it is positive; or they are not of the same
 *    group (or of group 0), and each one's category has a bit in the other's mask.
 *
 * These are box2d's rules.
 */
export interface Filter {
  /** What the body is: 32 bits. 1 by default. */
  category: number;
  /** What it pairs with: the categories of others. All bits by default. */
  mask: number;
  /** 0, or a number that decides over category and mask between two of the same group. */
  group: number;
  /** Whether it is a static body: two of these never pair. False by default. */
  isStatic: boolean;
}

/** What a body has unless told otherwise. */
export const defaultFilter: Filter = { category: 1, mask: 2 ** 32 - 1, group: 0, isStatic: false };

/** What a query sees the world with unless told otherwise. */
export const everything: Filter = { category: 2 ** 32 - 1, mask: 2 ** 32 - 1, group: 0, isStatic: false };

/** A filter, checked, as the core takes it. What is left out is that of `others`. */
export function filterWords(filter: Partial<Filter>, others: Filter): FilterWords {
  if (typeof filter !== "object" || filter === null) throw new TypeError(`a filter must be an object, not ${String(filter)}`);
  const { category = others.category, mask = others.mask, group = others.group, isStatic = others.isStatic } = filter;
  // Bits may be written as signed numbers too: ~2 is all but the second.
  for (const [name, bits] of [["category", category], ["mask", mask], ["group", group]] as const) {
    if (!(Number.isInteger(bits) && bits >= -(2 ** 31) && bits < 2 ** 32)) {
      throw new RangeError(`${name} must be a whole number of 32 bits, not ${String(bits)}`);
    }
  }
  return [category, mask, group, Number(isStatic)];
}
