// What programs do in a frame or for a request, each with this package, with rbush, with flatbush, and by hand.
//
// A form has two functions: `frame` is the work of a frame, and is timed; `found` says afterwards what it has found, as sorted
// numbers, which are the same in all forms.
import Flatbush from "flatbush";
import RBush from "rbush";
import { RBush3D } from "rbush-3d";
import { PairFinder } from "sweep-and-prune";
import { BroadPhase, slotOf } from "sweep-and-prune/broad-phase";
import { insertObjects, moveObjects } from "sweep-and-prune/three";
import { Box3, Mesh, Scene, SphereGeometry } from "three";

/** @typedef {{ frame: (step: number) => void, found: () => number[] }} Form */
/** @typedef {{ minX: number, minY: number, maxX: number, maxY: number, at: number }} Item */

/** Random numbers from 0 to 1, the same for each form. */
function random(seed = 1) {
  return () => (seed = (seed * 48271) % 2147483647) / 2147483647;
}

/** Whether two boxes of rows overlap. @type {(a: ArrayLike<number>, i: number, b: ArrayLike<number>, j: number) => boolean} */
const overlap = (a, i, b, j) =>
  a[4 * i] <= b[4 * j + 2] && b[4 * j] <= a[4 * i + 2] && a[4 * i + 1] <= b[4 * j + 3] && b[4 * j + 1] <= a[4 * i + 3];

/** What rbush holds. @type {(count: number) => Item[]} */
const createItems = (count) => Array.from({ length: count }, (_, at) => ({ minX: 0.5, minY: 0.5, maxX: 0.5, maxY: 0.5, at }));

/** @type {(item: Item, boxes: ArrayLike<number>, row: number) => void} */
function copyBox(item, boxes, row) {
  [item.minX, item.minY, item.maxX, item.maxY] = [boxes[4 * row], boxes[4 * row + 1], boxes[4 * row + 2], boxes[4 * row + 3]];
}

/** @type {(tree: RBush<Item>, items: Item[], boxes: ArrayLike<number>, from?: number) => void} */
function load(tree, items, boxes, from = 0) {
  items.forEach((item, at) => copyBox(item, boxes, from + at));
  tree.clear();
  tree.load(items);
}

/** A new index of rows. @type {(boxes: Float32Array | Float64Array, from?: number) => Flatbush} */
function indexOf(boxes, from = 0) {
  const index = new Flatbush(boxes.length / 4 - from, 16, boxes.constructor);
  for (let at = 4 * from; at < boxes.length; at += 4) index.add(boxes[at], boxes[at + 1], boxes[at + 2], boxes[at + 3]);
  index.finish();
  return index;
}

/** Flat pairs as sorted numbers. @type {(pairs: ArrayLike<number>) => number[]} */
function keysOf(pairs) {
  const keys = [];
  for (let at = 0; at < pairs.length; at += 2) keys.push(pairs[at] * 2 ** 20 + pairs[at + 1]);
  return keys.sort((a, b) => a - b);
}

/** The keys of the pairs of a world, whose slots are the positions of its bodies. @type {(world: BroadPhase) => number[]} */
const keysOfWorld = (world) => keysOf([...world.pairs()].map(slotOf));

