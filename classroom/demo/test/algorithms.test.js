// Every algorithm by name equals brute force; its trace plays forward and back.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { axes, events, init, InvalidBoxError, methods, Player, Runner, sorts } from "sweep-and-prune-classroom";
import { boxesAmong, oracle, random, sorted } from "../../../js/test/support/boxes.js";

before(() => init());

const every = /** @type {const} */ ([1, 2, 3]);

for (const method of methods.filter((name) => name !== "one-to-n scan")) {
  test(`${method} equals brute force, step by step`, () => {
    for (const dimensions of every) {
      const next = random(60 + dimensions);
      const choices = [...axes.slice(1), .../** @type {const} */ ([0, dimensions - 1])];
      for (const [index, sort] of sorts.entries()) {
        const axis = /** @type {any} */ (choices[index % choices.length]);
        const runner = new Runner({ dimensions, method, sort, axis, persistent: true });
        /** @type {string[]} */
        let last = [];
        for (let step = 0; step < 12; step++) {
          const rows = boxesAmong(next, Math.floor(next() * 15), dimensions, [-1, 0, 1, 2, 3, 4]);
          const found = runner.step(step % 2 ? rows : Float32Array.from(rows));
          const expected = oracle(rows, dimensions).map(String);
          assert.deepEqual(sorted(found.pairs).map(String), expected);
          assert.deepEqual(sorted(found.begun).map(String), expected.filter((pair) => !last.includes(pair)));
          assert.deepEqual(sorted(found.ended).map(String), last.filter((pair) => !expected.includes(pair)));
          assert.equal(found.counts.pairs, expected.length);
          assert.ok(found.axis < dimensions);
          last = expected;
        }
        runner.free();
      }
    }
  });
}

test("a trace plays forward to the result and back to nothing", () => {
  for (const method of methods) {
    const runner = new Runner({ dimensions: 2, method, persistent: true, traceWords: 1 << 20 });
    const next = random(70);
    const first = runner.step(boxesAmong(next, 8, 2));
    const last = runner.step(boxesAmong(next, 8, 2));
    assert.equal(runner.isTruncated, false);
    const all = [...events(runner.trace())];
    assert.equal(all.filter(({ kind }) => kind === "step").length, 2);
    assert.equal(all.filter(({ kind }) => kind === "compare").length, first.counts.comparisons + last.counts.comparisons);
    const player = new Player(runner);
    const start = player.state();
    /** @type {import("sweep-and-prune-classroom").PlayerState[]} */
    const states = [];
    for (const event of all) {
      states.push(player.state());
      assert.deepEqual(player.forward(), event);
    }
    assert.equal(player.forward(), undefined);
    assert.equal(player.position, all.length);
    const end = player.state();
    assert.deepEqual(end.overlaps, sorted(last.pairs).flat());
    assert.deepEqual(end.counts, last.counts);
    for (const event of [...all].reverse()) {
      assert.deepEqual(player.backward(), event);
      assert.deepEqual(player.state(), states.pop());
    }
    assert.equal(player.backward(), undefined);
    assert.deepEqual(player.state(), start);
    player.seek(2 ** 40);
    assert.deepEqual(player.state(), end);
    runner.clearTrace();
    assert.equal(runner.trace().length, 0);
    player.free();
    runner.free();
  }
});

test("a trace that is full says so", () => {
  const runner = new Runner({ dimensions: 1, method: "sorted pairwise", traceWords: 20 });
  runner.step([0, 1, 0, 1, 0, 1]);
  assert.equal(runner.isTruncated, true);
  assert.ok(runner.trace().length <= 20);
});

test("misuse", () => {
  const good = /** @type {const} */ ({ dimensions: 2, method: "sorted pairwise" });
  for (const bad of [{ method: "bogus" }, { sort: "bogus" }, { axis: "bogus" }, { axis: 2 }, { axis: -1 }, { dimensions: 4 }, { focus: -1 }, { traceWords: 0.5 }]) {
    assert.throws(() => new Runner(/** @type {any} */ ({ ...good, ...bad })), RangeError);
  }
  const runner = new Runner(good);
  assert.throws(() => runner.step([0, 0, 1, 1, 1, 0, 0, 1]), (error) => error instanceof InvalidBoxError && error.index === 1 && error.min === 1 && error.max === 0);
  assert.throws(() => runner.step([1, 0, 0]), RangeError);
  const player = new Player(runner);
  assert.throws(() => player.seek(-1), RangeError);
  player.free();
  assert.throws(() => player.state(), TypeError);
  runner.free();
  assert.throws(() => runner.step([]), TypeError);
  assert.throws(() => new Player(runner), TypeError);
});

test("a copy goes on as its runner does, and a trimmed trace plays one step by itself", () => {
  for (const method of methods) {
    const next = random(80);
    const worlds = Array.from({ length: 6 }, () => boxesAmong(next, 8, 2));
    const options = /** @type {const} */ ({ dimensions: 2, method, sort: "insertion sort", persistent: true, traceWords: 1 << 20 });
    const whole = new Runner(options);
    let runner = new Runner(options);
    for (const boxes of worlds) {
      const before = runner.trimTrace();
      const copy = new Runner(runner);
      // What memory is held to spare is not copied.
      const found = { ...runner.step(boxes), bytes: 0 };
      assert.deepEqual({ ...copy.step(boxes), bytes: 0 }, found);
      assert.deepEqual(copy.trace(), runner.trace());
      assert.deepEqual({ ...whole.step(boxes), bytes: 0 }, found);
      assert.equal([...events(runner.trace())][before]?.kind, "step");
      const [short, long] = [new Player(runner), new Player(whole)];
      short.seek(2 ** 32);
      long.seek(2 ** 32);
      assert.deepEqual(short.state(), long.state());
      runner.free();
      runner = copy; // goes on from the copy
    }
    assert.throws(() => new Runner(whole).step([NaN, 0, 0, 0]), InvalidBoxError);
  }
});
