import { describe } from "../wasm/describe.js";
import { checkOptionNames } from "../wasm/options.js";

/** A filter as the core takes it: category, mask, group, whether static. */
export type FilterWords = [number, number, number, number];

/**
 * Which bodies may pair. Two bodies pair if their boxes overlap and
 *
 * 1. at least one of them is not static;
 * 2. if both have the same group, other than 0: the group is positive; otherwise: the category of
 *    each has a bit in common with the mask of the other.
 *
 * These are the rules of Box2D.
 */
export interface Filter {
  /** What the body is: 32 bits. 1 by default. */
  category: number;
  /** The categories that it pairs with. All bits by default. */
  mask: number;
  /** Between two bodies of the same group, other than 0, it overrides category and mask: positive, they pair; negative, they do not. */
  group: number;
  /** Whether it is static: two static bodies never pair. False by default. */
  isStatic: boolean;
}

/** The filter of a body by default. */
export const defaultFilter: Filter = { category: 1, mask: 2 ** 32 - 1, group: 0, isStatic: false };

/** @internal What a filter has. */
export const filterNames: string[] = Object.keys(defaultFilter);

/** A filter as the core takes it, checked. `others` gives what is left out. */
export function filterWords(filter: Partial<Filter>, others: Filter): FilterWords {
  if (typeof filter !== "object" || filter === null) throw new TypeError(`\`filter\` must be an object, not ${describe(filter)}`);
  for (const key in filter) if (key !== "mask" && key !== "category" && key !== "group" && key !== "isStatic") checkOptionNames(filter, filterNames, "filter");
  const { category = others.category, mask = others.mask, group = others.group, isStatic = others.isStatic } = filter;
  // Bits may be written as signed numbers too: ~2 is all but the second.
  for (const [name, bits] of Object.entries({ category, mask, group })) {
    const limit = 2 ** (name === "group" ? 31 : 32); // the sign of a group has a meaning
    if (!(Number.isInteger(bits) && bits >= -(2 ** 31) && bits < limit)) {
      throw new RangeError(`\`${name}\` of the filter is ${describe(bits)}; it must be a whole number below ${limit}`);
    }
  }
  if (typeof isStatic !== "boolean") throw new TypeError(`\`isStatic\` of the filter must be true or false, not ${describe(isStatic)}`);
  return [category, mask, group, isStatic ? 1 : 0];
}
