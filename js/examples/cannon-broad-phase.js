// cannon with another broad phase: one line to switch, and the same contacts.
import * as CANNON from "cannon-es";
import { init } from "sweep-and-prune";
import { replaceBroadPhase } from "sweep-and-prune/cannon-es";

await init();

/** A tower of boxes that falls on the ground. */
function createWorld() {
  const world = new CANNON.World({ gravity: new CANNON.Vec3(0, -9.82, 0) });
  const ground = new CANNON.Body({ mass: 0, shape: new CANNON.Box(new CANNON.Vec3(20, 1, 20)) });
  ground.position.set(100, 0, 0);
  world.addBody(ground);
  for (let i = 0; i < 30; i++) {
    const body = new CANNON.Body({ mass: 1, shape: new CANNON.Box(new CANNON.Vec3(0.5, 0.5, 0.5)) });
    body.position.set(100 + (i % 3) * 0.9, 2 + i, (i % 5) * 0.4);
    world.addBody(body);
  }
  return world;
}

/** The pairs of bodies that touch in the next step, sorted: their order depends on the broad phase. */
function contactsOf(world) {
  world.step(1 / 60);
  const pairs = world.contacts.map(({ bi, bj }) => [bi.index, bj.index].sort((a, b) => a - b).join("-"));
  return [...new Set(pairs)].sort();
}

const world = createWorld();
replaceBroadPhase(world); // the line to switch
let [same, contacts] = [0, 0];
for (let step = 0; step < 120; step++) {
  // Another world in which everything is where it is in this one.
  const own = createWorld();
  own.bodies.forEach((body, i) => {
    for (const part of ["position", "quaternion", "velocity", "angularVelocity"]) body[part].copy(world.bodies[i][part]);
    body.aabbNeedsUpdate = true;
  });
  const found = contactsOf(world);
  if (contactsOf(own).join() === found.join()) same++;
  contacts += found.length;
}
console.log(same, contacts > 1_000); // 120 true
console.log("nothing has fallen through the ground:", world.bodies.every((body) => body.position.y > -0.1)); // nothing has fallen through the ground: true
