/** It speaks no more often. */
const SPEECH_MS = 700;

/** What a live region says: soon, not too often, and the latest only. */
export class Speech {
  readonly #region: () => Element | null;
  readonly #sentence: () => string;
  #timer: ReturnType<typeof setTimeout> | undefined;
  #spokenAt = -Infinity;

  constructor(region: () => Element | null, sentence: () => string) {
    this.#region = region;
    this.#sentence = sentence;
  }

  /** Says the sentence as it will be then, after this. */
  soon(first = ""): void {
    clearTimeout(this.#timer);
    const wait = Math.max(100, this.#spokenAt + SPEECH_MS - performance.now());
    this.#timer = setTimeout(() => {
      this.#spokenAt = performance.now();
      this.now(`${first} ${this.#sentence()}`.trim());
    }, wait);
  }

  /** Says this. */
  now(text: string): void {
    const region = this.#region();
    if (region) region.textContent = text;
  }

  stop(): void {
    clearTimeout(this.#timer);
  }
}
