// The static index: against brute force, with and without vector instructions, and whatever its bytes are.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { Worker } from "node:worker_threads";
import { Index, IndexDataError, init, InvalidBoxError } from "sweep-and-prune/spatial-index";
import { boxesAmong, boxesSpread, coordinates, random } from "./support/boxes.js";

/** @type {WebAssembly.Memory} */
let memory;

before(async () => {
  const { instantiate } = WebAssembly;
  WebAssembly.instantiate = /** @type {any} */ (
    async (/** @type {WebAssembly.Module} */ module, /** @type {WebAssembly.Imports} */ imports) => {
      const instance = await instantiate(module, imports);
      memory = /** @type {WebAssembly.Memory} */ (instance.exports.memory);
      return instance;
    }
  );
  await init();
  WebAssembly.instantiate = instantiate;
});

/** @typedef {import("./support/boxes.js").Dimensions} Dimensions */

/**
 * The boxes that overlap an area, by brute force.
 *
 * @param {ArrayLike<number>} rows
 * @param {ArrayLike<number>} area
 * @param {Dimensions} dimensions
 */
function overlapping(rows, area, dimensions) {
  const at = (/** @type {ArrayLike<number>} */ of, /** @type {number} */ i) => /** @type {number} */ (of[i]);
  const found = [];
  for (let index = 0; index < rows.length / (2 * dimensions); index++) {
    const box = index * 2 * dimensions;
    let overlaps = true;
    for (let axis = 0; axis < dimensions; axis++) {
      overlaps &&= at(rows, box + axis) <= at(area, dimensions + axis) && at(area, axis) <= at(rows, box + dimensions + axis);
    }
    if (overlaps) found.push(index);
  }
  return found;
}

/**
 * Each box and the square of its distance to a point, nearest first.
 *
 * @param {ArrayLike<number>} rows
 * @param {readonly number[]} point
 */
function byDistance(rows, point) {
  const dimensions = point.length;
  const at = (/** @type {number} */ i) => /** @type {number} */ (rows[i]);
  const all = Array.from({ length: rows.length / (2 * dimensions) }, (_, index) => {
    const squares = point.map((from, axis) => {
      const box = index * 2 * dimensions + axis;
      return Math.max(at(box) - from, from - at(box + dimensions), 0) ** 2;
    });
    return { index, distance: Math.sqrt(squares.reduce((sum, square) => sum + square, 0)) };
  });
  return all.sort((a, b) => a.distance - b.distance || a.index - b.index);
}

const ascending = (/** @type {Uint32Array} */ found) => Array.from(found).sort((a, b) => a - b);
const finite = coordinates.filter(Number.isFinite);

