// The project's scenes, compiled to WebAssembly: the same boxes, bit for bit, as in Rust.

/**
 * A scene or motion: see scenes/src/scene.rs and scenes/src/motion.rs.
 *
 * @typedef {{ name: string, task: "find" | "track", dimensions: number[], description: string }} Listed
 */

export class Scenes {
  #exports;

  /** @param {WebAssembly.Instance} instance of the crate in ../scenes */
  constructor(instance) {
    this.#exports = /** @type {any} */ (instance.exports);
  }

  /** @param {WebAssembly.Module | BufferSource} wasm */
  static async start(wasm) {
    const module = wasm instanceof WebAssembly.Module ? wasm : await WebAssembly.compile(wasm);
    return new Scenes(await WebAssembly.instantiate(module));
  }

  /** All there are. @returns {Listed[]} */
  table() {
    const length = this.#exports.table();
    return JSON.parse(new TextDecoder().decode(this.#bytes(this.#exports.text(), length)));
  }

  /**
   * The boxes of a scene, as rows: the minimum corner and then the maximum corner.
   *
   * @param {string} name
   * @param {number} dimensions
   * @param {number} boxes
   */
  open(name, dimensions, boxes) {
    const bytes = new TextEncoder().encode(name);
    this.#exports.reserve_text(bytes.length);
    this.#bytes(this.#exports.text(), bytes.length).set(bytes);
    const kind = this.#exports.open(dimensions, boxes);
    if (kind === 0) throw new Error(`there is no scene '${name}' in ${dimensions} dimensions`);
    const length = 2 * dimensions * boxes;
    const rows = (/** @type {number} */ turn) => {
      const at = this.#exports.rows(turn);
      return new Float32Array(this.#exports.memory.buffer, at, length).slice();
    };
    return kind === 2 ? new InMotion(this.#exports, rows) : new AtRest(rows, this.#exports.turns());
  }

  #bytes(/** @type {number} */ at, /** @type {number} */ length) {
    return new Uint8Array(this.#exports.memory.buffer, at, length);
  }
}

/** Scenes of a kind, one after another, or many boxes at rest in two orders by turns. */
class AtRest {
  isMoving = false;
  /** How many are checked: one of those that differ only in the order of their boxes. */
  frames;
  /** How many are timed in a round, each once; 0 if any number of calls may be. */
  varied;
  #rows;
  #turns;
  #turn = 0;
  /** @type {Float32Array[]} */
  #seen = [];

  constructor(/** @type {(turn: number) => Float32Array} */ rows, /** @type {number} */ turns) {
    this.#rows = rows;
    this.#turns = turns;
    this.varied = turns > 2 ? turns : 0;
    this.frames = turns > 2 ? 4 : 1;
  }

  /** The first call's boxes. */
  get first() {
    return this.#at(0);
  }

  /** The boxes of the next call. */
  next() {
    return this.#at(this.#turn++ % this.#turns);
  }

  #at(/** @type {number} */ turn) {
    return (this.#seen[turn] ??= this.#rows(turn));
  }
}

/** Boxes in motion, frame after frame. */
class InMotion {
  isMoving = true;
  varied = 0;
  /** How many frames are checked. */
  frames = 4;
  #exports;
  #rows;

  constructor(/** @type {any} */ exports, /** @type {(turn: number) => Float32Array} */ rows) {
    this.#exports = exports;
    this.#rows = rows;
    this.first = rows(0);
  }

  next() {
    this.#exports.advance();
    return this.#rows(0);
  }
}
