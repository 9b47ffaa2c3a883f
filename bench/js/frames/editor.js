import RBush from "rbush";
import { BroadPhase, slotOf } from "sweep-and-prune/broad-phase";
import { random } from "../../../js/test/support/boxes.js";
import { copyBox, createItems, indexOf, load, overlap } from "./rows.js";

/** @typedef {import("./measure.js").Form} Form */

/** 20,000 shapes, of which 100 are dragged: what does a marquee touch, and what is under the pointer? */
export function editor() {
  const [COUNT, DRAGGED, SIDE] = [20_000, 100, 4000];

  function createShapes() {
    const next = random(1);
    const boxes = new Float64Array(4 * COUNT);
    for (let at = 0; at < COUNT; at++) {
      const [x, y] = [next() * SIDE, next() * SIDE];
      boxes.set([x, y, x + 5 + 25 * next(), y + 5 + 25 * next()], 4 * at);
    }
    /** Moves the first shapes; returns the marquee, whose first corner is the pointer. */
    const drag = (/** @type {number} */ step) => {
      const [dx, dy] = [3 * Math.cos(step / 20), 3 * Math.sin(step / 20)];
      for (let at = 0; at < 4 * DRAGGED; at++) boxes[at] += at % 2 ? dy : dx;
      const [x, y] = [(step * 37) % (SIDE - 200), (step * 91) % (SIDE - 200)];
      return [x, y, x + 200, y + 200];
    };
    return { boxes, drag };
  }

  /**
   * A form that asks what a marquee touches and what is under the pointer. It finds positions of shapes, or what `positionOf` turns into
   * them, outside of the time that is measured.
   *
   * @type {(prepare: (boxes: Float64Array) => (query: number[]) => readonly ArrayLike<any>[], positionOf?: (found: any) => number) => Form}
   */
  const form = (prepare, positionOf = (found) => found) => {
    const { boxes, drag } = createShapes();
    const ask = prepare(boxes);
    /** @type {readonly ArrayLike<any>[]} */
    let answers = [];
    return {
      frame: (step) => void (answers = ask(drag(step))),
      found: () => answers.flatMap((all) => Array.from(all, positionOf).sort((a, b) => a - b)),
    };
  };

  /** @type {Record<string, () => Form>} */
  const forms = {
    BroadPhase: () =>
      form((boxes) => {
        const world = new BroadPhase({ dimensions: 2, precision: "double" });
        const dragged = world.insertMany(boxes).slice(0, DRAGGED);
        world.update();
        return ([x, y, right, bottom]) => {
          world.setMany(dragged, boxes.subarray(0, 4 * DRAGGED));
          return [world.overlapping([x, y, right, bottom]), world.containing([x, y])];
        };
      }, slotOf),
    rbush: () =>
      form(
        (boxes) => {
          const [tree, items] = [new RBush(), createItems(COUNT)];
          load(tree, items, boxes);
          return ([x, y, right, bottom]) => {
            for (let at = 0; at < DRAGGED; at++) {
              tree.remove(items[at]);
              copyBox(items[at], boxes, at);
              tree.insert(items[at]);
            }
            return [tree.search({ minX: x, minY: y, maxX: right, maxY: bottom }), tree.search({ minX: x, minY: y, maxX: x, maxY: y })];
          };
        },
        ({ at }) => at,
      ),
    "flatbush, built again": () =>
      form((boxes) => ([x, y, right, bottom]) => {
        const index = indexOf(boxes);
        return [index.search(x, y, right, bottom), index.search(x, y, x, y)];
      }),
    "a loop": () =>
      form((boxes) => ([x, y, right, bottom]) =>
        [[x, y, right, bottom], [x, y, x, y]].map((query) => {
          const found = [];
          for (let at = 0; at < COUNT; at++) if (overlap(boxes, at, query, 0)) found.push(at);
          return found;
        }),
      ),
  };
  return forms;
}
