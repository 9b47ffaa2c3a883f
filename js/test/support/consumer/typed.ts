// What a user's compiler sees.
import { findPairs, init, InvalidBoxError, type Started } from "sweep-and-prune";
import { Player, Runner } from "sweep-and-prune/algorithms";
import { BroadPhase, type Changes, type ProxyId } from "sweep-and-prune/broad-phase";

const started: Started = await init({ simd: true });
const pairs: Uint32Array = findPairs([0, 1], { dimensions: 1 });
using world = new BroadPhase({ dimensions: 2, precision: "double" });
const id: ProxyId = world.insert(0, 0, 1, 1);
const { begun }: Changes = world.update();
const runner = new Runner({ dimensions: 1, method: "endpoint sweep" });
const player = new Player(runner);
// @ts-expect-error there are no four dimensions
findPairs([], { dimensions: 4 });
const three: Uint32Array = findPairs([{ min: { x: 0, y: 0, z: 0 }, max: { x: 1, y: 1, z: 1 } }]);
const items = [{ minX: 0, minY: 0, maxX: 1, maxY: 1, name: "a" }];
const rbush: Uint32Array = findPairs(items);
// @ts-expect-error numbers do not say how many dimensions they have
findPairs([0, 1]);
console.log(started, three, rbush, pairs, id, begun, player, InvalidBoxError);
