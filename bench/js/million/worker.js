// Moves the boxes and finds what that did to their pairs, again and again.
import { Scenes } from "/src/scenes.js";

/** How many boxes the page draws. */
const SHOWN = 2000;

addEventListener("message", async ({ data: { scene, boxes, dimensions, by } }) => {
  try {
    const scenes = await Scenes.start(await (await fetch("/scenes.wasm")).arrayBuffer());
    const moving = scenes.open(scene, Number(dimensions), Number(boxes));
    const library = by === "world" ? await world(moving.first, Number(dimensions)) : await finder(Number(dimensions));
    for (;;) {
      const began = performance.now();
      const rows = moving.next();
      const moved = performance.now();
      const pairs = library(rows);
      const found = performance.now();
      const shown = rows.slice(0, SHOWN * 2 * Number(dimensions));
      postMessage({ update: { moving: moved - began, finding: found - moved, pairs }, shown }, [shown.buffer]);
      await new Promise((resolve) => setTimeout(resolve));
    }
  } catch (error) {
    postMessage({ failed: String(error), shown: new Float32Array(0) });
  }
});

async function finder(dimensions) {
  const { init, PairFinder } = await import("/dist/index.js");
  await init();
  const finder = new PairFinder({ dimensions, views: true });
  return (rows) => finder.find(rows).length / 2;
}

async function world(first, dimensions) {
  const { init, BroadPhase } = await import("/dist/broad-phase.js");
  await init();
  const world = new BroadPhase({ dimensions, views: true });
  const ids = world.insertMany(first).slice();
  world.update();
  return (rows) => {
    world.setMany(ids, rows);
    const { begun, ended } = world.update();
    return (begun.length + ended.length) / 2;
  };
}
