// A game in Pixi: which sprites began to overlap in this frame. In a browser.
import { Graphics } from "pixi.js";
import { BroadPhase, init } from "sweep-and-prune/broad-phase";

await init();

const hero = new Graphics().rect(0, 0, 20, 20).fill("tomato");
const coins = [60, 120, 180].map((x) => {
  const coin = new Graphics().circle(0, 0, 8).fill("gold");
  coin.position.set(x, 10);
  return coin;
});
const sprites = [hero, ...coins];

const world = new BroadPhase({ dimensions: 2 });
const filters = sprites.map((sprite) => (sprite === hero ? { category: 1, mask: 2 } : { category: 2, mask: 1 })); // coins do not pair with coins
const ids = world.insertMany(sprites.map((sprite) => sprite.getBounds()), filters, sprites);

let collected = 0;
for (let frame = 0; frame < 100; frame++) {
  hero.x += 2; // in a game, app.ticker.add(() => ..)
  const { minX, minY, maxX, maxY } = hero.getBounds();
  world.set(ids[0], minX, minY, maxX, maxY);
  const { begun } = world.update();
  // Two ids a pair: the hero, and the coin that it touches.
  for (const coin of [...begun].filter((id) => id !== ids[0])) {
    world.data(coin).visible = false;
    world.remove(coin);
    collected++;
  }
}
console.log(`${collected} coins, ${world.size} left in the world`); // 3 coins, 1 left in the world
