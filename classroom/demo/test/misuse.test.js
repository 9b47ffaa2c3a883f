// Every public call of the algorithms, with odd values in the place of each argument, from callbacks that overflow the stack,
// and below the JavaScript around the core.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { before, test } from "node:test";
import { events, init, Player, Runner } from "sweep-and-prune-classroom";
import { misuse } from "../../../js/test/support/misuse.js";

before(() => init());

const rows = new Float32Array([0, 0, 2, 2, 5, 5, 6, 6, 2, 1, 3, 4]);
const options = /** @type {const} */ ({ dimensions: 2 });

test("odd values", () => {
  const good = { ...options, method: "endpoint sweep", sort: "Timsort", axis: 0, persistent: true, focus: 0, traceWords: 10_000 };
  for (const key of Object.keys(good)) misuse(key, (value) => new Runner(/** @type {any} */ ({ ...good, [key]: value })).free(), [0]);
  const runner = /** @type {any} */ (new Runner(/** @type {any} */ (good)));
  runner.step(rows);
  misuse("events", (words) => [...events(words)], [runner.trace()]);
  misuse("new Player", (runner) => new Player(runner).free(), [runner]);
  const player = /** @type {any} */ (new Player(runner));
  for (const name of ["seek", "forward", "backward", "state"]) misuse(name, (...args) => player[name](...args), [0]);
  misuse("step", (boxes) => runner.step(boxes), [rows]);
  assert.deepEqual([...runner.step(rows).pairs], [0, 2]);
  for (const one of [player, runner]) one.free();
  for (const name of ["step", "trace", "clearTrace", "trimTrace"]) assert.throws(() => runner[name](rows), /^TypeError: this Runner was freed/);
  for (const name of ["seek", "state"]) assert.throws(() => player[name](0), /^TypeError: this Player was freed/);
});

test("dimensions cannot be changed from outside, and methods need their object", () => {
  const runner = /** @type {any} */ (new Runner({ ...options, method: "endpoint sweep" }));
  assert.throws(() => (runner.dimensions = 3), TypeError);
  assert.equal(runner.dimensions, 2);
  for (const Type of [Runner]) {
    for (const [name, { value, get }] of Object.entries(Object.getOwnPropertyDescriptors(Type.prototype))) {
      const method = name === "constructor" ? undefined : (value ?? get);
      for (const other of [undefined, {}, 1, Object.create(Type.prototype)]) if (method) assert.throws(() => method.call(other, rows), (error) => error instanceof TypeError || error instanceof RangeError, `${Type.name}.${name}`);
    }
  }
  runner.free();
  runner.free();
});

test("names that the core does not know, and numbers that JavaScript never passes", async () => {
  for (const method of ["strict ties (wrong)", "Endpoint sweep", ""]) assert.throws(() => new Runner(/** @type {any} */ ({ ...options, method })), /^RangeError: there is no method named/);
  const module = await WebAssembly.compile(readFileSync(new URL("../dist/algorithms.wasm", import.meta.url)));
  const instance = await WebAssembly.instantiate(module, { sweep_and_prune: { fail: () => assert.fail(), each: () => 0 } });
  const core = /** @type {any} */ (instance.exports);
  for (const dimensions of [0, 4, -1]) assert.equal(core.runner_new(dimensions, 0), 0);
  const internal = 3;
  assert.equal(core.runner_start(core.runner_new(2, 0), 2), internal);
});

test("a thousand steps whose boxes overflow the stack while they are read: the runner still answers", () => {
  const runner = new Runner({ ...options, method: "endpoint sweep" });
  const overflow = () => {
    overflow();
  };
  const boxes = /** @type {any} */ ([{ minX: 0, minY: 0, maxX: 1, get maxY() { return overflow(), 1; } }]);
  for (let round = 0; round < 1000; round++) assert.throws(() => runner.step(boxes), RangeError);
  assert.deepEqual([...runner.step(rows).pairs], [0, 2]);
  runner.free();
});
