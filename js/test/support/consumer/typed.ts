// What a user's compiler sees.
import { findPairs, forEachPair, init, InvalidBoxError, type Started } from "sweep-and-prune";
import { BroadPhase, type Changes, type ProxyId } from "sweep-and-prune/broad-phase";
import { type CannonWorld, replaceBroadPhase as inCannon } from "sweep-and-prune/cannon-es";
import { replaceBroadPhase as inExcalibur } from "sweep-and-prune/excalibur";
import { replaceBroadPhase as inMatter } from "sweep-and-prune/matter-js";
import { replaceBroadPhase as inPhaser } from "sweep-and-prune/phaser";
import * as forPixi from "sweep-and-prune/pixi";
import * as forThree from "sweep-and-prune/three";

const started: Started = await init({ simd: true });
const pairs: Uint32Array = findPairs([0, 1], { dimensions: 1 });
using world = new BroadPhase({ dimensions: 2, precision: "double" });
const id: ProxyId = world.insert(0, 0, 1, 1);
const { begun }: Changes = world.update();
// @ts-expect-error there are no four dimensions
findPairs([], { dimensions: 4 });
const three = findPairs([{ min: { x: 0, y: 0, z: 0 }, max: { x: 1, y: 1, z: 1 } }]);
const items = [{ minX: 0, minY: 0, maxX: 1, maxY: 1, name: "a" }];
const rbush: Uint32Array = findPairs(items, { dimensions: 2 });
const named: string[] = findPairs(items).map(([a, b]) => a.name + b.name);
forEachPair(items, (a, b) => a.name !== b.name);
world.insert({ x: 0, y: 0, width: 1, height: 1 });
world.set(id, items[0]!);
const near: number[] = world.nearest({ x: 0, y: 0 }, 1, 5, (id) => id > 0).map(({ distance }) => distance);
// @ts-expect-error numbers do not say how many dimensions they have
findPairs([0, 1]);
// The entries for engines need no engine.
export const useCannon = (cannon: CannonWorld): void => inCannon(cannon);
// @ts-expect-error a BroadPhase is not a world of cannon
inCannon(world);
const sprite = { name: "a", getBounds: () => ({ minX: 0, minY: 0, maxX: 1, maxY: 1 }) };
forPixi.insertObjects(new BroadPhase({ dimensions: 2 }), [sprite]);
// @ts-expect-error three has three dimensions
forThree.moveObjects(world);
export const engines = [inExcalibur, inMatter, inPhaser];
export default [started, three, rbush, named, near, pairs, id, begun, InvalidBoxError];
