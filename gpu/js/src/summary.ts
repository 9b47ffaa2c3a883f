/** What a search reports beside the pairs. */
export interface Summary {
  /** The exact number of pairs, also where not all of them were written; 2^32 - 1 means that many or more. */
  readonly found: number;

  /** The number of pairs that were written. */
  readonly written: number;

  /** The number of invalid boxes: NaN, inverted, or in a world of 2^31 or more. They have no pairs. */
  readonly invalid: number;

  /** The index of the first invalid box; boxes of a second set count on from those of the first. 0 if there is none. */
  readonly firstInvalid: number;
}

/**
 * The bytes of a summary buffer: sixteen 32-bit whole numbers. The first four are the fields of {@link Summary}. From byte
 * {@link SUMMARY_DISPATCH} on there are the arguments of an indirect dispatch with at least one thread for each pair, and
 * from byte {@link SUMMARY_DRAW} on those of an indirect draw with one instance for each pair.
 */
export const SUMMARY_BYTES = 64;

/** Where the arguments of an indirect dispatch begin in a summary buffer, in bytes. */
export const SUMMARY_DISPATCH = 16;

/** Where the arguments of an indirect draw begin in a summary buffer, in bytes. */
export const SUMMARY_DRAW = 32;

/** The summary that a buffer begins with. */
export function summaryOf(numbers: Uint32Array): Summary {
  const [found = 0, written = 0, invalid = 0, firstInvalid = 0] = numbers;
  return { found, written, invalid, firstInvalid };
}
