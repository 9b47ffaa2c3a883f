// A broad phase for cannon: a class with cannon's interface, passed to its world.
import * as CANNON from "cannon-es";
import { init, PairFinder } from "sweep-and-prune";

await init();

class SweepAndPruneBroadphase extends CANNON.Broadphase {
  #finder = new PairFinder({ dimensions: 3 });
  #boxes = new Float64Array(0);

  collisionPairs(world, first, second) {
    const { bodies } = world;
    if (this.#boxes.length < 6 * bodies.length) this.#boxes = new Float64Array(12 * bodies.length);
    bodies.forEach((body, i) => {
      if (body.aabbNeedsUpdate) body.updateAABB();
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

/** Whether a tower of boxes that falls is still above the ground after two seconds. */
function fall(broadphase) {
  const world = new CANNON.World({ gravity: new CANNON.Vec3(0, -9.82, 0), broadphase });
  world.addBody(new CANNON.Body({ mass: 0, shape: new CANNON.Box(new CANNON.Vec3(20, 1, 20)) }));
  for (let i = 0; i < 30; i++) {
    const body = new CANNON.Body({ mass: 1, shape: new CANNON.Box(new CANNON.Vec3(0.5, 0.5, 0.5)) });
    body.position.set((i % 3) * 0.9, 2 + i, (i % 5) * 0.4);
    world.addBody(body);
  }
  for (let step = 0; step < 120; step++) world.step(1 / 60);
  return world.bodies.every((body) => body.position.y > -0.1);
}

console.log("nothing has fallen through the ground:", fall(new SweepAndPruneBroadphase())); // nothing has fallen through the ground: true
console.log("with no broad phase at all:", fall({ __proto__: CANNON.Broadphase.prototype, collisionPairs() {} })); // with no broad phase at all: false
