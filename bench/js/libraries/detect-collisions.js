import { System } from "detect-collisions";
import { PairList } from "./pair-list.js";
import { isAtRest } from "./rows.js";

const OPTIONS = { isTrigger: true };

export async function create({ isMoving, rows: first }) {
  const pairs = new PairList();
  let system = new System();
  /** @type {any[]} */
  let bodies = [];

  function fill(rows) {
    system = new System();
    bodies = [];
    for (let at = 0; at < rows.length; at += 4) {
      const [width, height] = [rows[at + 2] - rows[at], rows[at + 3] - rows[at + 1]];
      const body = system.createBox({ x: rows[at], y: rows[at + 1] }, width, height, OPTIONS);
      body.index = bodies.length;
      bodies.push(body);
    }
  }

  // Its tree's own search, of which checkAll takes the boxes that it gives to its exact test.
  function search() {
    pairs.clear();
    for (const body of bodies) {
      for (const other of system.search(body)) if (other.index > body.index) pairs.push(body.index, other.index);
    }
    return pairs.pairs;
  }

  if (!isMoving) {
    return {
      find(rows) {
        fill(rows);
        return search();
      },
    };
  }
  const before = first.slice();
  fill(first);
  return {
    find(rows) {
      for (let i = 0, at = 0; i < bodies.length; i++, at += 4) {
        if (!isAtRest(rows, before, at, 4)) bodies[i].setPosition(rows[at], rows[at + 1]);
      }
      before.set(rows);
      return search();
    },
  };
}
