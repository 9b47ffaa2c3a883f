import RBush from "rbush";
import { PairFinder } from "sweep-and-prune";
import { BroadPhase, slotOf } from "sweep-and-prune/broad-phase";
import { random } from "../../../js/test/support/boxes.js";
import { keysOf } from "./keys.js";
import { copyBox, createItems, indexOf, load, overlap } from "./rows.js";

/** @typedef {import("./measure.js").Form} Form */

/** 200,000 parcels that are there, and 20,000 zones that come with a request: which meet? */
export function service() {
  const [PARCELS, ZONES, SIDE] = [200_000, 20_000, 1000];

  /** The boxes of parcels, and of the zones of a request. */
  function createLayers() {
    const next = random(1);
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
