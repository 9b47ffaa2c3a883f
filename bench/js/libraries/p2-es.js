import { Body, SAPBroadphase, World } from "p2-es";
import { PairList } from "./pair-list.js";
import { axisOfMostVariance } from "./rows.js";

// The broad phase of its world, given bodies whose boxes are written directly.
export async function create({ rows: first }) {
  const pairs = new PairList();
  const broadphase = new SAPBroadphase();
  const world = new World({ broadphase });
  const bodies = Array.from({ length: first.length / 4 }, () => new Body({ mass: 1 }));
  bodies.forEach((body, index) => {
    body.index = index;
    broadphase.axisList.push(body);
  });
  return {
    find(rows) {
      for (let i = 0, at = 0; i < bodies.length; i++, at += 4) {
        const { lowerBound, upperBound } = bodies[i].aabb;
        lowerBound[0] = rows[at];
        lowerBound[1] = rows[at + 1];
        upperBound[0] = rows[at + 2];
        upperBound[1] = rows[at + 3];
        bodies[i].aabbNeedsUpdate = false;
      }
      broadphase.axisIndex = axisOfMostVariance(rows, 2);
      const found = broadphase.getCollisionPairs(world);
      pairs.clear();
      for (let i = 0; i < found.length; i += 2) pairs.push(found[i].index, found[i + 1].index);
      return pairs.pairs;
    },
  };
}
