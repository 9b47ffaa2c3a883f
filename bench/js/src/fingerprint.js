// What two sets of pairs are compared by.

/**
 * The number of pairs and a hash that depends neither on their order nor on which box of a pair
 * comes first, but on how often each is given.
 */
export class Fingerprint {
  pairs = 0;
  #low = 0;
  #high = 0;

  /** @param {ArrayLike<number>} pairs `a0, b0, a1, b1, ...` */
  add(pairs) {
    this.pairs += pairs.length / 2;
    for (let i = 0; i < pairs.length; i += 2) {
      const [a, b] = [Math.min(pairs[i], pairs[i + 1]), Math.max(pairs[i], pairs[i + 1])];
      this.#low = (this.#low + mix(mix(a ^ 0x9e3779b9) ^ b)) | 0;
      this.#high = (this.#high + mix(mix(b ^ 0x85ebca6b) ^ a)) | 0;
    }
    return this;
  }

  toString() {
    const hex = (/** @type {number} */ word) => (word >>> 0).toString(16).padStart(8, "0");
    return `${this.pairs}:${hex(this.#high)}${hex(this.#low)}`;
  }
}

/** The finalizer of MurmurHash3 (Appleby, 2011). */
function mix(/** @type {number} */ x) {
  x = Math.imul(x ^ (x >>> 16), 0x85ebca6b);
  x = Math.imul(x ^ (x >>> 13), 0xc2b2ae35);
  return x ^ (x >>> 16);
}