/** 3,000 bullets and 500 enemies, which move: which bullet hits which enemy? */
function bulletHell() {
  const [BULLETS, ENEMIES] = [3000, 500];
  const COUNT = BULLETS + ENEMIES;

  /** Bodies that move, bullets first, and their boxes. */
  function createBodies() {
    const next = random();
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

  /** @type {Record<string, () => Form>} */
  const forms = {
    "BroadPhase, which reports events": () => {
      const { boxes, move } = createBodies();
      const world = new BroadPhase({ dimensions: 2 });
      const filters = Array.from({ length: COUNT }, (_, at) => (at < BULLETS ? { category: 1, mask: 2 } : { category: 2, mask: 1 }));
      const ids = world.insertMany(boxes, filters);
      return {
        frame: () => (move(), world.setMany(ids, boxes), world.update()),
        found: () => keysOfWorld(world),
      };
    },
    PairFinder: () => {
      const { boxes, move } = createBodies();
      const finder = new PairFinder({ dimensions: 2 });
      const [bullets, enemies] = [boxes.subarray(0, 4 * BULLETS), boxes.subarray(4 * BULLETS)];
      let pairs = new Uint32Array();
      return {
        frame: () => (move(), (pairs = finder.findBetween(bullets, enemies))),
        found: () => keysOf(pairs.map((row, at) => (at % 2 ? BULLETS + row : row))),
      };
    },
    rbush: () => {
      const { boxes, move } = createBodies();
      const [tree, items, bullet] = [new RBush(), createItems(ENEMIES), createItems(1)[0]];
      /** @type {number[]} */
      let pairs = [];
      return {
        frame: () => {
          move();
          load(tree, items, boxes, BULLETS);
          pairs = [];
          for (let at = 0; at < BULLETS; at++) {
            copyBox(bullet, boxes, at);
            for (const enemy of tree.search(bullet)) pairs.push(at, BULLETS + enemy.at);
          }
        },
        found: () => keysOf(pairs),
      };
    },
    flatbush: () => {
      const { boxes, move } = createBodies();
      /** @type {number[]} */
      let pairs = [];
      return {
        frame: () => {
          move();
          const index = indexOf(boxes, BULLETS);
          pairs = [];
          for (let at = 0; at < BULLETS; at++) {
            for (const enemy of index.search(boxes[4 * at], boxes[4 * at + 1], boxes[4 * at + 2], boxes[4 * at + 3])) pairs.push(at, BULLETS + enemy);
          }
        },
        found: () => keysOf(pairs),
      };
    },
    "two loops": () => {
      const { boxes, move } = createBodies();
      /** @type {number[]} */
      let pairs = [];
      return {
        frame: () => {
          move();
          pairs = [];
          for (let a = 0; a < BULLETS; a++) for (let b = BULLETS; b < COUNT; b++) if (overlap(boxes, a, boxes, b)) pairs.push(a, b);
        },
        found: () => keysOf(pairs),
      };
    },
  };
  return forms;
}

/** 20,000 shapes, of which 100 are dragged: what does the frame select that follows them, and what is under the pointer? */
function editor() {
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

/** 5,000 meshes that move: which boxes overlap? With the matrices that a renderer needs anyway. */
function meshes() {
  const COUNT = 5000;

  function createMeshes() {
    const next = random();
    const [scene, geometry] = [new Scene(), new SphereGeometry(0.5, 8, 6)];
    geometry.computeBoundingBox();
    const all = Array.from({ length: COUNT }, () => {
      const mesh = new Mesh(geometry);
      mesh.position.set(next(), next(), next()).multiplyScalar(25);
      scene.add(mesh);
      return mesh;
    });
    scene.updateMatrixWorld();
    const move = (/** @type {number} */ step) => {
      all.forEach((mesh, at) => mesh.position.set(mesh.position.x + Math.sin(at + step / 9) / 20, mesh.position.y + Math.cos(at + step / 7) / 20, mesh.position.z));
      scene.updateMatrixWorld();
    };
    const [box, rows] = [new Box3(), new Float64Array(6 * COUNT)];
    /** The boxes of the meshes, as rows. */
    const boxes = () => {
      all.forEach((mesh, at) => {
        const { min, max } = box.copy(/** @type {Box3} */ (geometry.boundingBox)).applyMatrix4(mesh.matrixWorld);
        min.toArray(rows, 6 * at);
        max.toArray(rows, 6 * at + 3);
      });
      return rows;
    };
    return { all, boxes, move };
  }
  const apart = (/** @type {Float64Array} */ rows, /** @type {number} */ a, /** @type {number} */ b, /** @type {number} */ axis) =>
    rows[6 * a + axis] > rows[6 * b + 3 + axis] || rows[6 * b + axis] > rows[6 * a + 3 + axis];

  /** A form that finds pairs in rows. @type {(find: (rows: Float64Array) => ArrayLike<number>) => Form} */
  const form = (find) => {
    const { boxes, move } = createMeshes();
    /** @type {ArrayLike<number>} */
    let pairs = [];
    return { frame: (step) => (move(step), (pairs = find(boxes()))), found: () => keysOf(pairs) };
  };

  /** @type {Record<string, () => Form>} */
  const forms = {
    "BroadPhase, which reports events": () => {
      const { all, move } = createMeshes();
      const world = new BroadPhase({ dimensions: 3, precision: "double" });
      insertObjects(world, all);
      return { frame: (step) => (move(step), moveObjects(world), world.update()), found: () => keysOfWorld(world) };
    },
    PairFinder: () => {
      const finder = new PairFinder({ dimensions: 3 });
      return form((rows) => finder.find(rows));
    },
    "rbush-3d": () => {
      const tree = new RBush3D();
      const items = Array.from({ length: COUNT }, (_, at) => ({ minX: 0.5, minY: 0.5, minZ: 0.5, maxX: 0.5, maxY: 0.5, maxZ: 0.5, at }));
      return form((rows) => {
        for (const item of items) [item.minX, item.minY, item.minZ, item.maxX, item.maxY, item.maxZ] = rows.subarray(6 * item.at);
        tree.clear();
        tree.load(items);
        const pairs = [];
        for (const item of items) for (const { at } of /** @type {typeof items} */ (tree.search(item))) if (at > item.at) pairs.push(item.at, at);
        return pairs;
      });
    },
    "flatbush, and z by hand": () =>
      form((rows) => {
        const index = new Flatbush(COUNT);
        for (let at = 0; at < rows.length; at += 6) index.add(rows[at], rows[at + 1], rows[at + 3], rows[at + 4]);
        index.finish();
        /** @type {number[]} */
        const pairs = [];
        for (let a = 0; a < COUNT; a++) {
          index.search(rows[6 * a], rows[6 * a + 1], rows[6 * a + 3], rows[6 * a + 4], (b) => {
            if (b > a && !apart(rows, a, b, 2)) pairs.push(a, b);
            return false;
          });
        }
        return pairs;
      }),
    "two loops": () =>
      form((rows) => {
        const pairs = [];
        for (let a = 0; a < COUNT; a++) for (let b = a + 1; b < COUNT; b++) if (!apart(rows, a, b, 0) && !apart(rows, a, b, 1) && !apart(rows, a, b, 2)) pairs.push(a, b);
        return pairs;
      }),
  };
  return forms;
}

/** 200,000 parcels that are there, and 20,000 zones that come with a request: which meet? */
function service() {
  const [PARCELS, ZONES, SIDE] = [200_000, 20_000, 1000];

  /** The boxes of parcels, and of the zones of a request. */
  function createLayers() {
    const next = random();
    const rows = (/** @type {number} */ count, /** @type {number} */ size) => {
      const boxes = new Float64Array(4 * count);
      for (let at = 0; at < count; at++) {
        const [x, y] = [next() * SIDE, next() * SIDE];
        boxes.set([x, y, x + size * next(), y + size * next()], 4 * at);
      }
      return boxes;
    };
    const parcels = rows(PARCELS, 3);
    return { parcels, request: () => rows(ZONES, 8) };
  }

  /** A form that finds pairs of parcels and zones. @type {(prepare: (parcels: Float64Array) => (zones: Float64Array) => ArrayLike<number>) => Form} */
  const form = (prepare) => {
    const { parcels, request } = createLayers();
    const find = prepare(parcels);
    /** @type {ArrayLike<number>} */
    let pairs = [];
    return { frame: () => void (pairs = find(request())), found: () => keysOf(pairs) };
  };
  /** @type {(index: Flatbush, zones: Float64Array) => number[]} */
  const search = (index, zones) => {
    const pairs = [];
    for (let zone = 0; zone < ZONES; zone++) {
      for (const parcel of index.search(zones[4 * zone], zones[4 * zone + 1], zones[4 * zone + 2], zones[4 * zone + 3])) pairs.push(parcel, zone);
    }
    return pairs;
  };

  /** @type {Record<string, () => Form>} */
  const forms = {
    PairFinder: () =>
      form((parcels) => {
        const finder = new PairFinder({ dimensions: 2 });
        return (zones) => finder.findBetween(parcels, zones);
      }),
    "BroadPhase, kept": () => {
      const { parcels, request } = createLayers();
      const world = new BroadPhase({ dimensions: 2, precision: "double" });
      world.insertMany(parcels);
      world.update();
      let answer = world.overlappingMany([]);
      return {
        frame: () => void (answer = world.overlappingMany(request(), {}, { sorted: false })),
        found: () => {
          const { ids, ends } = answer;
          const pairs = [];
          for (let zone = 0, at = 0; zone < ZONES; zone++) for (; at < ends[zone]; at++) pairs.push(slotOf(ids[at]), zone);
          return keysOf(pairs);
        },
      };
    },
    "rbush, kept": () =>
      form((parcels) => {
        const [tree, items, zone] = [new RBush(), createItems(PARCELS), createItems(1)[0]];
        load(tree, items, parcels);
        return (zones) => {
          const pairs = [];
          for (let row = 0; row < ZONES; row++) {
            copyBox(zone, zones, row);
            for (const parcel of tree.search(zone)) pairs.push(parcel.at, row);
          }
          return pairs;
        };
      }),
    "flatbush, kept": () =>
      form((parcels) => {
        const index = indexOf(parcels);
        return (zones) => search(index, zones);
      }),
    "flatbush, built for each request": () => form((parcels) => (zones) => search(indexOf(parcels), zones)),
    "a grid": () =>
      form((parcels) => {
        // Parcels are at most 3 wide: a parcel is in the cell of its lower corner.
        const [CELL, CELLS] = [3, Math.ceil(SIDE / 3) + 1];
        const cellOf = (/** @type {number} */ at) => Math.max(Math.floor(at / CELL), 0);
        const starts = new Uint32Array(CELLS * CELLS + 1);
        const cells = Uint32Array.from({ length: PARCELS }, (_, row) => cellOf(parcels[4 * row + 1]) * CELLS + cellOf(parcels[4 * row]));
        for (const cell of cells) starts[cell + 1]++;
        for (let cell = 0; cell < CELLS * CELLS; cell++) starts[cell + 1] += starts[cell];
        const [ends, sorted] = [starts.slice(), new Uint32Array(PARCELS)];
        cells.forEach((cell, row) => (sorted[ends[cell]++] = row));
        return (zones) => {
          const pairs = [];
          for (let zone = 0; zone < ZONES; zone++) {
            const [left, top, right, bottom] = zones.subarray(4 * zone);
            for (let y = cellOf(top - CELL); y <= Math.min(cellOf(bottom), CELLS - 1); y++) {
              const [from, to] = [y * CELLS + cellOf(left - CELL), y * CELLS + Math.min(cellOf(right), CELLS - 1)];
              for (let at = starts[from]; at < starts[to + 1]; at++) if (overlap(parcels, sorted[at], zones, zone)) pairs.push(sorted[at], zone);
            }
          }
          return pairs;
        };
      }),
  };
  return forms;
}

/** By name: how many frames are measured, and the forms. */
export const scenes = {
  "bullet hell": { frames: 300, forms: bulletHell() },
  editor: { frames: 300, forms: editor() },
  "three.js scene": { frames: 60, forms: meshes() },
  "GeoJSON service": { frames: 20, forms: service() },
};
