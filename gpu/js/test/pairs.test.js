// The built package on WebGPU in software: the pairs of every scene and of random boxes, in the order of gpu/golden.txt.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { findPairs, init } from "sweep-and-prune";
import { sorted } from "../../../js/test/support/boxes.js";
import { compileScenes, fnv1a } from "../../../js/test/support/scenes.js";
import { openPage } from "./support/gpu-page.js";

/** @type {Awaited<ReturnType<typeof openPage>>} */
let opened;

before(async () => {
  await init();
  opened = await openPage({ hasGpu: true });
  await opened.page.evaluate(startPage);
});

after(() => opened?.close());

/**
 * Boxes, as bits of numbers that a page can be given, and what else a set has.
 *
 * @typedef {{ bits: number[], filters?: number[], worlds?: number[] }} Numbers
 * @typedef {{ dimensions: 2 | 3, sets: Numbers[], sorted?: boolean, capacity?: number, mostBytes?: number }} Task
 * @typedef {{ pairs: number[], found: number, written: number, invalid: number, firstInvalid: number, untouched: number[] }} Answer
 */

/** In the page: makes the function `search`. */
async function startPage() {
  // @ts-ignore: what the server of the tests has
  const library = await import("/index.js");
  const { openDevice, PairFinder, SUMMARY_BYTES } = library;
  const device = await openDevice();
  /**
   * @param {number[]} numbers
   * @param {GPUDevice} device
   */
  const upload = (numbers, device) => {
    const buffer = device.createBuffer({ size: Math.max(4, 4 * numbers.length), usage: 0x8c });
    device.queue.writeBuffer(buffer, 0, new Uint32Array(numbers));
    return buffer;
  };
  // Compiling the shaders takes seconds in software, so devices and finders are kept.
  const devices = new Map([[0, device]]);
  /** @param {number} mostBytes */
  const deviceOf = async (mostBytes) => {
    if (!devices.has(mostBytes)) {
      const made = await openDevice();
      // The limits of a device are at least the default ones: this one says less.
      Object.defineProperty(made, "limits", { value: { maxStorageBufferBindingSize: mostBytes, maxBufferSize: mostBytes } });
      devices.set(mostBytes, made);
    }
    return devices.get(mostBytes);
  };
  const finders = new Map();
  /** @param {GPUDevice} on @param {number} mostBytes @param {2 | 3} dimensions @param {boolean} sorted */
  const finderOf = async (on, mostBytes, dimensions, sorted) => {
    const key = `${mostBytes} ${dimensions} ${sorted}`;
    if (!finders.has(key)) finders.set(key, await PairFinder.create(on, { dimensions, sorted }));
    return finders.get(key);
  };
  /** @param {Task} task @returns {Promise<Answer>} */
  const search = async ({ dimensions, sets, sorted = false, capacity, mostBytes = 0 }) => {
    const on = await deviceOf(mostBytes);
    const finder = await finderOf(on, mostBytes, dimensions, sorted);
    const given = sets.map(({ bits, filters, worlds }) => ({
      boxes: upload(bits, on),
      count: bits.length / (2 * dimensions),
      ...(filters && { filters: upload(filters, on) }),
      ...(worlds && { worlds: upload(worlds, on) }),
    }));
    if (capacity === undefined) {
      const found = await (given.length === 1 ? finder.find(given[0]) : finder.findBetween(...given));
      const pairs = Array.from(await finder.readPairs(found.pairs, found));
      const { found: count, written, invalid, firstInvalid } = found;
      return { pairs, found: count, written, invalid, firstInvalid, untouched: [] };
    }
    const pairs = upload(new Array(2 * capacity + 1).fill(7), on);
    const summary = upload(new Array(SUMMARY_BYTES / 4).fill(0), on);
    await (given.length === 1 ? finder.findInto(given[0], pairs, summary) : finder.findBetweenInto(...given, pairs, summary));
    const read = await finder.readSummary(summary);
    const all = Array.from(await finder.readPairs(pairs, { written: capacity }));
    return { pairs: all.slice(0, 2 * read.written), untouched: all.slice(2 * read.written), ...read };
  };
  /** @param {() => unknown} run */
  const errorOf = async (run) => {
    try {
      await run();
      return undefined;
    } catch (error) {
      const { name, code, count, message } = /** @type {any} */ (error);
      return { name, code, count, message };
    }
  };
  Object.assign(globalThis, { library, device, search, errorOf, deviceOf, finderOf });
}

