// Another broad phase for matter: sweep-and-prune finds the bounds that overlap, matter the bodies that touch.
import Matter from "matter-js";
import { BroadPhase, init } from "sweep-and-prune/broad-phase";

await init();

const bodies = Array.from({ length: 400 }, (_, i) => Matter.Bodies.circle((i % 20) * 19, Math.floor(i / 20) * 19, 10));
const world = new BroadPhase({ dimensions: 2, precision: "double" });
const ids = world.insertMany(bodies.map((body) => body.bounds));
const bodyOf = new Map([...ids].map((id, i) => [id, bodies[i]]));

/** The contacts now: matter's narrow phase over the pairs of sweep-and-prune. */
function contacts() {
  world.setMany(ids, bodies.map((body) => body.bounds));
  world.update();
  const pairs = world.pairs();
  const found = [];
  for (let i = 0; i < pairs.length; i += 2) {
    const contact = Matter.Collision.collides(bodyOf.get(pairs[i]), bodyOf.get(pairs[i + 1]));
    if (contact) found.push(contact);
  }
  return found;
}

// The same contacts as matter's own detector finds.
const detector = Matter.Detector.create({ bodies });
const key = ({ bodyA, bodyB }) => [bodyA.id, bodyB.id].sort((a, b) => a - b).join();
const own = Matter.Detector.collisions(detector).map(key).sort();
console.log(own.length > 500, contacts().map(key).sort().join(";") === own.join(";")); // true true

Matter.Body.translate(bodies[0], { x: -500, y: 0 });
const fewer = Matter.Detector.collisions(detector).length;
console.log(fewer < own.length, contacts().length === fewer); // true true
