/** The balls that a visitor has chosen: two for an explanation, and one for the keys. */
export class Selection {
  /** At most two. */
  chosen: readonly number[] = [];
  /** The one that keys act on. */
  cursor: number | undefined;

  /** All of them, to be marked. */
  get marked(): readonly number[] {
    return this.cursor === undefined ? this.chosen : [...new Set([...this.chosen, this.cursor])];
  }

  get pair(): readonly [number, number] | undefined {
    const [a, b] = this.chosen;
    return a === undefined || b === undefined ? undefined : [a, b];
  }

  clear(): void {
    this.chosen = [];
    this.cursor = undefined;
  }

  /** Takes one more: the second of a pair, or the first of the next. The same ball again, or none, takes all back. */
  take(ball: number | undefined): void {
    const [first, second] = this.chosen;
    if (ball === undefined || (ball === first && second === undefined)) this.chosen = [];
    else this.chosen = first === undefined || second !== undefined ? [ball] : [first, ball];
  }

  /** Moves the cursor round `count` balls. */
  moveCursor(by: 1 | -1, count: number): void {
    this.cursor = this.cursor === undefined ? (by > 0 ? 0 : count - 1) : (this.cursor + by + count) % count;
  }
}