/**
 * Searches in the page. Task and answer travel as text: of arrays, Playwright writes number by number.
 *
 * @param {Task} task
 * @returns {Promise<Answer>}
 */
async function search(task) {
  const inPage = async (/** @type {string} */ task) => JSON.stringify(await /** @type {any} */ (globalThis).search(JSON.parse(task)));
  return JSON.parse(await opened.page.evaluate(inPage, JSON.stringify(task)));
}

/** @param {Float32Array} boxes */
const bitsOf = (boxes) => Array.from(new Uint32Array(boxes.buffer, boxes.byteOffset, boxes.length));

/** @param {ArrayLike<number>} flat */
const sortedPairs = (flat) => sorted(Uint32Array.from(flat)).flat();

/** Random whole numbers below a limit, the same in each run (a linear congruential generator). */
let state = 1;
/** @param {number} limit */
const below = (limit) => {
  state = (Math.imul(state, 1_664_525) + 1_013_904_223) >>> 0;
  return Math.floor((state / 2 ** 32) * limit);
};

const coordinates = [-Infinity, -1, -0, 0, 1e-45, 3e-45, 1, 1 + 2 ** -23, 2, 3, 3.4028234663852886e38, Infinity];

/**
 * Valid boxes on few coordinates.
 *
 * @param {number} count
 * @param {2 | 3} dimensions
 */
function randomBoxes(count, dimensions) {
  const boxes = new Float32Array(2 * dimensions * count);
  for (let box = 0; box < count; box++) {
    for (let axis = 0; axis < dimensions; axis++) {
      const [a = 0, b = 0] = [coordinates[below(coordinates.length)], coordinates[below(coordinates.length)]];
      const at = 2 * dimensions * box + axis;
      boxes[at] = Math.min(a, b);
      boxes[at + dimensions] = Math.max(a, b);
    }
  }
  return boxes;
}

/**
 * Whether a box of one set overlaps a box of another: the intervals are closed.
 *
 * @param {Float32Array} boxes @param {number} a @param {Float32Array} others @param {number} b @param {2 | 3} dimensions
 */
function overlap(boxes, a, others, b, dimensions) {
  for (let axis = 0; axis < dimensions; axis++) {
    const [at, other] = [2 * dimensions * a + axis, 2 * dimensions * b + axis];
    const meet = (boxes[at] ?? 0) <= (others[other + dimensions] ?? 0) && (others[other] ?? 0) <= (boxes[at + dimensions] ?? 0);
    if (!meet) return false;
  }
  return true;
}

test("every scene has the pairs of findPairs, in the order of the golden file", async () => {
  const scenes = await compileScenes();
  const lines = readFileSync(new URL("../../golden.txt", import.meta.url), "utf8").split("\n").filter((line) => line && !line.startsWith("#"));
  assert.ok(lines.length > 60);
  for (const line of lines) {
    const [scene, space, type, count, hash] = line.split(" ");
    const dimensions = space === "2d" ? 2 : 3;
    const boxes = new Float32Array(scenes.get(`${scene} ${space} ${type}`) ?? assert.fail(line));
    const { pairs, found, invalid } = await search({ dimensions, sets: [{ bits: bitsOf(boxes) }] });
    assert.equal(`${found} ${fnv1a(new Uint8Array(Uint32Array.from(pairs).buffer))} ${invalid}`, `${count} ${hash} 0`, line);
    assert.deepEqual(sortedPairs(pairs), sortedPairs(findPairs(boxes, { dimensions })), line);
  }
});

