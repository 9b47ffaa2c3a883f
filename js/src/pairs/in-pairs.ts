/**
 * The pairs of an array that has two numbers a pair, as every call here returns them: for a loop that is short rather than
 * as fast as one over the numbers.
 *
 * @example
 * ```js
 * for (const [a, b] of inPairs(findPairs(boxes, { dimensions: 2 }))) collide(a, b);
 * ```
 */
export function* inPairs(numbers: ArrayLike<number>): Generator<[number, number], void, undefined> {
  for (let at = 0; at < numbers.length; at += 2) yield [numbers[at]!, numbers[at + 1]!];
}
