// An editor: what a dragged frame selects, what lies under the pointer, and which edges to snap to.
import { BroadPhase, init } from "sweep-and-prune/broad-phase";

await init();

const world = new BroadPhase({ dimensions: 2, precision: "double" });
const boxes = [
  [40, 20, 360, 60], // minX, minY, maxX, maxY
  [40, 80, 240, 280],
  [260, 80, 360, 280],
  [40, 300, 360, 330],
];
const ids = world.insertMany(boxes, {}, ["title", "photo", "caption", "footer"]); // in an editor, your shapes
const names = (found) => world.dataOf(found).join(", ");

console.log(names(world.overlapping([200, 70, 300, 290]))); // photo, caption
console.log(names(world.containing([100, 310]))); // footer

// A frame that selects only what is completely inside.
const [minX, minY, maxX, maxY] = [30, 70, 370, 320];
const isInside = ([left, top, right, bottom]) => minX <= left && minY <= top && right <= maxX && bottom <= maxY;
const touched = world.overlapping([minX, minY, maxX, maxY]);
console.log(names(touched), "|", names(touched.filter((id) => isInside(world.box(id))))); // photo, caption, footer | photo, caption

// Snapping: the shapes within 8 of the dragged one, and the nearest edge among their left and right edges.
const [, , caption] = ids;
const dragged = [245, 90, 345, 290];
world.set(caption, ...dragged);
const near = world.overlapping([dragged[0] - 8, dragged[1] - 8, dragged[2] + 8, dragged[3] + 8]);
const edges = near.filter((id) => id !== caption).flatMap((id) => [world.box(id)[0], world.box(id)[2]]);
const nearest = edges.sort((a, b) => Math.abs(a - dragged[0]) - Math.abs(b - dragged[0]))[0];
console.log(names(near), nearest); // photo, caption 240

// Undo: a step keeps the boxes that it changed.
const before = world.boxes(ids);
world.setMany(ids, boxes.map(([minX, minY, maxX, maxY]) => [minX + 500, minY, maxX + 500, maxY]));
world.setMany(ids, before);
console.log(names(world.overlapping({ x: 300, y: 290, width: -100, height: -220 }))); // photo, caption
world.free();
