import { BroadPhase, init, slotOf } from "sweep-and-prune/broad-phase";
import { isAtRest } from "./rows.js";

// The bodies that moved are written where the world reads them; of the others nothing is said.
export async function create({ dimensions, rows: first }) {
  await init();
  const width = 2 * dimensions;
  const world = new BroadPhase({ dimensions });
  const ids = world.insertMany(first).slice();
  const before = first.slice();
  const moved = new Uint32Array(ids.length);
  return {
    find(rows) {
      let count = 0;
      for (let i = 0; i < ids.length; i++) if (!isAtRest(rows, before, i * width, width)) moved[count++] = i;
      before.set(rows);
      const into = world.buffers(count);
      for (let i = 0; i < count; i++) {
        const body = moved[i];
        into.ids[i] = ids[body];
        for (let k = 0; k < width; k++) into.boxes[i * width + k] = rows[body * width + k];
      }
      world.setMany(into.ids, into.boxes);
      return world.update();
    },
    slotOf,
  };
}
