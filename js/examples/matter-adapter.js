// A detector for matter.
import Matter from "matter-js";
import { init, PairFinder } from "sweep-and-prune";

await init();

const finder = new PairFinder({ dimensions: 2 });
let boxes = new Float64Array(0);

/** What stands in the place of `Matter.Detector.collisions`, which `Matter.Engine.update` calls. */
export function collisions(detector) {
  const { bodies, pairs } = detector;
  const count = bodies.length;
  bodies.sort((a, b) => a.bounds.min.x - b.bounds.min.x); // as matter does: its solver works in this order
  if (boxes.length < 4 * count) boxes = new Float64Array(8 * count);
  for (let i = 0; i < count; i++) {
    const { min, max } = bodies[i].bounds;
    boxes[4 * i] = min.x;
    boxes[4 * i + 1] = min.y;
    boxes[4 * i + 2] = max.x;
    boxes[4 * i + 3] = max.y;
  }
  const found = finder.find(boxes.subarray(0, 4 * count));
  const keys = new Float64Array(found.length / 2); // the pairs as numbers, to sort them
  for (let i = 0; i < keys.length; i++) keys[i] = found[2 * i] * count + found[2 * i + 1];
  keys.sort();
  const result = [];
  for (let i = 0; i < keys.length; i++) {
    const a = bodies[Math.floor(keys[i] / count)];
    const b = bodies[keys[i] % count];
    if ((a.isStatic || a.isSleeping) && (b.isStatic || b.isSleeping)) continue;
    if (!Matter.Detector.canCollide(a.collisionFilter, b.collisionFilter)) continue;
    if (a.parts.length === 1 && b.parts.length === 1) {
      const collision = Matter.Collision.collides(a, b, pairs);
      if (collision) result.push(collision);
      continue;
    }
    for (const partA of partsOf(a)) {
      for (const partB of partsOf(b)) {
        const collision = Matter.Bounds.overlaps(partA.bounds, partB.bounds) && Matter.Collision.collides(partA, partB, pairs);
        if (collision) result.push(collision);
      }
    }
  }
  return (detector.collisions = result);
}

/** The parts of a compound body, or the body. */
function partsOf(body) {
  return body.parts.length > 1 ? body.parts.slice(1) : body.parts;
}
