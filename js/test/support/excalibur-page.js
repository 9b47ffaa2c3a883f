// Excalibur with another broad phase, beside brute force and Excalibur's own collision processor, which is told the same.
import * as ex from "excalibur";
import { init } from "sweep-and-prune/broad-phase";
import { replaceBroadPhase } from "sweep-and-prune/excalibur";
import { random } from "./boxes.js";

await init();

const keysOf = (pairs) => pairs.map(({ colliderA, colliderB }) => [colliderA.id.value, colliderB.id.value].sort((a, b) => a - b).join("-")).sort();
const idsOf = (colliders) => colliders.map(({ id }) => id.value).sort((a, b) => a - b);

const next = random(7);
/** A whole number below a limit. */
const below = (limit) => Math.floor(next() * limit);

const engine = new ex.Engine({ width: 400, height: 300, suppressPlayButton: true, suppressConsoleBootMessage: true });
await engine.start();
engine.clock.stop();
const scene = engine.currentScene;
for (let i = 0; i < 5; i++) scene.add(new ex.Actor({ x: 80 * i, y: 100, radius: 30 }));
scene.world.update(ex.SystemType.Update, 1000 / 60);
replaceBroadPhase(scene, ex);
const replaced = scene.physics.collisionProcessor;
const takenOver = replaced.getColliders().length;
const own = new ex.SparseHashGridCollisionProcessor(scene.physics.config.sparseHashGrid);
for (const collider of replaced.getColliders()) own.track(collider);
const differences = [];
/** Whether a type or a group of an actor has changed. */
let hasChanged = false;
let turn = 0;
const counts = { pairs: 0, found: 0, hits: 0 };
const compare = (what, a, b) => JSON.stringify(a) === JSON.stringify(b) || differences.push(`${what}: ${JSON.stringify(a)} instead of ${JSON.stringify(b)}`);
for (const name of ["track", "untrack", "update"]) {
  const call = replaced[name].bind(replaced);
  replaced[name] = (...of) => (own[name](...of), call(...of));
}
const broadphase = replaced.broadphase.bind(replaced);
replaced.broadphase = (...of) => {
  const pairs = broadphase(...of);
  // Brute force, and until then Excalibur's own pairs: it sees a changed type or group only when the actor moves. A shape that
  // was replaced is still tracked in this step, here and there.
  const [colliders] = of;
  const isCurrent = ({ colliderA, colliderB }) => colliders.includes(colliderA) && colliders.includes(colliderB);
  const all = colliders.flatMap((a, i) => colliders.slice(i + 1).map((b) => new ex.Pair(a, b)));
  compare("pairs", keysOf(pairs.filter(isCurrent)), keysOf(all.filter(({ colliderA, colliderB }) => ex.Pair.canCollide(colliderA, colliderB) && colliderA.bounds.overlaps(colliderB.bounds))));
  if (!hasChanged) compare("pairs of Excalibur", keysOf(pairs.filter(isCurrent)), keysOf(own.broadphase(...of).filter(isCurrent)));
  ask(colliders);
  counts.pairs += pairs.length;
  return pairs;
};

/** A query and a ray, beside brute force. */
function ask(colliders) {
  turn++;
  const [x, y] = [below(400), below(300)];
  const where = [ex.vec(x, y), new ex.BoundingBox(x, y, x + 1 + below(80), y + 1 + below(80))][turn % 2];
  const found = idsOf(scene.physics.query(where).filter((collider) => colliders.includes(collider)));
  // Excalibur's own grid answers with all of some cells: what it finds in vain is left out.
  const expected = idsOf(colliders.filter(({ bounds }) => (where instanceof ex.Vector ? bounds.contains(where) : bounds.left <= where.right && where.left <= bounds.right && bounds.top <= where.bottom && where.top <= bounds.bottom)));
  compare("query", found, expected);
  counts.found += found.length;
  const ray = new ex.Ray(ex.vec(x, y), ex.vec(below(21) - 10, below(21) - 10.5));
  const options = { searchAllColliders: turn % 3 === 0, collisionGroup: turn % 5 === 0 ? groups[1] : undefined, ignoreCollisionGroupAll: turn % 7 === 0, maxDistance: 20 + below(300) };
  const hits = replaced.rayCast(ray, { ...options, filter: ({ collider }) => colliders.includes(collider) });
  const all = colliders.filter(({ owner }) => {
    const { group } = owner.get(ex.BodyComponent);
    return ((options.collisionGroup ?? ex.CollisionGroup.All).category & group.category) !== 0 && !(options.ignoreCollisionGroupAll && group === ex.CollisionGroup.All);
  }).flatMap((collider) => collider.rayCast(ray, options.maxDistance) ?? []).sort((a, b) => a.distance - b.distance);
  compare("ray", hits.map(({ distance }) => distance), (options.searchAllColliders ? all : all.slice(0, 1)).map(({ distance }) => distance));
  counts.hits += hits.length;
}

const groups = [ex.CollisionGroup.All, ex.CollisionGroupManager.create("one"), ex.CollisionGroupManager.create("two")];
const types = [ex.CollisionType.Passive, ex.CollisionType.Passive, ex.CollisionType.Active, ex.CollisionType.Fixed, ex.CollisionType.PreventCollision];
const actors = [];
const actions = {
  add() {
    const actor = new ex.Actor({
      x: below(400), y: below(300), vel: ex.vec(below(200) - 100, below(200) - 100), collisionType: types[below(types.length)], collisionGroup: groups[below(3)],
      ...(below(2) ? { radius: 3 + below(20) } : { width: 5 + below(30), height: 5 + below(30) }),
    });
    if (below(6) === 0) actor.collider.useCompositeCollider([ex.Shape.Circle(10, ex.vec(-10, 0)), ex.Shape.Box(20, 6, ex.vec(0.5, 0.5), ex.vec(10, 0))]);
    actors.push(actor);
    scene.add(actor);
  },
  remove: () => actors.length > 0 && actors.splice(below(actors.length), 1)[0].kill(),
  jump: () => actors.length > 0 && (actors[below(actors.length)].pos = ex.vec(below(400), below(300))),
  type: () => actors.length > 0 && (actors[below(actors.length)].body.collisionType = types[below(types.length)]),
  group: () => actors.length > 0 && (actors[below(actors.length)].body.group = groups[below(3)]),
  shape: () => actors.length > 0 && actors[below(actors.length)].collider.useCircleCollider(2 + below(12)),
};
const calm = ["add", "add", "add", "remove", "jump", "shape"];
const names = ["add", "add", "add", "remove", "jump", "type", "group", "shape"];
const label = new ex.Actor({ x: 1, y: 1 });
scene.add(label);
label.removeComponent(ex.ColliderComponent); // which has no shape
for (let step = 0; step < 400; step++) {
  hasChanged = step >= 200;
  if (step === 100) scene.physics.config = { ...scene.physics.config }; // after which Excalibur makes another processor of its own
  const offered = hasChanged ? names : calm;
  for (let i = 0; i < 3; i++) actions[offered[below(offered.length)]]();
  scene.world.update(ex.SystemType.Update, 1000 / 60);
}
globalThis.result = { differences: differences.slice(0, 5), takenOver, ...counts, colliders: replaced.getColliders().length, ofExcalibur: own.getColliders().length };