test("thousands of random boxes have the pairs of findPairs", async () => {
  for (const [count, dimensions] of /** @type {[number, 2 | 3][]} */ ([[0, 2], [1, 3], [300, 2], [1000, 3]])) {
    const boxes = randomBoxes(count, dimensions);
    const { pairs } = await search({ dimensions, sets: [{ bits: bitsOf(boxes) }] });
    assert.deepEqual(sortedPairs(pairs), sortedPairs(findPairs(boxes, { dimensions })));
  }
  // Uniform, with several tiles of the sort and several levels of the tree.
  const boxes = new Float32Array(6 * 5000);
  for (let at = 0; at < boxes.length; at += 6) {
    const corner = [below(1 << 20), below(1 << 20), below(1 << 20)];
    boxes.set([...corner, ...corner.map((at) => at + 50_000)], at);
  }
  const { pairs } = await search({ dimensions: 3, sets: [{ bits: bitsOf(boxes) }] });
  assert.ok(pairs.length > 5000);
  assert.deepEqual(sortedPairs(pairs), sortedPairs(findPairs(boxes, { dimensions: 3 })));
});

test("worlds, filters and two sets have the pairs of brute force", async () => {
  for (const dimensions of /** @type {const} */ ([2, 3])) {
    const [first, second] = [500, 700].map((count) => {
      const worlds = Array.from({ length: count }, () => [5, 6, 2 ** 31 - 1, 0][below(4)] ?? 0);
      const filters = Array.from({ length: 2 * count }, () => below(8));
      return { boxes: randomBoxes(count, dimensions), count, worlds, filters };
    });
    assert.ok(first && second);
    const [a, b] = [first, second];
    /** @type {number[]} */
    const expected = [];
    for (let i = 0; i < a.count; i++) {
      for (let j = 0; j < b.count; j++) {
        const allowed = (a.filters[2 * i] ?? 0) & (b.filters[2 * j + 1] ?? 0) && (b.filters[2 * j] ?? 0) & (a.filters[2 * i + 1] ?? 0);
        if (a.worlds[i] === b.worlds[j] && allowed && overlap(a.boxes, i, b.boxes, j, dimensions)) expected.push(i, j);
      }
    }
    const sets = [a, b].map(({ boxes, worlds, filters }) => ({ bits: bitsOf(boxes), worlds, filters }));
    const { pairs } = await search({ dimensions, sets, sorted: dimensions === 2 });
    assert.deepEqual(dimensions === 2 ? pairs : sortedPairs(pairs), expected);
  }
});

test("invalid boxes are reported and have no pairs", async () => {
  const boxes = new Float32Array([0, 0, 2, 2, NaN, 0, 1, 1, 1, 1, 3, 3, 2, 2, 1, 3]);
  const answer = await search({ dimensions: 2, sets: [{ bits: bitsOf(boxes) }] });
  assert.deepEqual([answer.pairs, answer.invalid, answer.firstInvalid], [[0, 2], 2, 1]);
});

test("a buffer that is too small receives what fits", async () => {
  const boxes = randomBoxes(60, 2);
  const sets = [{ bits: bitsOf(boxes) }];
  const all = await search({ dimensions: 2, sets });
  for (const capacity of [0, 1, all.found - 1, all.found, all.found + 3]) {
    for (const sorted of [false, true]) {
      const { pairs, found, written, untouched } = await search({ dimensions: 2, sets, sorted, capacity });
      const fit = all.pairs.slice(0, 2 * capacity);
      assert.equal(found, all.found);
      assert.equal(written, Math.min(found, capacity));
      assert.deepEqual(pairs, sorted ? sortedPairs(fit) : fit);
      assert.ok(untouched.every((number) => number === 7));
    }
  }
});

