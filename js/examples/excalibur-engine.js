// Excalibur with another broad phase: one line to switch, and the same contacts. In a browser.
import * as ex from "excalibur";
import { init } from "sweep-and-prune/broad-phase";
import { replaceBroadPhase } from "sweep-and-prune/excalibur";

await init();

/** The contacts of each of 60 steps, in which 300 actors bounce between the walls of a level. */
async function bounce(isReplaced) {
  const engine = new ex.Engine({ width: 400, height: 300, suppressPlayButton: true, suppressConsoleBootMessage: true });
  await engine.start();
  engine.clock.stop(); // steps of a fixed time
  const scene = engine.currentScene;
  if (isReplaced) replaceBroadPhase(scene, ex); // the line to switch
  for (let i = 0; i < 40; i++) scene.add(new ex.Actor({ x: 20 * i, y: 10, width: 20, height: 20, collisionType: ex.CollisionType.Fixed }));
  for (let i = 0; i < 300; i++) {
    const [x, y] = [(i * 37) % 400, 40 + ((i * 53) % 240)];
    const velocity = ex.vec((i * 29) % 200 - 100, (i * 31) % 200 - 100);
    scene.add(new ex.Actor({ x, y, radius: 4 + (i % 5), vel: velocity, collisionType: ex.CollisionType.Passive }));
  }
  const steps = [];
  const processor = scene.physics.collisionProcessor;
  const narrowphase = processor.narrowphase.bind(processor);
  processor.narrowphase = (pairs, stats) => {
    const contacts = narrowphase(pairs, stats);
    steps.push(contacts.map(({ colliderA, colliderB }) => [colliderA, colliderB].map(({ owner }) => scene.actors.indexOf(owner)).sort().join("-")).sort().join());
    return contacts;
  };
  for (let step = 0; step < 60; step++) scene.world.update(ex.SystemType.Update, 1000 / 60);
  return steps;
}

const own = await bounce(false);
const other = await bounce(true);
console.log(own.length, own[0].length > 100, own.join() === other.join()); // 60 true true
