import { PairList } from "./pair-list.js";
import { overlaps } from "./rows.js";

/**
 * The pairs of boxes a little larger than the exact ones, as engines report them when they begin
 * and end; the exact pairs are those of them that pass one more test.
 */
export class Candidates {
  #pairs = new PairList();
  /** @type {Map<number, number>} */
  #places = new Map();
  /** @type {number[]} */
  #a = [];
  /** @type {number[]} */
  #b = [];

  /**
   * @param {number} dimensions
   * @param {number} boxes
   */
  constructor(dimensions, boxes) {
    this.dimensions = dimensions;
    this.boxes = boxes;
  }

  /** Adds a pair, if it is not there. */
  add(/** @type {number} */ a, /** @type {number} */ b) {
    const key = a < b ? a * this.boxes + b : b * this.boxes + a;
    if (this.#places.has(key)) return;
    this.#places.set(key, this.#a.length);
    this.#a.push(a);
    this.#b.push(b);
  }

  /** Removes a pair, if it is there. */
  remove(/** @type {number} */ a, /** @type {number} */ b) {
    const key = a < b ? a * this.boxes + b : b * this.boxes + a;
    const place = this.#places.get(key);
    if (place !== undefined) this.#removeAt(place, key);
  }

  /**
   * Removes the pairs that are no candidates any more.
   *
   * @param {(a: number, b: number) => boolean} isCandidate
   */
  keep(isCandidate) {
    for (let place = this.#a.length - 1; place >= 0; place--) {
      const [a, b] = [this.#a[place], this.#b[place]];
      if (!isCandidate(a, b)) this.#removeAt(place, a < b ? a * this.boxes + b : b * this.boxes + a);
    }
  }

  #removeAt(/** @type {number} */ place, /** @type {number} */ key) {
    this.#places.delete(key);
    const [a, b] = [this.#a.pop(), this.#b.pop()];
    if (place === this.#a.length) return;
    this.#a[place] = a;
    this.#b[place] = b;
    this.#places.set(a < b ? a * this.boxes + b : b * this.boxes + a, place);
  }

  /** The pairs whose exact boxes overlap. */
  exact(/** @type {Float32Array} */ rows) {
    this.#pairs.clear();
    for (let i = 0; i < this.#a.length; i++) {
      if (overlaps(rows, this.dimensions, this.#a[i], this.#b[i])) this.#pairs.push(this.#a[i], this.#b[i]);
    }
    return this.#pairs.pairs;
  }
}
