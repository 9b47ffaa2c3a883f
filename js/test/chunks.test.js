// Pairs in chunks, between which a program can wait: together they are those of one search.
import assert from "node:assert/strict";
import { once } from "node:events";
import { createServer, get } from "node:http";
import { before, test } from "node:test";
import { init, InvalidBoxError, PairFinder } from "sweep-and-prune";
import { boxesAmong, boxesSpread, random, sorted } from "./support/boxes.js";

before(() => init());

/** All pairs of chunks, sorted, and how many there are in each. @param {Iterable<Uint32Array>} chunks */
function gathered(chunks) {
  const sizes = [];
  const pairs = [];
  for (const chunk of chunks) {
    sizes.push(chunk.length / 2);
    for (const pair of sorted(chunk)) pairs.push(pair);
  }
  return { sizes, pairs: pairs.sort(([a, b], [c, d]) => a - c || b - d) };
}

for (const dimensions of /** @type {const} */ ([1, 2, 3])) {
  test(`${dimensions}D: the pairs of one search, each once`, () => {
    const next = random(dimensions);
    for (const views of [false, true]) {
      const finder = new PairFinder({ dimensions, views });
      for (const Floats of [Float32Array, Float64Array]) {
        const boxes = new Floats(boxesSpread(next, 20_000, dimensions));
        // Some reach far, and some begin at minus infinity.
        for (let at = 0; at < 3; at++) boxes.set(boxesAmong(next, 1, dimensions), Math.floor(next() * 20_000) * 2 * dimensions);
        const all = gathered(finder.chunks(boxes));
        assert.deepEqual(all.pairs, sorted(finder.find(boxes)));
        assert.equal(all.sizes.length, 3);
        // Of two sets, and of different precision.
        const others = boxesSpread(next, 5000, dimensions);
        for (const [a, b] of [[boxes, others], [others, boxes]]) {
          const between = gathered(finder.chunks(/** @type {Float64Array} */ (a), b));
          assert.deepEqual(between.pairs, sorted(finder.findBetween(/** @type {Float64Array} */ (a), /** @type {Float64Array} */ (b))));
          assert.equal(between.sizes.length, 4);
        }
      }
      finder.free();
    }
  });
}

test("few boxes, with ties and infinite edges, against one search", () => {
  for (let seed = 0; seed < 300; seed++) {
    const next = random(seed);
    const dimensions = /** @type {const} */ ([1, 2, 3])[seed % 3] ?? 1;
    const finder = new PairFinder({ dimensions });
    const [a, b] = [boxesAmong(next, Math.floor(9 * next()), dimensions), boxesAmong(next, Math.floor(9 * next()), dimensions)];
    assert.deepEqual(gathered(finder.chunks(a)).pairs, sorted(finder.find(a)));
    assert.deepEqual(gathered(finder.chunks(a, b)).pairs, sorted(finder.findBetween(a, b)));
    // A span beyond what a number holds.
    const far = [...a, ...boxesAmong(next, 4, dimensions, [-1.7e308, -1e308, 0, 1e308, 1.7e308])];
    assert.deepEqual(gathered(finder.chunks(far)).pairs, sorted(finder.find(far)));
    finder.free();
  }
});

test("boxes are checked at once, and may change afterwards", () => {
  const finder = new PairFinder({ dimensions: 1 });
  assert.throws(() => finder.chunks([0, 1, 3, 2]), { name: "InvalidBoxError", index: 1, axis: 0, argument: "boxes", min: 3, max: 2 });
  assert.throws(() => finder.chunks([0, 1], [0, 1, NaN, 2]), { name: "InvalidBoxError", index: 1, argument: "b" });
  assert.throws(() => finder.chunks([0, 1, NaN, 1], [3, 2]), InvalidBoxError);
  assert.throws(() => finder.chunks([0, 1, 2]), /^RangeError/);
  const boxes = new Float64Array([0, 1, 1, 2]);
  const chunks = finder.chunks(boxes);
  boxes.fill(NaN);
  assert.deepEqual(gathered(chunks).pairs, [[0, 1]]);
  const later = finder.chunks([0, 1, 1, 2]);
  finder.free();
  assert.throws(() => later.next(), /^TypeError: this PairFinder was freed/);
  assert.throws(() => finder.chunks([0, 1]), /^TypeError: this PairFinder was freed/);
  const skipping = new PairFinder({ dimensions: 1, missing: "skip" });
  assert.deepEqual(gathered(skipping.chunks([NaN, 1, 0, 1, Infinity, -Infinity, 1, 2])).pairs, [[1, 3]]);
  assert.throws(() => skipping.chunks([NaN, 1, 2, 1]), { name: "InvalidBoxError", index: 1 });
});

test("a server waits until its client has read", async () => {
  const boxes = boxesSpread(random(5), 200_000, 2);
  const finder = new PairFinder({ dimensions: 2 });
  let [most, waits] = [0, 0];
  const server = createServer(async (_, response) => {
    for (const pairs of finder.chunks(boxes)) {
      const isFree = response.write(new Uint8Array(pairs.buffer));
      most = Math.max(most, response.writableLength);
      if (!isFree) {
        waits++;
        await once(response, "drain");
      }
    }
    response.end();
  }).listen(0, "127.0.0.1");
  await once(server, "listening");
  const { port } = /** @type {import("node:net").AddressInfo} */ (server.address());
  const [response] = await once(get({ host: "127.0.0.1", port }), "response");
  let bytes = 0;
  for await (const part of response) bytes += part.length;
  server.close();
  const count = finder.count(boxes);
  assert.equal(bytes, 8 * count);
  assert.ok(waits > 5 && most < bytes / 5, `${waits} waits, at most ${most} of ${bytes} bytes in the buffer`);
});
