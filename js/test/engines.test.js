// The entries for engines, without the engines: what they refuse, and which bodies objects without boxes are. With the engines
// they run in examples.test.js.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { before, test } from "node:test";
import { init, InvalidBoxError } from "sweep-and-prune";
import { BroadPhase } from "sweep-and-prune/broad-phase";
import * as cannon from "sweep-and-prune/cannon-es";
import * as excalibur from "sweep-and-prune/excalibur";
import * as matter from "sweep-and-prune/matter-js";
import * as phaser from "sweep-and-prune/phaser";
import * as pixi from "sweep-and-prune/pixi";
import * as three from "sweep-and-prune/three";

before(() => init());

/** Calls with what no type allows. @type {any} */
const nothing = undefined;

const scene = { physics: { collisionProcessor: { getColliders: () => [], track() {}, untrack() {}, narrowphase: () => [] } } };
const refused = [
  ["matter-js", () => matter.replaceBroadPhase(nothing), "`matter` is undefined; it must be the module matter-js, with `Detector`, `Collision` and `Bounds`"],
  ["matter-js", () => matter.replaceBroadPhase(/** @type {any} */ ({ world: {} })), "`matter` is a Object; it must be the module matter-js, with `Detector`, `Collision` and `Bounds`"],
  ["cannon-es", () => cannon.replaceBroadPhase(nothing), "`world` is undefined; it must be a `World` of cannon-es, with `bodies` and `broadphase`"],
  ["cannon-es", () => cannon.replaceBroadPhase(/** @type {any} */ ([])), "`world` is a Array; it must be a `World` of cannon-es, with `bodies` and `broadphase`"],
  ["excalibur", () => excalibur.replaceBroadPhase(nothing, nothing), "`scene` is undefined; it must be a `Scene` of Excalibur, with `physics.collisionProcessor`"],
  ["excalibur", () => excalibur.replaceBroadPhase(scene, nothing), "`excalibur` is undefined; it must be the module excalibur, with `BodyComponent`, `CollisionGroup` and `Pair`"],
  ["phaser", () => phaser.replaceBroadPhase(nothing), "`scene` is undefined; it must be a `Scene` of Phaser with arcade physics, with `physics.world`"],
  ["phaser", () => phaser.replaceBroadPhase(/** @type {any} */ ({ matter: {} })), "`scene` is a Object; it must be a `Scene` of Phaser with arcade physics, with `physics.world`"],
  ["pixi", () => pixi.insertObjects(nothing, []), '`world` is undefined; it must be a `BroadPhase` of "sweep-and-prune/broad-phase"'],
  ["pixi", () => pixi.insertObjects(new BroadPhase({ dimensions: 2 }), /** @type {any} */ ([sprite(0), "a sprite"])), "`objects[1]` is a string; it must be a `Container` of Pixi"],
  ["three", () => three.insertObjects(new BroadPhase({ dimensions: 3 }), /** @type {any} */ ({})), "`objects` is a Object; it must be an array, each of which is an `Object3D` of three.js"],
  ["three", () => three.moveObjects(nothing), '`world` is undefined; it must be a `BroadPhase` of "sweep-and-prune/broad-phase"'],
  ["three", () => three.pick(new BroadPhase({ dimensions: 3 }), nothing), "`raycaster` is undefined; it must be a `Raycaster` of three.js"],
];

for (const [entry, call, message] of /** @type {[string, () => unknown, string][]} */ (refused)) {
  test(`${entry} refuses what is not of the engine: ${message}`, () => assert.throws(call, new TypeError(message)));
}

test("the world must have the dimensions of the objects", () => {
  const world = /** @type {any} */ (new BroadPhase({ dimensions: 3 }));
  assert.throws(() => pixi.moveObjects(world), new RangeError("`world` has boxes of 3 dimensions; it must have 2"));
});

