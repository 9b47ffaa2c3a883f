import RBush from "rbush";
import { BroadPhase, slotOf } from "sweep-and-prune/broad-phase";
import { copyBox, createItems, indexOf, load, overlap, random } from "./rows.js";

/** @typedef {import("./measure.js").Form} Form */

/** 20,000 shapes, of which 100 are dragged: what does the frame select that follows them, and what is under the pointer? */
export function editor() {
  const [COUNT, DRAGGED, SIDE] = [20_000, 100, 4000];

  function createShapes() {
    const next = random();
    const boxes = new Float64Array(4 * COUNT);
    for (let at = 0; at < COUNT; at++) {
      const [x, y] = [next() * SIDE, next() * SIDE];
      boxes.set([x, y, x + 5 + 25 * next(), y + 5 + 25 * next()], 4 * at);
    }
    /** Moves the first shapes; returns the frame and the pointer. */
    const drag = (/** @type {number} */ step) => {
      const [dx, dy] = [3 * Math.cos(step / 20), 3 * Math.sin(step / 20)];
      for (let at = 0; at < 4 * DRAGGED; at++) boxes[at] += at % 2 ? dy : dx;
      const [x, y] = [(step * 37) % (SIDE - 200), (step * 91) % (SIDE - 200)];
      return [x, y, x + 200, y + 200];
    };
    return { boxes, drag };
  }

  /** @type {Record<string, () => Form>} */
  const forms = {
    BroadPhase: () => {
      const { boxes, drag } = createShapes();
      const world = new BroadPhase({ dimensions: 2, precision: "double" });
      const dragged = world.insertMany(boxes).slice(0, DRAGGED);
      world.update();
      /** @type {ArrayLike<number>[]} */
      let answers = [];
      return {
        frame: (step) => {
          const [x, y, right, bottom] = drag(step);
          world.setMany(dragged, boxes.subarray(0, 4 * DRAGGED));
          answers = [world.overlapping([x, y, right, bottom]), world.containing([x, y])];
        },
        found: () => answers.flatMap((ids) => Array.from(ids, slotOf).sort((a, b) => a - b)),
      };
    },
    rbush: () => {
      const { boxes, drag } = createShapes();
      const [tree, items] = [new RBush(), createItems(COUNT)];
      load(tree, items, boxes);
      /** @type {Item[][]} */
      let answers = [];
      return {
        frame: (step) => {
          const [x, y, right, bottom] = drag(step);
          for (let at = 0; at < DRAGGED; at++) {
            tree.remove(items[at]);
            copyBox(items[at], boxes, at);
            tree.insert(items[at]);
          }
          answers = [tree.search({ minX: x, minY: y, maxX: right, maxY: bottom }), tree.search({ minX: x, minY: y, maxX: x, maxY: y })];
        },
        found: () => answers.flatMap((found) => found.map(({ at }) => at).sort((a, b) => a - b)),
      };
    },
    "flatbush, built again": () => {
      const { boxes, drag } = createShapes();
      /** @type {number[][]} */
      let answers = [];
      return {
        frame: (step) => {
          const [x, y, right, bottom] = drag(step);
          const index = indexOf(boxes);
          answers = [index.search(x, y, right, bottom), index.search(x, y, x, y)];
        },
        found: () => answers.flatMap((found) => found.sort((a, b) => a - b)),
      };
    },
    "a loop": () => {
      const { boxes, drag } = createShapes();
      /** @type {number[][]} */
      let answers = [];
      return {
        frame: (step) => {
          const [x, y, right, bottom] = drag(step);
          answers = [[x, y, right, bottom], [x, y, x, y]].map((query) => {
            const found = [];
            for (let at = 0; at < COUNT; at++) if (overlap(boxes, at, query, 0)) found.push(at);
            return found;
          });
        },
        found: () => answers.flat(),
      };
    },
  };
  return forms;
}
