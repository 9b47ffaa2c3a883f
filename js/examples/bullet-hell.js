// A bullet hell: 3,000 bullets against 500 enemies, in typed arrays and with one call a frame to move them all.
import { BroadPhase, init, slotOf } from "sweep-and-prune/broad-phase";

await init();

const [BULLETS, ENEMIES, WIDTH, HEIGHT] = [3000, 500, 1280, 720];
const COUNT = BULLETS + ENEMIES; // bullets first
const [x, y, dx, dy] = Array.from({ length: 4 }, () => new Float32Array(COUNT));
let seed = 1;
const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;

/** Puts a bullet or an enemy anywhere, with a speed of its own. */
function spawn(i) {
  [x[i], y[i]] = [random() * WIDTH, random() * HEIGHT];
  const [speed, angle] = [i < BULLETS ? 4 : 0.5, random() * 2 * Math.PI];
  [dx[i], dy[i]] = [speed * Math.cos(angle), speed * Math.sin(angle)];
}

/** All boxes, written again in each frame: minX, minY, maxX, maxY. */
const boxes = new Float32Array(4 * COUNT);
function writeBoxes() {
  for (let i = 0; i < COUNT; i++) {
    const radius = i < BULLETS ? 2 : 12;
    boxes[4 * i] = x[i] - radius;
    boxes[4 * i + 1] = y[i] - radius;
    boxes[4 * i + 2] = x[i] + radius;
    boxes[4 * i + 3] = y[i] + radius;
  }
}

for (let i = 0; i < COUNT; i++) spawn(i);
writeBoxes();

const world = new BroadPhase({ dimensions: 2 });
// Bullets meet enemies only: pairs of bullets are not searched for.
const filters = Array.from({ length: COUNT }, (_, i) => (i < BULLETS ? { category: 1, mask: 2 } : { category: 2, mask: 1 }));
const ids = world.insertMany(boxes, filters); // in a new world the slots are 0, 1, 2, ...: those of the arrays

let hits = 0;
for (let frame = 0; frame < 60; frame++) {
  for (let i = 0; i < COUNT; i++) {
    x[i] = (x[i] + dx[i] + WIDTH) % WIDTH;
    y[i] = (y[i] + dy[i] + HEIGHT) % HEIGHT;
  }
  writeBoxes();
  world.setMany(ids, boxes); // all of them: it finds those that moved
  const { begun } = world.update();
  for (let at = 0; at < begun.length; at += 2) {
    // The smaller slot is first: the bullet.
    spawn(slotOf(begun[at])); // a new one, elsewhere: its body is moved in the next frame
    hits++;
  }
}

// The pairs of the last frame, by brute force.
let expected = 0;
for (let b = 0; b < BULLETS; b++) {
  for (let e = BULLETS; e < COUNT; e++) {
    if (boxes[4 * b] <= boxes[4 * e + 2] && boxes[4 * e] <= boxes[4 * b + 2] && boxes[4 * b + 1] <= boxes[4 * e + 3] && boxes[4 * e + 1] <= boxes[4 * b + 3]) expected++;
  }
}
console.log(hits > 1000, world.pairs().length / 2 === expected); // true true