test("before init() they say what to import", () => {
  const code = `
    import { replaceBroadPhase } from "sweep-and-prune/cannon-es";
    try { replaceBroadPhase({ bodies: [], broadphase: { collisionPairs() {}, needBroadphaseCollision() {} } }); } catch (error) { console.log(error.message); }`;
  const printed = execFileSync(process.execPath, ["--input-type=module", "--eval", code], { cwd: new URL("..", import.meta.url), encoding: "utf8" });
  assert.match(printed, /^"sweep-and-prune" is not initialized: import `init` from "sweep-and-prune"/);
});

/**
 * What the entry for Pixi sees of a sprite. Without a place it is invisible.
 *
 * @param {number} [x]
 */
function sprite(x) {
  const object = {
    /** @type {number | undefined} */
    x,
    getBounds: () => (object.x === undefined ? { minX: 0, minY: 0, maxX: 0, maxY: 0 } : { minX: object.x, minY: 0, maxX: object.x + 2, maxY: 1 }),
  };
  return object;
}

for (const views of [false, true]) {
  test(`an object without a box pairs with nothing until it has one, and bodies that were disabled stay so; views: ${views}`, () => {
    /** @type {BroadPhase<2, unknown>} */
    const world = new BroadPhase({ dimensions: 2, views });
    const [a, b, c] = [sprite(1), sprite(), sprite(2)];
    const ids = pixi.insertObjects(world, [a, b, sprite(), c]).slice();
    const [trigger, off] = [world.insert(0, 0, 4, 1), world.insert({ x: 0, y: 0, width: 4, height: 1 }, { data: sprite(1) })];
    world.setEnabled(off, false);
    const pairs = () => {
      pixi.moveObjects(world);
      world.update();
      return [...world.pairs()].map((id) => [...ids, trigger, off].indexOf(id)).join();
    };
    assert.equal(pairs(), "0,3,0,4,3,4");
    assert.deepEqual(world.dataOf(world.overlapping([-1, -1, 0, 0])), [undefined], "the origin, where what is invisible is for Pixi");
    b.x = 3;
    assert.equal(pairs(), "0,1,0,3,0,4,1,3,1,4,3,4");
    a.x = c.x = undefined;
    assert.equal(pairs(), "1,4");
    world.remove(Number(ids[0])); // while its object has no box
    c.x = 9;
    assert.equal(pairs(), "1,4");
    assert.equal(world.isEnabled(off), false);
  });
}

test("objects without a box: bodies that are gone, those that the user disabled, and what is in something invisible", () => {
  /** @type {BroadPhase<2, unknown>} */
  const world = new BroadPhase({ dimensions: 2 });
  pixi.insertObjects(world, [sprite()]);
  world.clear();
  assert.equal(world.isEnabled(Number(pixi.insertObjects(world, [sprite()])[0])), false, "the one before is gone");

  const corpse = sprite(1);
  const id = Number(pixi.insertObjects(world, [corpse])[0]);
  world.setEnabled(id, false);
  for (const x of [undefined, 1]) {
    corpse.x = x;
    pixi.moveObjects(world);
    assert.equal(world.isEnabled(id), false);
  }

  const level = { visible: true, parent: { visible: true, parent: null } };
  const coin = Number(pixi.insertObjects(world, [{ ...sprite(1), parent: level }])[0]);
  for (const visible of [true, false, true]) {
    level.parent.visible = visible;
    pixi.moveObjects(world);
    assert.equal(world.isEnabled(coin), visible);
  }

  const shot = { ...sprite(1), destroyed: false };
  const bullet = Number(pixi.insertObjects(world, [shot])[0]);
  Object.assign(shot, {
    destroyed: true,
    getBounds() {
      throw new TypeError("as Pixi's own does");
    },
  });
  pixi.moveObjects(world);
  assert.equal(world.isEnabled(bullet), false);
});

test("a box with a NaN is refused, and then nothing has changed", () => {
  const world = new BroadPhase({ dimensions: 2 });
  const [a, b] = [sprite(0), sprite(1)];
  const ids = pixi.insertObjects(world, [a, b]);
  a.x = 5;
  b.x = NaN;
  assert.throws(() => pixi.moveObjects(world), (error) => error instanceof InvalidBoxError && error.index === 1);
  assert.deepEqual(world.box(Number(ids[0])), [0, 0, 2, 1]);
});
