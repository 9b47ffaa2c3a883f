import RBush from "rbush";
import { PairFinder } from "sweep-and-prune";
import { BroadPhase } from "sweep-and-prune/broad-phase";
import { random } from "../../../js/test/support/boxes.js";
import { keysOf, keysOfWorld } from "./keys.js";
import { copyBox, createItems, indexOf, load, overlap } from "./rows.js";

/** @typedef {import("./measure.js").Form} Form */

/** 3,000 bullets and 500 enemies, which move: which bullet hits which enemy? */
export function bulletHell() {
  const [BULLETS, ENEMIES] = [3000, 500];
  const COUNT = BULLETS + ENEMIES;

  /** Bodies that move, bullets first, and their boxes. */
  function createBodies() {
    const next = random(1);
    const place = Float32Array.from({ length: 2 * COUNT }, (_, at) => next() * (at % 2 ? 720 : 1280));
    const speed = Float32Array.from({ length: 2 * COUNT }, (_, at) => (at < 2 * BULLETS ? 8 : 1) * (next() - 0.5));
    const boxes = new Float32Array(4 * COUNT);
    const move = () => {
      for (let at = 0; at < 2 * COUNT; at++) {
        place[at] += speed[at];
        if (place[at] < 0 || place[at] > (at % 2 ? 720 : 1280)) speed[at] = -speed[at];
        const radius = at < 2 * BULLETS ? 2 : 12;
        const row = 4 * (at >> 1) + (at & 1);
        boxes[row] = place[at] - radius;
        boxes[row + 2] = place[at] + radius;
      }
    };
    move();
    return { boxes, move };
  }

  /** A form that finds pairs in the rows of all bodies. @type {(prepare: (boxes: Float32Array) => () => ArrayLike<number>) => Form} */
  const form = (prepare) => {
    const { boxes, move } = createBodies();
    const find = prepare(boxes);
    /** @type {ArrayLike<number>} */
    let pairs = [];
    return { frame: () => (move(), (pairs = find())), found: () => keysOf(pairs) };
  };

  /** @type {Record<string, () => Form>} */
  const forms = {
    "BroadPhase, which reports events": () => {
      const { boxes, move } = createBodies();
      const world = new BroadPhase({ dimensions: 2 });
      const filters = Array.from({ length: COUNT }, (_, at) => (at < BULLETS ? { category: 1, mask: 2 } : { category: 2, mask: 1 }));
      const ids = world.insertMany(boxes, filters);
      return {
        frame: () => (move(), world.setMany(ids, boxes), world.update()),
        found: () => keysOfWorld(world, BULLETS),
      };
    },
    PairFinder: () => {
      const finder = new PairFinder({ dimensions: 2 });
      return form((boxes) => {
        const [bullets, enemies] = [boxes.subarray(0, 4 * BULLETS), boxes.subarray(4 * BULLETS)];
        return () => finder.findBetween(bullets, enemies);
      });
    },
    rbush: () =>
      form((boxes) => {
        const [tree, items, bullet] = [new RBush(), createItems(ENEMIES), createItems(1)[0]];
        return () => {
          load(tree, items, boxes, BULLETS);
          const pairs = [];
          for (let at = 0; at < BULLETS; at++) {
            copyBox(bullet, boxes, at);
            for (const enemy of tree.search(bullet)) pairs.push(at, enemy.at);
          }
          return pairs;
        };
      }),
    flatbush: () =>
      form((boxes) => () => {
        const index = indexOf(boxes, BULLETS);
        const pairs = [];
        for (let at = 0; at < BULLETS; at++) {
          for (const enemy of index.search(boxes[4 * at], boxes[4 * at + 1], boxes[4 * at + 2], boxes[4 * at + 3])) pairs.push(at, enemy);
        }
        return pairs;
      }),
    "two loops": () =>
      form((boxes) => () => {
        const pairs = [];
        for (let a = 0; a < BULLETS; a++) for (let b = BULLETS; b < COUNT; b++) if (overlap(boxes, a, boxes, b)) pairs.push(a, b - BULLETS);
        return pairs;
      }),
  };
  return forms;
}
