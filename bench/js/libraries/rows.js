// What libraries need of boxes in rows: the minimum corner and then the maximum corner.

/**
 * The axis on which the centers vary most: the one to sweep along.
 *
 * @param {Float32Array} rows
 * @param {number} dimensions
 */
export function axisOfMostVariance(rows, dimensions) {
  const width = 2 * dimensions;
  let [best, most] = [0, -1];
  for (let axis = 0; axis < dimensions; axis++) {
    let [sum, squares] = [0, 0];
    for (let at = axis; at < rows.length; at += width) {
      const center = rows[at] + rows[at + dimensions];
      sum += center;
      squares += center * center;
    }
    const variance = squares - (sum * sum * width) / rows.length;
    if (variance > most) [best, most] = [axis, variance];
  }
  return best;
}

/**
 * Whether two boxes overlap: closed intervals on every axis.
 *
 * @param {Float32Array} rows
 * @param {number} dimensions
 * @param {number} a
 * @param {number} b
 */
export function overlaps(rows, dimensions, a, b) {
  const width = 2 * dimensions;
  for (let axis = 0; axis < dimensions; axis++) {
    const [atA, atB] = [a * width + axis, b * width + axis];
    if (rows[atA] > rows[atB + dimensions] || rows[atB] > rows[atA + dimensions]) return false;
  }
  return true;
}

/**
 * Whether a box is where it was.
 *
 * @param {Float32Array} rows
 * @param {Float32Array} before
 * @param {number} at the first number of its row
 * @param {number} width
 */
export function isAtRest(rows, before, at, width) {
  for (let i = at; i < at + width; i++) if (rows[i] !== before[i]) return false;
  return true;
}

/**
 * The mean width of the boxes: the length unit for libraries that have margins and tolerances.
 *
 * @param {Float32Array} rows
 * @param {number} dimensions
 */
export function meanWidth(rows, dimensions) {
  const width = 2 * dimensions;
  let sum = 0;
  for (let at = 0; at < rows.length; at += width) {
    for (let axis = 0; axis < dimensions; axis++) sum += rows[at + dimensions + axis] - rows[at + axis];
  }
  return (sum * 2) / rows.length || 1;
}

/**
 * A length that is lost when a box is rounded to its center and half sizes in single precision:
 * boxes larger by so much on each side hold all that the exact ones do.
 *
 * @param {Float32Array} rows
 */
export function rounding(rows) {
  let greatest = 0;
  for (let i = 0; i < rows.length; i++) greatest = Math.max(greatest, Math.abs(rows[i]));
  return greatest * 2 ** -21;
}
