// Every listing of the article finds what the library finds.

import assert from "node:assert/strict";
import { before, describe, test } from "node:test";
import { findPairs, init } from "sweep-and-prune";
import { ballsTouch } from "../src/listings/balls-touch.js";
import { endpointsOf, precedes, refresh } from "../src/listings/endpoints.js";
import { axisOfFewestOverlaps } from "../src/listings/fewest-overlaps.js";
import { insertionSort } from "../src/listings/insertion-sort.js";
import { key } from "../src/listings/key.js";
import { oneToN } from "../src/listings/one-to-n.js";
import { overlaps } from "../src/listings/overlaps.js";
import { globalPairwise } from "../src/listings/pairwise.js";
import { quicksort } from "../src/listings/quicksort.js";
import { sortedPairwise } from "../src/listings/sorted-pairwise.js";
import * as swapAllAxes from "../src/listings/swap-all-axes.js";
import * as swapDriven from "../src/listings/swap-driven.js";
import { sweepAllAxes } from "../src/listings/sweep-all-axes.js";
import { sweepAndPrune } from "../src/listings/sweep-and-prune.js";
import { sweep } from "../src/listings/sweep.js";
import { widestAxis } from "../src/listings/widest-axis.js";

const WORLDS = 300;

/** Numbers from 0 to 1, the same at each run. */
function generator(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

/** Boxes on so coarse a grid that many touch, coincide, enclose each other or are flat. */
function world(seed) {
  const random = generator(seed);
  const whole = (most) => Math.floor(random() * (most + 1));
  return Array.from({ length: whole(24) }, (_, id) => move({ id }, whole));
}

function move(box, whole) {
  [box.left, box.top] = [whole(12) - 6, whole(12) - 6];
  [box.right, box.bottom] = [box.left + whole(4), box.top + whole(4)];
  return box;
}

/** What the library finds, sorted. */
function expected(boxes) {
  const rows = boxes.flatMap(({ left, top, right, bottom }) => [left, top, right, bottom]);
  const found = findPairs(new Float64Array(rows), { dimensions: 2 });
  return Array.from({ length: found.length / 2 }, (_, at) => `${found[2 * at]} ${found[2 * at + 1]}`).sort();
}

const names = (pairs) => pairs.map(([a, b]) => key(a, b)).sort();

before(() => init());

describe("find all pairs, each once", () => {
  for (const find of [globalPairwise, sortedPairwise, sweepAndPrune, sweepAllAxes]) {
    test(find.name, () => {
      let all = 0;
      for (let seed = 0; seed < WORLDS; seed++) {
        const boxes = world(seed);
        const order = [...boxes];
        const pairs = [];
        find(boxes, (a, b) => pairs.push([a, b]));
        assert.deepEqual(names(pairs), expected(boxes), `seed ${seed}`);
        assert.deepEqual(boxes, order, "the caller's array is left alone");
        all += pairs.length;
      }
      assert.ok(all > 1000, "worlds with something to find");
    });
  }
});

describe("highlights the listing of a demo that moves", () => {
  const follow = {
    "swap-driven": (boxes) => {
      const state = swapDriven.begin(boxes);
      return () => swapDriven.update(state).filter(([a, b]) => a.top <= b.bottom && a.bottom >= b.top);
    },
    "swap-driven on all axes": (boxes) => {
      const state = swapAllAxes.begin(boxes);
      return () => swapAllAxes.update(state);
    },
  };
  for (const [name, start] of Object.entries(follow)) {
    test(name, () => {
      for (let seed = 0; seed < WORLDS; seed++) {
        const random = generator(seed + 1e6);
        const boxes = world(seed);
        const update = start(boxes);
        for (let frame = 0; frame < 8; frame++) {
          assert.deepEqual(names(update()), expected(boxes), `seed ${seed}, frame ${frame}`);
          for (const box of boxes) if (random() < 0.5) move(box, (most) => Math.floor(random() * (most + 1)));
        }
      }
    });
  }
});

describe("endpoints", () => {
  for (const sort of [quicksort, insertionSort]) {
    test(`${sort.name} leaves them in the one order there is`, () => {
      for (let seed = 0; seed < WORLDS; seed++) {
        const endpoints = endpointsOf(world(seed)).reverse();
        const sorted = [...endpoints].sort((p, q) => (precedes(p, q) ? -1 : 1));
        sort(endpoints);
        assert.deepEqual(endpoints, sorted);
      }
    });
  }

  test("the order is total, and a world at rest never swaps", () => {
    for (let seed = 0; seed < WORLDS; seed++) {
      const endpoints = endpointsOf(world(seed));
      quicksort(endpoints);
      refresh(endpoints);
      for (let at = 1; at < endpoints.length; at++) {
        assert.ok(precedes(endpoints[at - 1], endpoints[at]));
        assert.ok(!precedes(endpoints[at], endpoints[at - 1]));
      }
    }
  });

  test("the sweep meets each overlap on x once", () => {
    for (let seed = 0; seed < WORLDS; seed++) {
      const boxes = world(seed);
      const flat = boxes.map((box) => ({ ...box, top: 0, bottom: 0 }));
      const endpoints = endpointsOf(flat);
      quicksort(endpoints);
      const pairs = [];
      sweep(endpoints, (a, b) => pairs.push([a, b]));
      assert.deepEqual(names(pairs), expected(flat));
    }
  });
});

test("one-to-n misses the boxes that enclose the one, and no others", () => {
  let missed = 0;
  for (let seed = 0; seed < WORLDS; seed++) {
    const boxes = world(seed);
    const endpoints = endpointsOf(boxes);
    quicksort(endpoints);
    for (const box of boxes) {
      const found = new Set();
      oneToN(endpoints, box, (_, other) => found.add(other));
      for (const other of boxes) {
        if (other === box) continue;
        const [begin, end] = ["left", "right"].map((side) => (of) => endpoints.findIndex((e) => e.box === of && e.side === side));
        const encloses = begin(other) < begin(box) && end(other) > end(box);
        const meets = other.left <= box.right && other.right >= box.left;
        assert.equal(found.has(other), meets && !encloses);
        missed += Number(encloses);
      }
    }
  }
  assert.ok(missed > 1000, "worlds in which something is missed");
});

test("touching boxes and touching balls overlap", () => {
  const box = { left: 0, top: 0, right: 1, bottom: 1 };
  assert.ok(overlaps(box, { left: 1, top: 1, right: 2, bottom: 2 }));
  assert.ok(!overlaps(box, { left: 1.001, top: 0, right: 2, bottom: 1 }));
  assert.ok(ballsTouch({ x: 0, y: 0, radius: 2 }, { x: 3, y: 4, radius: 3 }));
  assert.ok(!ballsTouch({ x: 0, y: 0, radius: 2 }, { x: 3, y: 4, radius: 2.999 }));
});

test("the widest axis is the one on which centers are spread most", () => {
  const at = (x, y) => ({ left: x - 1, right: x + 1, top: y - 1, bottom: y + 1 });
  assert.equal(widestAxis([at(0, 0), at(10, 1), at(20, 0)]), "x");
  assert.equal(widestAxis([at(0, 0), at(1, 10), at(0, 20)]), "y");
});

test("the axis of fewest overlaps is the one with fewer pairs in sorted pairwise", () => {
  const overlapsOn = (boxes, first, last) => {
    let pairs = 0;
    for (const a of boxes) for (const b of boxes) pairs += Number(a.id < b.id && a[first] <= b[last] && a[last] >= b[first]);
    return pairs;
  };
  const chosen = new Set();
  for (let seed = 0; seed < WORLDS; seed++) {
    const boxes = world(seed);
    const axis = overlapsOn(boxes, "left", "right") <= overlapsOn(boxes, "top", "bottom") ? "x" : "y";
    assert.equal(axisOfFewestOverlaps(boxes), axis, `seed ${seed}`);
    chosen.add(axis);
  }
  assert.equal(chosen.size, 2);
});