for (const dimensions of /** @type {const} */ ([1, 2, 3])) {
  for (const Rows of [Float32Array, Float64Array]) {
    test(`equals brute force in ${dimensions}D, ${Rows.name}`, () => {
      const next = random(dimensions);
      const pick = () => Math.fround(/** @type {number} */ (finite[Math.floor(next() * finite.length)]));
      for (let round = 0; round < 120; round++) {
        const rows = Rows.from(boxesAmong(next, Math.floor(next() * (round % 8 === 0 ? 400 : 40)), dimensions));
        const index = new Index(rows, { dimensions });
        assert.equal(index.length, rows.length / (2 * dimensions));
        assert.equal(index.precision, Rows === Float32Array ? "single" : "double");
        const areas = Rows.from(boxesAmong(next, 5, dimensions));
        const many = [];
        for (let at = 0; at < areas.length; at += 2 * dimensions) {
          const area = areas.subarray(at, at + 2 * dimensions);
          const found = index.search(area);
          const expected = overlapping(rows, area, dimensions);
          assert.deepEqual(ascending(found), expected);
          assert.deepEqual(found, index.search(Array.from(area)));
          for (const box of found) many.push(at / (2 * dimensions), box);
          const some = index.search(area, { limit: 3 });
          assert.equal(new Set(some).size, Math.min(3, expected.length));
          assert.ok(some.every((box) => expected.includes(box)));
          const even = index.search(area, { filter: (box) => box % 2 === 0 });
          assert.deepEqual(ascending(even), expected.filter((box) => box % 2 === 0));
          assert.equal(index.search(area, { filter: (box) => box % 2 === 0, limit: 2 }).length, Math.min(2, even.length));
        }
        assert.deepEqual(Array.from(index.searchMany(areas)), many);
        const point = Array.from({ length: dimensions }, pick);
        const nearest = byDistance(rows, point);
        assert.deepEqual(index.neighbors(point), nearest);
        assert.deepEqual(index.neighbors(point, 5), nearest.slice(0, 5));
        assert.deepEqual(index.neighbors(point, 5, { maxDistance: 1 }), nearest.filter((it) => it.distance <= 1).slice(0, 5));
        const odd = nearest.filter((it) => it.index % 3 === 1);
        assert.deepEqual(index.neighbors(point, 4, { filter: (box) => box % 3 === 1 }), odd.slice(0, 4));
      }
      for (const count of [1000, 5000]) {
        const rows = Rows.from(boxesSpread(next, count, dimensions));
        const index = new Index(rows, { dimensions });
        for (let at = 0; at < 200; at += 2 * dimensions) {
          const area = rows.subarray(at, at + 2 * dimensions);
          assert.deepEqual(ascending(index.search(area)), overlapping(rows, area, dimensions));
        }
      }
    });
  }
}

test("rays and segments are answered nearest first", () => {
  const boxes = [{ minX: 5, minY: -1, maxX: 6, maxY: 1 }, { minX: 3, minY: 1, maxX: 4, maxY: 2 }, { minX: 2, minY: 0, maxX: 2, maxY: 0 }];
  const index = new Index(boxes);
  assert.equal(index.dimensions, 2);
  const hits = [{ index: 2, t: 2 }, { index: 0, t: 5 }];
  assert.deepEqual(index.rayCastAll([0, 0], [1, 0]), hits);
  assert.deepEqual(index.rayCast([0, 0], [1, 0]), hits[0]);
  assert.equal(index.rayCast([0, 0], [1, 0], 1.5), undefined);
  assert.deepEqual(index.rayCastAll([0, 0], [1, 0], 4), hits.slice(0, 1));
  assert.deepEqual(index.segment([0, 0], [5, 0]), [{ index: 2, t: 0.4 }, { index: 0, t: 1 }]);
  assert.deepEqual(index.rayCastAll({ x: 0, y: 0 }, { x: 1, y: 0 }), hits);
  assert.deepEqual(index.search({ minX: 0, minY: 0, maxX: 2, maxY: 0 }), Uint32Array.of(2));
  assert.deepEqual(index.search({ x: 0, y: 0, width: 2, height: 0 }), Uint32Array.of(2));
  assert.deepEqual(index.search(Int8Array.of(0, 0, 2, 0)), Uint32Array.of(2));
});

test("an index without boxes finds none", () => {
  const index = new Index([]);
  assert.deepEqual([index.length, index.dimensions], [0, 2]);
  assert.deepEqual(index.search([-Infinity, -Infinity, Infinity, Infinity]), new Uint32Array());
  assert.deepEqual(index.neighbors([0, 0]), []);
  assert.deepEqual(Index.from(index.data).search([0, 0, 1, 1]), new Uint32Array());
});

/** Boxes by a formula of whole numbers, which the tests of Rust and Python have too. */
function formula() {
  const rows = new Float32Array(4 * 5000);
  let state = 1;
  const next = () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0);
  for (let at = 0; at < rows.length; at += 4) {
    const [x, y, width, height] = [(next() >>> 8) / 2 ** 16, (next() >>> 8) / 2 ** 16, (next() >>> 16) / 2 ** 16, (next() >>> 16) / 2 ** 16];
    rows.set([x, y, x + width, y + height], at);
  }
  return rows;
}

