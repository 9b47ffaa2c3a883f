import { BroadPhase, init, slotOf } from "sweep-and-prune/broad-phase";

// All boxes are given in each frame, as they come: the world sees which differ, faster than a loop here would.
export async function create({ dimensions, rows: first }) {
  await init();
  const world = new BroadPhase({ dimensions, views: true });
  const ids = world.insertMany(first).slice(); // a copy of the view, which the next call overwrites
  return {
    find(rows) {
      world.setMany(ids, rows);
      return world.update();
    },
    slotOf,
  };
}
