import { randomFrom } from "../random.ts";

/** The width of the world; it is 1 high and 1 deep. */
export const WIDTH = 4 / 3;

/** How many boxes a box overlaps on average: one of five then overlaps another. */
const OVERLAPS = 0.223;

/** A step moves a box by at most this part of its size. */
const STEP = 0.1;

/** The size of a body in `boxes.wgsl`: three rows of three numbers, each followed by one that is not used. */
const ROW = 4;
export const BODY_BYTES = 4 * 3 * ROW;

/** Bodies at random places. The more there are, the smaller they are. */
export function bodiesOf(count: number, dimensions: 2 | 3): Float32Array<ArrayBuffer> {
  const random = randomFrom(1);
  const half = 0.25 * ((OVERLAPS * WIDTH) / count) ** (1 / dimensions);
  const bodies = new Float32Array((BODY_BYTES / 4) * count);
  for (let at = 0; at < bodies.length; at += BODY_BYTES / 4) {
    for (let axis = 0; axis < dimensions; axis++) {
      bodies[at + axis] = random() * (axis === 0 ? WIDTH : 1);
      bodies[at + ROW + axis] = half * (0.5 + random());
      bodies[at + 2 * ROW + axis] = 2 * STEP * half * (2 * random() - 1);
    }
  }
  return bodies;
}