test("limits, wrong buffers and lost devices are errors that say so", async () => {
  const results = await opened.page.evaluate(async () => {
    const { library, device, search, errorOf, deviceOf, finderOf } = /** @type {any} */ (globalThis);
    const same = Array.from({ length: 200 }, () => [0, 0, 1, 1]).flat();
    const boxes = device.createBuffer({ size: 160, usage: 0x80 });
    const many = Array.from({ length: 2000 }, () => [0, 0, 1, 1]).flat();
    const finder = await finderOf(device, 0, 2, false);
    const [a, b] = await Promise.all([finder.find({ boxes, count: 10 }), finder.find({ boxes, count: 9 })]);
    const limits = {
      boxes: await errorOf(() => search({ dimensions: 2, sets: [{ bits: many }], mostBytes: 65_536 })),
      pairs: await errorOf(() => search({ dimensions: 2, sets: [{ bits: same }], mostBytes: 65_536 })),
    };
    const lost = await deviceOf(65_536);
    const losing = await finderOf(lost, 65_536, 2, false);
    lost.destroy();
    return {
      ...limits,
      small: await errorOf(() => finder.find({ boxes, count: 11 })),
      usage: await errorOf(() => finder.find({ boxes: device.createBuffer({ size: 160, usage: 0x20 }), count: 10 })),
      count: await errorOf(() => finder.find({ boxes, count: -1 })),
      dimensions: await errorOf(() => library.PairFinder.create(device, { dimensions: 4 })),
      lost: await errorOf(() => losing.find({ boxes, count: 1 })),
      made: await errorOf(() => library.PairFinder.create(lost, { dimensions: 2 })),
      // Both calls were made at once, and each has its own answer.
      found: [a.found, b.found],
    };
  });
  assert.deepEqual([results.boxes?.code, results.boxes?.count], ["TOO_MANY_BOXES", 2000]);
  assert.deepEqual([results.pairs?.code, results.pairs?.count], ["TOO_MANY_PAIRS", 19_900]);
  assert.match(results.pairs?.message ?? "", /there are 19900 pairs, but a buffer of this device holds 8192/);
  assert.match(results.small?.message ?? "", /the buffer `boxes` has 160 bytes, but 176 are needed/);
  assert.match(results.usage?.message ?? "", /without the usage STORAGE/);
  assert.match(results.count?.message ?? "", /count is -1/);
  assert.match(results.dimensions?.message ?? "", /dimensions is 4/);
  assert.equal(results.lost?.code, "DEVICE_LOST");
  assert.equal(results.made?.code, "DEVICE_LOST");
  assert.deepEqual(results.found, [45, 36]);
});

test("a finder that measures says how long each stage took, and finds the same pairs", async () => {
  const sets = [{ bits: bitsOf(randomBoxes(300, 2)) }];
  const expected = await search({ dimensions: 2, sets });
  const results = await opened.page.evaluate(async (bits) => {
    const { library, device, errorOf, finderOf } = /** @type {any} */ (globalThis);
    const { openDevice, PairFinder, SUMMARY_BYTES } = library;
    const count = bits.length / 4;
    /** @param {GPUDevice} on @param {number} size */
    const bufferOf = (on, size) => on.createBuffer({ size, usage: 0x8c });
    /** @param {GPUDevice} on */
    const boxesOf = (on) => {
      const boxes = bufferOf(on, 4 * bits.length);
      on.queue.writeBuffer(boxes, 0, new Uint32Array(bits));
      return { boxes, count };
    };
    /** @param {any} finder @param {any} found */
    const pairsOf = async (finder, found) => Array.from(await finder.readPairs(found.pairs, found));

    const timed = await PairFinder.create(device, { dimensions: 2, timed: true });
    const before = await timed.stageTimes();
    const pairs = await pairsOf(timed, await timed.find(boxesOf(device)));
    const times = await timed.stageTimes();
    const sorting = await PairFinder.create(device, { dimensions: 2, sorted: true, timed: true });
    const [own, summary] = [bufferOf(device, 8 * 100_000), bufferOf(device, SUMMARY_BYTES)];
    // None is awaited: each answer is about the search before it.
    const [, sorted, , none] = await Promise.all([sorting.findInto(boxesOf(device), own, summary), sorting.stageTimes(), sorting.findInto({ boxes: own, count: 0 }, own, summary), sorting.stageTimes()]);
    sorting.destroy();

    // A device that cannot measure.
    const adapter = await navigator.gpu.requestAdapter();
    const plain = await adapter?.requestDevice();
    if (!plain) throw new Error("no device");
    const untimed = await PairFinder.create(plain, { dimensions: 2, timed: true });
    return {
      before,
      pairs,
      times,
      sorted,
      none,
      asked: (await openDevice()).features.has("timestamp-query"),
      without: { pairs: await pairsOf(untimed, await untimed.find(boxesOf(plain))), times: await untimed.stageTimes() },
      error: await errorOf(async () => (await finderOf(device, 0, 2, false)).stageTimes()),
    };
  }, sets[0]?.bits ?? []);
  const stages = ["read boxes", "order boxes", "build the tree", "count the pairs", "sum the numbers up", "write the pairs"];
  /** @param {{ stage: string }[]} times */
  const names = (times) => times.map(({ stage }) => stage);
  assert.ok(results.asked, "openDevice asks for the feature");
  assert.deepEqual(results.pairs, expected.pairs);
  assert.deepEqual(results.before, []);
  assert.deepEqual(names(results.times), stages);
  assert.deepEqual(names(results.sorted), [...stages, "sort the pairs"]);
  assert.deepEqual(names(results.none).slice(-1), ["sort the pairs"]);
  /** @type {{ milliseconds: number }[]} */
  const all = [...results.times, ...results.sorted];
  for (const { milliseconds } of all) assert.ok(milliseconds >= 0, String(milliseconds));
  assert.ok(all.some(({ milliseconds }) => milliseconds > 0));
  assert.deepEqual(results.without, { pairs: expected.pairs, times: [] });
  assert.match(results.error?.message ?? "", /timed: true/);
});

