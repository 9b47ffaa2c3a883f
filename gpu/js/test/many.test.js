// Many boxes on WebGPU in software: the pairs of the core, compared by a hash of all of them in order.
import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { after, before, describe, test } from "node:test";
import { findPairs, init } from "sweep-and-prune";
import { random, sorted } from "../../../js/test/support/boxes.js";
import { openPage } from "./support/gpu-page.js";

const COUNT = 1_000_000;
/** Boxes of many sizes take up to a quarter of an hour in software if they are a million. */
const COUNT_OF_SIZES = 200_000;
const skip = process.env["TEST_LONG"] ? false : "takes minutes: `./test --long` runs it";

/** In the page: makes the function `hashOfPairs`. Compiling the shaders takes seconds in software, so finders are kept. */
async function startPage() {
  // @ts-ignore: what the server of the tests has
  const { openDevice, PairFinder } = await import("/index.js");
  const device = await openDevice();
  // As GPUBufferUsage has it, whose types are not here.
  const STORAGE_AND_COPY_DST = 0x88;
  const finders = new Map();
  /** How many numbers the pairs of the boxes that the server has consist of, and their hash. @param {2 | 3} dimensions */
  const hashOfPairs = async (dimensions) => {
    const bytes = await (await fetch("/boxes")).arrayBuffer();
    const boxes = device.createBuffer({ size: bytes.byteLength, usage: STORAGE_AND_COPY_DST });
    device.queue.writeBuffer(boxes, 0, bytes);
    if (!finders.has(dimensions)) finders.set(dimensions, await PairFinder.create(device, { dimensions, sorted: true }));
    const finder = finders.get(dimensions);
    const found = await finder.find({ boxes, count: bytes.byteLength / (8 * dimensions) });
    const pairs = await finder.readPairs(found.pairs, found);
    boxes.destroy();
    const hash = new Uint8Array(await crypto.subtle.digest("SHA-256", pairs));
    return [pairs.length, Array.from(hash, (byte) => byte.toString(16).padStart(2, "0")).join("")];
  };
  Object.assign(globalThis, { hashOfPairs });
}

const next = random(1);

/**
 * Boxes whose sides are given by a function, at random places between 0 and 1.
 *
 * @param {2 | 3} dimensions @param {number} count @param {() => number} side
 */
function randomBoxes(dimensions, count, side) {
  const boxes = new Float32Array(2 * dimensions * count);
  for (let at = 0; at < boxes.length; at += 2 * dimensions) {
    for (let axis = 0; axis < dimensions; axis++) {
      const min = next();
      boxes[at + axis] = min;
      boxes[at + dimensions + axis] = min + side();
    }
  }
  return boxes;
}

/** How long a side is where about two boxes overlap each. @param {2 | 3} dimensions @param {number} count */
const usualSide = (dimensions, count) => 0.5 * (2 / count) ** (1 / dimensions);

describe("a million boxes", { skip }, () => {
  /** @type {Map<string, Uint8Array>} */
  const files = new Map();
  /** @type {Awaited<ReturnType<typeof openPage>>} */
  let opened;

  before(async () => {
    await init();
    opened = await openPage({ hasGpu: true, files });
    await opened.page.evaluate(startPage);
  });

  after(() => opened?.close());

  for (const dimensions of /** @type {const} */ ([2, 3])) {
    const side = usualSide(dimensions, COUNT);
    const smallest = usualSide(dimensions, COUNT_OF_SIZES) / 1000;
    const scenes = {
      "boxes of one size": randomBoxes(dimensions, COUNT, () => side),
      "boxes of sizes over four decades": randomBoxes(dimensions, COUNT_OF_SIZES, () => smallest * 10 ** (4 * next())),
    };
    for (const [name, boxes] of Object.entries(scenes)) {
      const count = boxes.length / (2 * dimensions);
      test(`${count} ${name} in ${dimensions}D have the pairs of findPairs`, async () => {
        files.set("/boxes", new Uint8Array(boxes.buffer));
        const [length, hash] = await opened.page.evaluate((dimensions) => /** @type {any} */ (globalThis).hashOfPairs(dimensions), dimensions);
        const expected = Uint32Array.from(sorted(findPairs(boxes, { dimensions })).flat());
        assert.ok(expected.length > count / 2);
        assert.equal(length, expected.length);
        assert.equal(hash, createHash("sha256").update(expected).digest("hex"));
      });
    }
  }
});
