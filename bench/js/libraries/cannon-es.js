import { Body, SAPBroadphase, World } from "cannon-es";
import { PairList } from "./pair-list.js";

// The broad phase of its world, given bodies whose boxes are written directly.
export async function create({ rows: first }) {
  const pairs = new PairList();
  const world = new World();
  const broadphase = new SAPBroadphase(world);
  world.broadphase = broadphase;
  broadphase.useBoundingBoxes = true;
  const bodies = Array.from({ length: first.length / 6 }, () => new Body({ mass: 1 }));
  bodies.forEach((body, index) => {
    body.index = index;
    broadphase.axisList.push(body);
  });
  const [a, b] = [[], []];
  return {
    find(rows) {
      for (let i = 0, at = 0; i < bodies.length; i++, at += 6) {
        const body = bodies[i];
        const { lowerBound, upperBound } = body.aabb;
        lowerBound.set(rows[at], rows[at + 1], rows[at + 2]);
        upperBound.set(rows[at + 3], rows[at + 4], rows[at + 5]);
        lowerBound.vadd(upperBound, body.position);
        body.position.scale(0.5, body.position);
        body.boundingRadius = body.position.distanceTo(upperBound) * (1 + 1e-12);
        body.aabbNeedsUpdate = false;
      }
      a.length = b.length = 0;
      broadphase.autoDetectAxis();
      broadphase.dirty = true;
      broadphase.collisionPairs(world, a, b);
      pairs.clear();
      for (let i = 0; i < a.length; i++) pairs.push(a[i].index, b[i].index);
      return pairs.pairs;
    },
  };
}