test("finders of a device share the compiled shaders; what failed to compile is compiled again", async () => {
  const { shaders, ...results } = await opened.page.evaluate(async () => {
    const { library, errorOf } = /** @type {any} */ (globalThis);
    const { openDevice, PairFinder } = library;
    /** @type {GPUDevice} */
    const device = await openDevice();
    let compiled = 0;
    const compile = device.createComputePipelineAsync.bind(device);
    device.createComputePipelineAsync = async () => {
      throw new Error("no compiler");
    };
    const failed = await errorOf(() => PairFinder.create(device, { dimensions: 2 }));
    device.createComputePipelineAsync = (descriptor) => {
      compiled++;
      return compile(descriptor);
    };
    await Promise.all([PairFinder.create(device, { dimensions: 2 }), PairFinder.create(device, { dimensions: 3, sorted: true })]);
    const first = compiled;
    await PairFinder.create(device, { dimensions: 3, timed: true });
    return { failed, shaders: first, later: compiled - first };
  });
  assert.equal(results.failed?.code, "DEVICE");
  assert.match(results.failed?.message ?? "", /cannot compile the shaders: Error: no compiler/);
  assert.equal(shaders, readFileSync(new URL("../src/kernels.ts", import.meta.url), "utf8").match(/^  \| "\w+"/gm)?.length);
  assert.equal(results.later, 0);
});

test("findPairs copies boxes to the GPU and pairs back", async () => {
  const results = await opened.page.evaluate(async () => {
    const { library, errorOf } = /** @type {any} */ (globalThis);
    const boxes = new Float32Array([0, 0, 2, 2, 5, 5, 6, 6, 2, 1, 3, 4]);
    const both = await Promise.all([library.findPairs(boxes, { dimensions: 2 }), library.findPairs(boxes.subarray(4), { dimensions: 2 })]);
    return {
      pairs: both.map((pairs) => Array.from(pairs)),
      none: (await library.findPairs(new Float32Array(), { dimensions: 2 })).length,
      invalid: await errorOf(() => library.findPairs(new Float32Array([0, 0, 1, 1, 2, 0, 1, 1]), { dimensions: 2 })),
      length: await errorOf(() => library.findPairs(new Float32Array(5), { dimensions: 2 })),
      array: await errorOf(() => library.findPairs([0, 0, 1, 1], { dimensions: 2 })),
      dimensions: await errorOf(() => library.findPairs(boxes)),
    };
  });
  assert.deepEqual(results.pairs, [[0, 2], []]);
  assert.equal(results.none, 0);
  assert.equal(results.invalid?.name, "RangeError");
  assert.match(results.invalid?.message ?? "", /box 1 is invalid/);
  assert.match(results.length?.message ?? "", /boxes has 5 numbers; a box has 4/);
  assert.match(results.array?.message ?? "", /boxes must be a Float32Array/);
  assert.match(results.dimensions?.message ?? "", /dimensions is undefined; it must be 2 or 3/);
});

