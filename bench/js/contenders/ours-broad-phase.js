import { BroadPhase, init, slotOf } from "sweep-and-prune/broad-phase";

export async function create({ dimensions, rows }) {
  await init();
  const world = new BroadPhase({ dimensions });
  const ids = world.insertMany(rows).slice();
  return {
    find(rows) {
      world.setMany(ids, rows);
      return world.update();
    },
    slotOf,
  };
}
