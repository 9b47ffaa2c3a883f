// A game in Pixi: which sprites began to overlap in this frame. In a browser.
import { Graphics } from "pixi.js";
import { BroadPhase, init } from "sweep-and-prune/broad-phase";
import { insertObjects, moveObjects } from "sweep-and-prune/pixi";

await init();

const hero = new Graphics().rect(0, 0, 20, 20).fill("tomato");
const coins = [60, 120, 180].map((x) => {
  const coin = new Graphics().circle(0, 0, 8).fill("gold");
  coin.position.set(x, 10);
  return coin;
});

const world = new BroadPhase({ dimensions: 2 });
insertObjects(world, [hero], { category: 1, mask: 2 });
insertObjects(world, coins, { category: 2, mask: 1 }); // coins do not pair with coins

let collected = 0;
for (let frame = 0; frame < 100; frame++) {
  hero.x += 2; // in a game, app.ticker.add(() => ..)
  moveObjects(world);
  // The hero was inserted first, so it is first in each pair.
  for (const [, coin] of world.dataPairs(world.update().begun)) {
    coin.visible = false; // what is invisible pairs with nothing
    collected++;
  }
}
console.log(`${collected} coins, ${world.pairs().length} pairs left`); // 3 coins, 0 pairs left
