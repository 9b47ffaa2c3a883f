// One library on one scene: its pairs, and its times. The same in Node and in the browser.
import { Fingerprint } from "./fingerprint.js";

/**
 * Tells how many milliseconds have passed since a start.
 *
 * @typedef {{ start(): any, since(start: any): number }} Clock
 */

/** The warm-up in milliseconds: long enough for the engine to compile everything. */
const WARM_UP = 150;
/** The most calls of the warm-up. */
const WARM_UP_CALLS = 1000;

export class Trial {
  #scene;
  #library;
  #clock;
  /** What began and did not end, of a library that tells only that. */
  #live = new Set();
  #current = new Float32Array();

  /**
   * @param {Awaited<ReturnType<import("./scenes.js").Scenes["open"]>>} scene
   * @param {any} library what its module's `create` returned
   * @param {Clock} clock
   */
  constructor(scene, library, clock) {
    this.#scene = scene;
    this.#library = library;
    this.#clock = clock;
  }

  /**
   * Makes a library on a scene's first boxes.
   *
   * @param {any} scene
   * @param {number} dimensions
   * @param {{ create(setting: object): Promise<any> }} module
   * @param {Clock} clock
   */
  static async start(scene, dimensions, module, clock) {
    const rows = scene.first;
    const library = await module.create({ dimensions, isMoving: scene.isMoving, rows });
    const trial = new Trial(scene, library, clock);
    if (library.slotOf) trial.#take(library.find(rows));
    return trial;
  }

  /** Finds the pairs of the frames that are checked; how long the longest call took, in milliseconds. */
  check() {
    const { varied } = this.#scene;
    const sum = new Fingerprint();
    let longest = 0;
    for (let frame = 0; frame < this.#scene.frames; frame++) {
      const rows = this.#scene.next();
      const start = this.#clock.start();
      const found = this.#library.find(rows);
      longest = Math.max(longest, this.#clock.since(start));
      sum.add(this.#take(found));
    }
    return { fingerprint: String(sum), pairs: Math.round(sum.pairs / this.#scene.frames), longest, varied };
  }

  /** Calls until the engine has seen enough of them. */
  warmUp() {
    const start = this.#clock.start();
    for (let call = 0; call < WARM_UP_CALLS && this.#clock.since(start) < WARM_UP; call++) {
      this.#library.find(this.#scene.next());
    }
  }

  /**
   * Times calls, each on other boxes than the last: milliseconds of each, of a batch the mean. Boxes at rest
   * are copied before a call that is timed alone, as a program has just written them.
   *
   * @param {number} repeats
   * @param {number} batch how many are timed together, where one alone is too short for the clock
   */
  time(repeats, batch = 1) {
    const times = [];
    for (let repeat = 0; repeat < repeats; repeat++) {
      const frames = Array.from({ length: batch }, () => this.#scene.next());
      if (batch === 1 && !this.#scene.isMoving) frames[0] = this.#copy(frames[0]);
      const start = this.#clock.start();
      for (const rows of frames) this.#library.find(rows);
      times.push(this.#clock.since(start) / batch);
    }
    return times;
  }

  #copy(/** @type {Float32Array} */ rows) {
    if (this.#current.length !== rows.length) this.#current = new Float32Array(rows.length);
    this.#current.set(rows);
    return this.#current;
  }

  /** All pairs there are now. */
  #take(/** @type {any} */ found) {
    if (!("begun" in found)) return found;
    const { slotOf } = this.#library;
    const key = (/** @type {Float64Array} */ ids, /** @type {number} */ i) => slotOf(ids[i]) * 2 ** 26 + slotOf(ids[i + 1]);
    for (let i = 0; i < found.ended.length; i += 2) this.#live.delete(key(found.ended, i));
    for (let i = 0; i < found.begun.length; i += 2) this.#live.add(key(found.begun, i));
    const pairs = new Uint32Array(2 * this.#live.size);
    let at = 0;
    for (const pair of this.#live) {
      pairs[at++] = Math.floor(pair / 2 ** 26);
      pairs[at++] = pair % 2 ** 26;
    }
    return pairs;
  }
}
