// Seeded boxes and the oracle: brute force in a few lines, too simple to be wrong.

/** @typedef {1 | 2 | 3} Dimensions */

/**
 * Mulberry32: the same numbers in [0, 1) for the same seed.
 *
 * @param {number} seed
 */
export function random(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let mixed = Math.imul(seed ^ (seed >>> 15), seed | 1);
    mixed ^= mixed + Math.imul(mixed ^ (mixed >>> 7), mixed | 61);
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 2 ** 32;
  };
}

/** Few distinct coordinates, so that boxes touch, coincide and are flat all the time. */
export const coordinates = [-Infinity, -2, -1.5, -1, -0, 0, 0.1, 1, 1.5, 2, 3, Infinity];

/**
 * Rows of valid boxes whose coordinates are among `among`.
 *
 * @param {() => number} next
 * @param {number} count
 * @param {Dimensions} dimensions
 * @param {readonly number[]} [among]
 * @returns {number[]}
 */
export function boxesAmong(next, count, dimensions, among = coordinates) {
  const pick = () => /** @type {number} */ (among[Math.floor(next() * among.length)]);
  return Array.from({ length: count }, () => {
    const [a, b] = [Array.from({ length: dimensions }, pick), Array.from({ length: dimensions }, pick)];
    const corner = (/** @type {typeof Math.min} */ of) => a.map((at, axis) => of(at, b[axis] ?? NaN));
    return [...corner(Math.min), ...corner(Math.max)];
  }).flat();
}

/**
 * Small boxes spread over a square or a cube, a few overlaps each.
 *
 * @param {() => number} next
 * @param {number} count
 * @param {Dimensions} dimensions
 */
export function boxesSpread(next, count, dimensions) {
  const rows = new Float64Array(count * 2 * dimensions);
  const side = (3 / count) ** (1 / dimensions) / 2;
  for (let i = 0; i < count; i++) {
    for (let axis = 0; axis < dimensions; axis++) {
      const at = i * 2 * dimensions + axis;
      rows[at] = next();
      rows[at + dimensions] = rows[at] + side * (0.5 + next());
    }
  }
  return rows;
}

/**
 * All overlapping pairs by brute force, sorted by (a, b).
 *
 * @param {ArrayLike<number>} rows
 * @param {Dimensions} dimensions
 * @returns {[number, number][]}
 */
export function oracle(rows, dimensions) {
  const at = (/** @type {number} */ i) => /** @type {number} */ (rows[i]);
  const count = rows.length / (2 * dimensions);
  /** @type {[number, number][]} */
  const pairs = [];
  for (let a = 0; a < count; a++) {
    for (let b = a + 1; b < count; b++) {
      const [i, j] = [a * 2 * dimensions, b * 2 * dimensions];
      let overlap = true;
      for (let axis = 0; axis < dimensions; axis++) {
        overlap &&= at(i + axis) <= at(j + axis + dimensions) && at(j + axis) <= at(i + axis + dimensions);
      }
      if (overlap) pairs.push([a, b]);
    }
  }
  return pairs;
}

/**
 * Pairs as the package gives them, sorted by (a, b).
 *
 * @param {Uint32Array} flat
 * @returns {[number, number][]}
 */
export function sorted(flat) {
  /** @type {[number, number][]} */
  const pairs = [];
  for (let i = 0; i < flat.length; i += 2) {
    pairs.push([/** @type {number} */ (flat[i]), /** @type {number} */ (flat[i + 1])]);
  }
  return pairs.sort(([a, b], [c, d]) => a - c || b - d);
}
