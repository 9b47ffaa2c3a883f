// matter with another broad phase: one line to switch, and bit for bit the same motion.
import Matter from "matter-js";
import { init } from "sweep-and-prune";
import { replaceBroadPhase } from "sweep-and-prune/matter-js";

await init();

/** Where the bodies are after two seconds of a pile that falls, and how many contacts there were. */
function fall() {
  const engine = Matter.Engine.create();
  const ground = Matter.Bodies.rectangle(400, 820, 1600, 40, { isStatic: true });
  const bodies = Array.from({ length: 300 }, (_, i) => {
    const [x, y] = [(i % 20) * 35 + (i % 3), 700 - Math.floor(i / 20) * 35];
    if (i % 10) return i % 2 ? Matter.Bodies.circle(x, y, 12) : Matter.Bodies.rectangle(x, y, 22, 26);
    const cross = [Matter.Bodies.rectangle(x, y, 28, 8), Matter.Bodies.rectangle(x, y, 8, 28)];
    return Matter.Body.create({ parts: cross });
  });
  Matter.Composite.add(engine.world, [ground, ...bodies]);
  let contacts = 0;
  for (let step = 0; step < 120; step++) {
    Matter.Engine.update(engine, 1000 / 60);
    contacts += engine.pairs.collisionActive.length;
  }
  return [contacts, ...bodies.flatMap(({ position, angle }) => [position.x, position.y, angle])];
}

const own = fall();
replaceBroadPhase(Matter); // the line to switch
const other = fall();
console.log(own[0] > 10_000, own.join() === other.join()); // true true
