// A broad phase for cannon: a class with cannon's interface.
import * as CANNON from "cannon-es";
import { init, PairFinder } from "sweep-and-prune";

await init();

export class SweepAndPruneBroadphase extends CANNON.Broadphase {
  #finder = new PairFinder({ dimensions: 3 });
  #boxes = new Float64Array(0);

  collisionPairs(world, first, second) {
    const { bodies } = world;
    if (this.#boxes.length < 6 * bodies.length) this.#boxes = new Float64Array(12 * bodies.length);
    bodies.forEach((body, i) => {
      body.updateAABB(); // also of bodies at rest: cannon does not note that a position was set
      const { lowerBound: low, upperBound: high } = body.aabb;
      this.#boxes.set([low.x, low.y, low.z, high.x, high.y, high.z], 6 * i);
    });
    const pairs = this.#finder.find(this.#boxes.subarray(0, 6 * bodies.length));
    for (let i = 0; i < pairs.length; i += 2) {
      const [a, b] = [bodies[pairs[i]], bodies[pairs[i + 1]]];
      if (!this.needBroadphaseCollision(a, b)) continue; // cannon's filters, and bodies at rest
      first.push(a);
      second.push(b);
    }
  }
}
