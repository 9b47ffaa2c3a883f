// Entries for engines, which run on the cores that others start: the pairs of a world that looks like cannon's, and of
// objects that look like Pixi's.
import { replaceBroadPhase } from "sweep-and-prune/cannon-es";
import { insertObjects } from "sweep-and-prune/pixi";

export function inEngines(BroadPhase) {
  const at = (x) => ({ aabb: { lowerBound: { x, y: 0, z: 0 }, upperBound: { x: x + 2, y: 1, z: 1 } }, updateAABB() {} });
  const cannon = { bodies: [0, 1, 9].map(at), broadphase: { collisionPairs() {}, needBroadphaseCollision: () => true } };
  replaceBroadPhase(cannon);
  const [first, second] = [[], []];
  cannon.broadphase.collisionPairs(cannon, first, second);
  const world = new BroadPhase({ dimensions: 2 });
  insertObjects(world, [0, 1, 9].map((x) => ({ getBounds: () => ({ minX: x, minY: 0, maxX: x + 2, maxY: 1 }) })));
  return [first.length, world.update().begun.length / 2];
}
