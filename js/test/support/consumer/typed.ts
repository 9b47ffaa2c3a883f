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
console.log(started, pairs, id, begun, player, InvalidBoxError);
