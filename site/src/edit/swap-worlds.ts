/** Arrays that were sorted one frame ago: the endpoints of boxes in that order, each with its coordinate of now. */
export const SWAP_WORLDS: readonly (readonly (readonly [box: string, side: "(" | ")", at: number])[])[] = [
  [["A", "(", 2], ["A", ")", 6], ["B", "(", 5], ["B", ")", 9]],
  [["A", "(", 4], ["B", "(", 1], ["A", ")", 7], ["C", "(", 8], ["B", ")", 6], ["C", ")", 12]],
  [["A", "(", 9], ["A", ")", 13], ["B", "(", 2], ["B", ")", 5], ["C", "(", 6], ["C", ")", 10]],
];