test("a search sees its boxes as they were at the call, and a refused call changes nothing", async () => {
  const results = await opened.page.evaluate(async () => {
    const { library, device, errorOf, finderOf } = /** @type {any} */ (globalThis);
    /** @param {number[]} numbers */
    const bufferOf = (numbers) => {
      const buffer = device.createBuffer({ size: 4 * numbers.length, usage: 0x8c });
      device.queue.writeBuffer(buffer, 0, new Float32Array(numbers));
      return buffer;
    };
    /** @param {GPUBuffer} buffer */
    const copyOf = (buffer) => {
      const copy = device.createBuffer({ size: buffer.size, usage: 0x8c });
      const encoder = device.createCommandEncoder();
      encoder.copyBufferToBuffer(buffer, 0, copy, 0, buffer.size);
      device.queue.submit([encoder.finish()]);
      return copy;
    };
    const apart = new Float32Array([0, 0, 1, 1, 5, 5, 6, 6]);
    const own = new Float32Array([0, 0, 1, 1, 1, 1, 2, 2]);
    const searching = library.findPairs(own, { dimensions: 2 });
    own.set(apart);
    const changed = Array.from(await searching);

    // No earlier call is open: what is submitted after the call comes after the search.
    const finder = await finderOf(device, 0, 2, false);
    const boxes = bufferOf([0, 0, 1, 1, 1, 1, 2, 2]);
    await finder.find({ boxes, count: 2 });
    const [pairs, summary] = [bufferOf([7, 7]), bufferOf(new Array(library.SUMMARY_BYTES / 4).fill(0))];
    const writing = finder.findInto({ boxes, count: 2 }, pairs, summary);
    const copy = copyOf(pairs);
    device.queue.writeBuffer(boxes, 0, apart);
    await writing;
    const copied = Array.from(await finder.readPairs(copy, { written: 1 }));
    const { found: later } = await finder.find({ boxes, count: 2 });

    // After a call that is refused, the results of the one before can be read, and its buffers are used again.
    device.queue.writeBuffer(boxes, 0, new Float32Array([0, 0, 1, 1, 1, 1, 2, 2]));
    const before = await finder.find({ boxes, count: 2 });
    const refused = [await errorOf(() => finder.find({ boxes, count: 3 })), await errorOf(() => finder.findInto({ boxes, count: -1 }, pairs, summary))];
    const kept = Array.from(await finder.readPairs(before.pairs, before));
    const isSame = (await finder.find({ boxes, count: 2 })).pairs === before.pairs;
    return { changed, copied, later, refused, kept, isSame };
  });
  assert.deepEqual(results.changed, [0, 1]);
  assert.deepEqual([results.copied, results.later], [[0, 1], 0]);
  assert.ok(results.refused.every((error) => error));
  assert.deepEqual([results.kept, results.isSame], [[0, 1], true]);
});

test("without a GPU there is an error, or the fallback that the caller chose", async () => {
  const { page, close } = await openPage({ hasGpu: false });
  try {
    const { error, pairs } = await page.evaluate(async () => {
      // @ts-ignore: what the server of the tests has
      const { findPairs } = await import("/index.js");
      const error = await findPairs(new Float32Array(4), { dimensions: 2 }).catch((/** @type {any} */ error) => error);
      const pairs = await findPairs(new Float32Array(8), { dimensions: 2, fallback: () => new Uint32Array([0, 1]) });
      return { error: error.code, pairs: Array.from(pairs) };
    });
    assert.match(error, /NO_WEBGPU|NO_ADAPTER/);
    assert.deepEqual(pairs, [0, 1]);
  } finally {
    await close();
  }
  // Node has no WebGPU.
  const { findPairs: findOnGpu } = await import("sweep-and-prune-gpu");
  const boxes = randomBoxes(50, 2);
  await assert.rejects(findOnGpu(boxes, { dimensions: 2 }), { name: "GpuError", code: "NO_WEBGPU" });
  assert.deepEqual(await findOnGpu(boxes, { dimensions: 2, fallback: findPairs }), findPairs(boxes, { dimensions: 2 }));
});
