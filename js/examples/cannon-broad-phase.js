// cannon with another broad phase: an object that is passed to its world.
import * as CANNON from "cannon-es";
import { SweepAndPruneBroadphase } from "./cannon-adapter.js";

/** Whether a tower of boxes that falls is still above the ground after two seconds. */
function fall(broadphase) {
  const world = new CANNON.World({ gravity: new CANNON.Vec3(0, -9.82, 0), broadphase });
  const ground = new CANNON.Body({ mass: 0, shape: new CANNON.Box(new CANNON.Vec3(20, 1, 20)) });
  ground.position.set(100, 0, 0);
  world.addBody(ground);
  for (let i = 0; i < 30; i++) {
    const body = new CANNON.Body({ mass: 1, shape: new CANNON.Box(new CANNON.Vec3(0.5, 0.5, 0.5)) });
    body.position.set(100 + (i % 3) * 0.9, 2 + i, (i % 5) * 0.4);
    world.addBody(body);
  }
  for (let step = 0; step < 120; step++) world.step(1 / 60);
  return world.bodies.every((body) => body.position.y > -0.1);
}

console.log("nothing has fallen through the ground:", fall(new SweepAndPruneBroadphase())); // nothing has fallen through the ground: true
console.log("with no broad phase at all:", fall({ __proto__: CANNON.Broadphase.prototype, collisionPairs() {} })); // with no broad phase at all: false
