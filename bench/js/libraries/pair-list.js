/** A growing list of pairs: what libraries that call back with each pair store them in. */
export class PairList {
  #words = new Uint32Array(1 << 12);
  #length = 0;

  clear() {
    this.#length = 0;
  }

  /**
   * @param {number} a
   * @param {number} b
   */
  push(a, b) {
    if (this.#length === this.#words.length) this.#grow();
    this.#words[this.#length++] = a;
    this.#words[this.#length++] = b;
  }

  #grow() {
    const words = new Uint32Array(2 * this.#words.length);
    words.set(this.#words);
    this.#words = words;
  }

  /** The pairs so far, `a0, b0, a1, b1, ...`: a view, valid until the next change. */
  get pairs() {
    return this.#words.subarray(0, this.#length);
  }
}