/** @param {Uint8Array} bytes */
function fnv1a(bytes) {
  let hash = 0xcbf29ce484222325n;
  for (const byte of bytes) hash = ((hash ^ BigInt(byte)) * 0x100000001b3n) & 0xffffffffffffffffn;
  return hash.toString(16).padStart(16, "0");
}

test("the bytes are those of Rust and Python, and an index again", () => {
  const rows = formula();
  const index = new Index(rows, { dimensions: 2 });
  const { data } = index;
  assert.equal(fnv1a(data), "1ee420eb2337ff0b");
  const shifted = new Uint8Array(data.length + 3);
  shifted.set(data, 3);
  for (const form of [data, data.buffer, shifted.subarray(3), new DataView(data.buffer)]) {
    const copy = Index.from(form);
    assert.deepEqual([copy.length, copy.dimensions, copy.precision], [5000, 2, "single"]);
    assert.deepEqual(copy.search([10, 10, 40, 40]), index.search([10, 10, 40, 40]));
    assert.deepEqual(copy.data, data);
  }
});

test("without vector instructions the bytes and the answers are the same", async () => {
  const code = `
    import { parentPort } from "node:worker_threads";
    import { Index, init } from ${JSON.stringify(import.meta.resolve("sweep-and-prune/spatial-index"))};
    const { simd } = await init({ simd: false });
    const formula = ${formula.toString()};
    const index = new Index(formula(), { dimensions: 2 });
    parentPort.postMessage({ simd, data: index.data, found: index.search([10, 10, 90, 90]), near: index.neighbors([50, 50], 9) });`;
  const worker = new Worker(new URL(`data:text/javascript,${encodeURIComponent(code)}`));
  const { simd, data, found, near } = await new Promise((resolve, reject) => worker.once("message", resolve).once("error", reject));
  const index = new Index(formula(), { dimensions: 2 });
  assert.equal(simd, false);
  assert.deepEqual(data, index.data);
  assert.deepEqual(found, index.search([10, 10, 90, 90]));
  assert.deepEqual(near, index.neighbors([50, 50], 9));
});

test("any bytes give an error or an index that finds no box that is not there", () => {
  const next = random(5);
  const { data } = new Index(Float64Array.from(boxesSpread(next, 700, 2)), { dimensions: 2 });
  for (let round = 0; round < 300; round++) {
    const bytes = data.slice();
    for (let change = 0; change < 50; change++) bytes[Math.floor(next() * bytes.length)] = next() * 256;
    let index;
    try {
      index = Index.from(bytes);
    } catch (error) {
      assert.ok(error instanceof IndexDataError);
      continue;
    }
    assert.equal(index.length, 700);
    for (const found of [index.search([0, 0, 1, 1]), index.neighbors([0, 0]).map((it) => it.index)]) {
      assert.ok(Array.from(found).every((box) => box < 700));
    }
    index.free();
  }
  for (const [bytes, message] of /** @type {[Uint8Array, RegExp][]} */ ([
    [new TextEncoder().encode("PNG and more"), /do not begin/],
    [data.subarray(0, 40), /missing/],
    [data.subarray(0, -1), /missing/],
    [Uint8Array.from([...data.subarray(0, 4), 9, ...data.subarray(5)]), /version 9/],
    [Uint8Array.from([...data.subarray(0, 5), 4, ...data.subarray(6)]), /do not begin|dimensions/],
  ])) {
    assert.throws(() => Index.from(bytes), (error) => error instanceof IndexDataError && message.test(error.message));
  }
});

test("wrong arguments are refused by name, and change nothing", () => {
  const index = new Index(new Float32Array([0, 0, 1, 1]), { dimensions: 2 });
  const any = /** @type {any} */ (index);
  const constructor = /** @type {any} */ (Index);
  const expected = /** @type {[() => unknown, any][]} */ ([
    [() => new constructor([0, 0, 1, 1]), RangeError],
    [() => new constructor(new Float32Array(4), { dimensions: 4 }), RangeError],
    [() => new Index(new Float32Array(5), { dimensions: 2 }), RangeError],
    [() => new constructor("boxes", { dimensions: 2 }), TypeError],
    [() => new Index([{ minX: 0, minY: 0, maxX: 1, maxY: 1 }, { minX: 2, minY: 0, maxX: 1, maxY: 1 }]), InvalidBoxError],
    [() => index.search([2, 0, 1, 1]), InvalidBoxError],
    [() => index.search([0, 0, NaN, 1]), InvalidBoxError],
    [() => index.search([0, 0, 1]), RangeError],
    [() => any.search([0, 0, 1, "1"]), TypeError],
    [() => any.search(7), RangeError],
    [() => any.search(null), RangeError],
    [() => any.search({ x: 1 }), TypeError],
    [() => any.neighbors({ x: 1 }), TypeError],
    [() => index.search([0, 0, 1, 1], { limit: -1 }), RangeError],
    [() => any.search([0, 0, 1, 1], { filter: 1 }), TypeError],
    [() => index.searchMany([0, 0, 1]), RangeError],
    [() => index.searchMany([0, 0, 1, 1, 0, 5, 1, 1]), InvalidBoxError],
    [() => index.neighbors([0, Infinity]), RangeError],
    [() => index.neighbors([0, 1e300]), RangeError],
    [() => index.neighbors([0]), RangeError],
    [() => index.neighbors([0, 0], 1.5), RangeError],
    [() => index.neighbors([0, 0], 1, { maxDistance: -1 }), RangeError],
    [() => index.rayCast([0, 0], [1, NaN]), RangeError],
    [() => index.rayCast([0, 0], [1, 0], NaN), RangeError],
    [() => any.segment([0, 0]), TypeError],
    [() => constructor.from("bytes"), TypeError],
  ]);
  for (const [call, type] of expected) {
    assert.throws(call, type, String(call));
    assert.deepEqual(index.search([0, 0, 1, 1]), Uint32Array.of(0));
  }
  assert.throws(() => index.neighbors([0, 1e300]), /`point\[1\]` is 1e\+300; it must be finite/);
  const error = /** @type {InvalidBoxError} */ (thrown(() => index.searchMany([0, 0, 1, 1, 0, 5, 1, 1])));
  assert.deepEqual([error.index, error.axis, error.argument], [1, 1, "boxes"]);
  assert.equal(/** @type {InvalidBoxError} */ (thrown(() => index.search([2, 0, 1, 1]))).argument, "box");
  index.free();
  index.free();
  assert.throws(() => index.search([0, 0, 1, 1]), /was freed/);
  assert.throws(() => index.data, /was freed/);
});

/** @param {() => unknown} call */
function thrown(call) {
  try {
    call();
  } catch (error) {
    return error;
  }
  throw new Error("it throws nothing");
}

test("a filter may search the same index", () => {
  const index = new Index(boxesSpread(random(3), 500, 2), { dimensions: 2 });
  const all = [-1, -1, 2, 2];
  const outer = index.search(all, { filter: (box) => index.search(all).length === 500 && box < 250 });
  assert.deepEqual(ascending(outer), Array.from({ length: 250 }, (_, box) => box));
  const near = index.neighbors([0.5, 0.5], 10, { filter: (box) => index.search(all).length === 500 && box % 2 === 0 });
  assert.ok(near.length === 10 && near.every(({ index }) => index % 2 === 0));
});

test("indexes that are freed leave their memory to the next ones", () => {
  const rows = boxesSpread(random(4), 20_000, 2);
  const { data } = new Index(rows, { dimensions: 2 });
  const build = () => {
    new Index(rows, { dimensions: 2 }).free();
    Index.from(data).free();
    assert.throws(() => Index.from(data.subarray(1)), IndexDataError);
    assert.throws(() => Index.from(data.subarray(0, -1)), IndexDataError);
    assert.throws(() => new Index([...rows, 1, 0, 0, 0], { dimensions: 2 }), InvalidBoxError);
  };
  build();
  const start = memory.buffer.byteLength;
  for (let round = 0; round < 20; round++) build();
  assert.equal(memory.buffer.byteLength, start);
});
