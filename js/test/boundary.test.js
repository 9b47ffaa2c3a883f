// What arguments and callbacks can do to a call: free its object, call it again, recurse until the stack overflows. The
// fuzzer of boundary-fuzz.test.js tries it at random; these are the faults by name.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { before, test } from "node:test";
import { Worker } from "node:worker_threads";
import { findPairs, init, PairFinder } from "sweep-and-prune";
import { BroadPhase, init as initWorlds } from "sweep-and-prune/broad-phase";
import { isOverflow } from "./support/hostile.js";

before(() => Promise.all([init(), initWorlds()]));

/** An object whose every read runs code first. */
const reading = (/** @type {object} */ value, /** @type {() => void} */ run) => new Proxy(value, { get: (target, key) => (run(), Reflect.get(target, key)), has: (target, key) => (run(), Reflect.has(target, key)) });

const unit = [0, 0, 1, 1];

test("an update without stack changes nothing: the next one reports what is new, and nothing twice", () => {
  const world = new BroadPhase({ dimensions: 2 });
  const [a = 0, b = 0] = world.insertMany([...unit, ...unit]);
  assert.deepEqual([...world.update().begun], [a, b]);
  world.set(b, 5, 5, 6, 6);
  let isTried = false;
  const deep = () => {
    try {
      deep();
    } catch (error) {
      if (isTried) throw error;
      isTried = true;
      world.update();
    }
  };
  assert.throws(deep, isOverflow);
  const { begun, ended } = world.update();
  assert.deepEqual([[...begun], [...ended]], [[], [a, b]]);
  world.free();
});

test("an argument that frees the world while it is read", () => {
  /** @type {Record<string, (world: any, id: number, evil: (value: object) => any) => unknown>} */
  const calls = {
    insert: (world, _, evil) => world.insert(evil(unit)),
    "insert, options": (world, _, evil) => world.insert(unit, evil({ data: 1 })),
    "insertMany, data": (world, _, evil) => world.insertMany([unit], {}, evil([1])),
    boxes: (world, id, evil) => world.boxes(evil([id])),
    insertMany: (world, _, evil) => world.insertMany(evil(unit)),
    "insertMany, filter": (world, _, evil) => world.insertMany(unit, evil({})),
    set: (world, id, evil) => world.set(id, evil(unit)),
    setMany: (world, id, evil) => world.setMany(evil([id]), unit),
    "setMany, boxes": (world, id, evil) => world.setMany([id], evil(unit)),
    teleport: (world, id, evil) => world.teleport(id, evil(unit)),
    shift: (world, _, evil) => world.shift(evil([1, 0])),
    setSwept: (world, id, evil) => world.setSwept(id, evil(unit), unit),
    "setSwept, to": (world, id, evil) => world.setSwept(id, unit, evil({ minX: 0, minY: 0, maxX: 1, maxY: 1 })),
    setFilter: (world, id, evil) => world.setFilter(id, evil({})),
    removeMany: (world, id, evil) => world.removeMany(evil([id])),
    pairs: (world, _, evil) => world.pairs(evil({})),
    overlapping: (world, _, evil) => world.overlapping(evil(unit)),
    "overlapping, filter": (world, _, evil) => world.overlapping(unit, evil({ category: 1 })),
    "overlapping, options": (world, _, evil) => world.overlapping(unit, {}, evil({})),
    containing: (world, _, evil) => world.containing(evil({ x: 0, y: 0 })),
    within: (world, _, evil) => world.within([0, 0], 1, evil({})),
    rayCast: (world, _, evil) => world.rayCast([0, 0], evil([1, 0])),
    "boxCastAll, filter": (world, _, evil) => world.boxCastAll(unit, [1, 0], 9, evil({})),
    overlappingMany: (world, _, evil) => world.overlappingMany(evil([unit])),
    "containingMany, filter": (world, _, evil) => world.containingMany([0, 0], evil({})),
    "withinMany, radii": (world, _, evil) => world.withinMany([0, 0], evil([1])),
    "nearestMany, options": (world, _, evil) => world.nearestMany([0, 0], 1, 9, {}, evil({})),
    "rayCastMany, directions": (world, _, evil) => world.rayCastMany([0, 0], evil([1, 0])),
    "boxCastMany, exclude": (world, _, evil) => world.boxCastMany(unit, [1, 0], 1, {}, { exclude: evil([1]) }),
    nearest: (world, _, evil) => world.nearest([0, 0], 1, 9, evil({})),
  };
  for (let round = 0; round < 20; round++) {
    for (const [name, call] of Object.entries(calls)) {
      const world = new BroadPhase({ dimensions: 2 });
      const id = world.insert(0, 0, 1, 1);
      /** @type {BroadPhase[]} */
      const others = [];
      // Another world may lie where this one was.
      const evil = (/** @type {object} */ value) => reading(value, () => (world.free(), others.push(new BroadPhase({ dimensions: 2 }))));
      assert.throws(() => call(world, id, evil), /^TypeError: this BroadPhase was freed/, name);
      for (const other of others) {
        assert.equal(other.size, 0, name);
        other.free();
      }
    }
  }
});

test("an argument that calls the world while it is read", () => {
  const world = new BroadPhase({ dimensions: 2 });
  const [a, b] = [world.insert(0, 0, 1, 1), world.insert(10, 10, 11, 11)];
  const ask = () => void world.overlapping([10, 10, 11, 11]);
  assert.deepEqual([...world.overlapping([0, 0, 1, 1], { get mask() { return ask(), ~0; } })], [a]);
  assert.equal(world.boxCast([-3, 0, -2, 1], [1, 0], 9, { get mask() { return ask(), ~0; } })?.id, a);
  assert.equal(world.rayCast([-3, 0.5], /** @type {any} */ (reading([1, 0], ask)), 9)?.id, a);
  world.setSwept(a, [0, 0, 1, 1], /** @type {any} */ (reading([2, 0, 3, 1], ask)));
  assert.deepEqual(world.box(a), [0, 0, 3, 1]);
  world.set(a, /** @type {any} */ (reading({ minX: 4, minY: 0, maxX: 5, maxY: 1 }, ask)));
  assert.deepEqual(world.box(a), [4, 0, 5, 1]);
  world.setMany(/** @type {any} */ (reading([a], () => world.set(b, 7, 7, 8, 8))), /** @type {any} */ (reading([6, 0, 7, 1], () => world.setMany([b], [9, 9, 9, 9]))));
  assert.deepEqual([...world.box(a), ...world.box(b)], [6, 0, 7, 1, 9, 9, 9, 9]);
  world.free();
});

test("`isStatic` is true or false, and the core checks every kind, dimension and truth value that it gets", async () => {
  const world = new BroadPhase({ dimensions: 2 });
  const ids = world.insertMany([...unit, ...unit]);
  for (const isStatic of /** @type {any[]} */ ([2, 1, 0, -1, "true", "", null, {}, [], new Boolean(true)])) {
    assert.throws(() => world.setFilter(ids[0] ?? NaN, { isStatic }), /^TypeError: `isStatic` of the filter must be true or false/);
    assert.throws(() => world.insertMany(unit, { isStatic }), /^TypeError: `isStatic`/);
    assert.throws(() => world.overlapping(/** @type {any} */ (unit), { isStatic }), /^TypeError: `isStatic`/);
  }
  assert.equal(BroadPhase.fromSnapshot(world.snapshot(), { dimensions: 2 }).stateHash(), world.stateHash());
  world.free();

  const internal = 3;
  const core = await started("broad-phase");
  for (const numbers of [[0, 0], [4, 0], [2 ** 31, 0], [2, 2], [2, -1]]) assert.equal(core.world_new(...numbers, 0, 0, 0), 0, String(numbers));
  for (const isFat of [2, -1]) assert.equal(core.world_new(2, 0, 0, 0, isFat), 0);
  const handle = core.world_new(2, 0, 0, 0, 0);
  core.world_rows(handle, 1);
  for (const isStatic of [2, -1, 256]) {
    assert.equal(core.world_insert_many(handle, 1, 1, 1, 0, isStatic), internal);
    assert.equal(core.world_set_filter(handle, 0, 1, 1, 0, isStatic), internal);
  }
  for (const [query, isStatic, isSorted] of [[8, 0, 1], [-1, 0, 1], [0, 3, 1], [0, -1, 1], [0, 0, 2]]) {
    assert.equal(core.world_query(handle, query, 0, 1, 1, 0, isStatic, isSorted, 0), internal, String([query, isStatic, isSorted]));
  }
  assert.equal(core.world_pairs(handle, 2), internal);
  // More than was written is what was written.
  for (const call of ["world_set_many", "world_remove_many"]) assert.equal(core[call](handle, 2 ** 31), 0);
  assert.equal(core.world_len(handle), 0);

  const finder = await started("sweep-and-prune");
  for (const [dimensions, isDouble] of [[1, 0], [4, 0], [2, 1], [3, 2], [3, -1]]) assert.equal(finder.finder_new(dimensions, isDouble), 0);
});

test("a thousand callbacks that overflow the stack: finders and worlds still answer", () => {
  const boxes = [0, 0, 2, 2, 5, 5, 6, 6, 2, 1, 3, 4];
  const finder = new PairFinder({ dimensions: 2 });
  const world = new BroadPhase({ dimensions: 2 });
  const ids = world.insertMany(boxes);
  world.update();
  const overflow = () => {
    overflow();
  };
  const deep = () => {
    const inner = new PairFinder({ dimensions: 2 });
    try {
      inner.forEach(boxes, deep);
    } finally {
      inner.free();
    }
  };
  let interrupted = 0;
  for (let round = 0; round < 1000; round++) {
    // Often it overflows within the core, whose stack pointer is then left where it was.
    const lost = new BroadPhase({ dimensions: 2 });
    lost.insertMany(boxes);
    /** @type {() => void} */
    const dive = () => {
      lost.overlapping([0, 0, 1, 1]);
      dive();
    };
    assert.throws(() => finder.forEach(boxes, dive), isRecursion);
    try {
      lost.update();
    } catch (/** @type {any} */ error) {
      assert.equal(error.name, "InterruptedError");
      interrupted++;
    }
    lost.free();
    assert.throws(() => finder.forEach(boxes, round % 200 === 0 ? deep : overflow), isRecursion);
    assert.throws(() => world.overlapping(/** @type {any} */ (unit), /** @type {any} */ (overflow)), isRecursion);
    assert.throws(() => world.overlapping(/** @type {any} */ (unit), { get mask() { return overflow(), 1; } }), isRecursion);
  }
  assert.deepEqual([...finder.find(boxes)], [0, 2]);
  assert.deepEqual([...findPairs(boxes, { dimensions: 2 })], [0, 2]);
  assert.deepEqual([...world.overlapping([0, 0, 1, 1])], [ids[0]]);
  assert.deepEqual([...world.pairs()], [ids[0], ids[2]]);
  assert.ok(interrupted > 0, "no call overflowed within the core");
  for (const one of [finder, world]) one.free();
});

/** The error of the engine, or that of streamPairs where searches within callbacks leave no stack for another one. */
function isRecursion(/** @type {unknown} */ error) {
  return isOverflow(error) || (error instanceof RangeError && /too much recursion/.test(error.message));
}

test("a call with too little stack changes nothing, or its world says that it is lost", () => {
  const next = 0.7;
  const boxes = Float32Array.from({ length: 4 * 200 }, (_, at) => ((at * next) % 10) + (at % 4 > 1 ? 10 : 0));
  /** @type {(depth: number, call: () => unknown) => unknown} */
  const dive = (depth, call) => {
    if (depth === 0) return call();
    const result = dive(depth - 1, call);
    return result;
  };
  const start = () => {
    const world = new BroadPhase({ dimensions: 2 });
    const ids = world.insertMany(boxes.subarray(0, 400));
    world.update();
    world.setMany(ids, boxes.subarray(400));
    const calls = [
      () => world.update(),
      () => world.insert(0, 0, 1, 1),
      () => world.remove(ids[3] ?? NaN),
      () => world.overlapping([0, 0, 5, 5]),
      () => world.insertMany(boxes),
      () => world.stateHash(),
      () => world.pairs(),
    ];
    return { world, calls };
  };
  let [made, refused] = [0, 0];
  /** Whether a call is made that deep on the stack; if not, nothing has changed, or the world says that it is lost. */
  const isMade = (/** @type {number} */ depth, which = 0) => {
    const { world, calls } = start();
    const before = world.stateHash();
    try {
      dive(depth, calls[which] ?? start);
      made++;
      return true;
    } catch (error) {
      assert.ok(isOverflow(error), String(error));
      refused++;
      try {
        assert.equal(world.stateHash(), before);
      } catch (/** @type {any} */ interrupted) {
        assert.equal(interrupted.name, "InterruptedError");
        assert.throws(() => world.update(), { name: "InterruptedError" });
      }
      return false;
    } finally {
      world.free();
    }
  };
  // First until the engine has compiled everything: from then on its frames stay as they are.
  for (let round = 0; round < 3000; round++) isMade(50, round % 7);
  let deepest = 1;
  while (isMade(2 * deepest)) deepest *= 2;
  for (let step = deepest / 2; step >= 1; step /= 2) if (isMade(deepest + step)) deepest += step;
  made = refused = 0;
  for (let depth = deepest + 200; depth > deepest - 200; depth--) isMade(depth, depth % 7);
  assert.ok(made > 10 && refused > 10, `${made} calls were made, ${refused} refused`);
});

test("a world whose call ended halfway says so, and others go on", async () => {
  const worker = new Worker(new URL("./support/interrupted.js", import.meta.url));
  /** @type {[unknown, (name: "message" | "error", use: (value: any) => void) => void]} */
  const result = await new Promise((resolve, reject) => worker.once("message", resolve).once("error", reject));
  assert.deepEqual(result, {
    update: "RangeError: Maximum call stack size exceeded",
    later: Array(8).fill("InterruptedError"),
    free: "none",
    afterwards: "TypeError: this BroadPhase was freed",
    isStackBack: true,
    other: 1,
    finder: ["RangeError: Maximum call stack size exceeded", "InterruptedError", "0,2"],
  });
});

test("typed arrays that lie, change, shrink or are detached while other arguments are read", () => {
  const finder = /** @type {any} */ (new PairFinder({ dimensions: 2 }));
  const rows = () => new Float64Array([...unit, 0.5, 0.5, 2, 2]);
  const lying = rows();
  for (const key of ["length", "buffer", "byteOffset", "byteLength", "constructor", Symbol.toStringTag, Symbol.iterator]) {
    Object.defineProperty(lying, key, { get: () => (key === "length" ? 4000 : undefined) });
  }
  assert.deepEqual([...finder.find(lying)], [0, 1]);
  const then = (/** @type {() => void} */ run) => [reading({ minX: 0, minY: 0, maxX: 1, maxY: 1 }, run)];
  const moved = rows();
  assert.throws(() => finder.findBetween(moved, then(() => moved.buffer.byteLength && structuredClone(moved, { transfer: [moved.buffer] }))), /^TypeError: the buffer of a is detached/);
  const Resizable = /** @type {any} */ (ArrayBuffer);
  const shrunk = new Resizable(64, { maxByteLength: 64 });
  assert.throws(() => finder.findBetween(new Float64Array(shrunk), then(() => shrunk.resize(40))), /^RangeError: a holds 5 numbers/);
  shrunk.resize(64);
  new Float64Array(shrunk).set(rows());
  assert.deepEqual([...finder.findBetween(new Float64Array(shrunk), then(() => shrunk.resize(32)))], [0, 0]);
  const shared = new SharedArrayBuffer(64);
  new Float64Array(shared).set(rows());
  assert.deepEqual([...finder.find(new Float64Array(shared))], [0, 1]);
  for (const call of ["find", "count", "any"]) assert.throws(() => finder[call](new Proxy(rows(), {})), /^TypeError: `boxes` must be a typed array/);
  const world = /** @type {any} */ (new BroadPhase({ dimensions: 2 }));
  const ids = world.insertMany(rows());
  const detached = rows();
  assert.throws(() => world.setMany(reading([...ids], () => detached.length && structuredClone(detached, { transfer: [detached.buffer] })), detached), /^TypeError: the buffer of boxes is detached/);
  assert.deepEqual(world.box(ids[0]), unit);
  for (const one of [finder, world]) one.free();
});

test("how boxes are stored cannot be changed from outside, and methods need their object", () => {
  const finder = /** @type {any} */ (new PairFinder({ dimensions: 2 }));
  const world = /** @type {any} */ (new BroadPhase({ dimensions: 2 }));
  for (const one of [finder, world]) {
    assert.throws(() => (one.dimensions = 3), TypeError);
    assert.equal(one.dimensions, 2);
  }
  for (const Type of [PairFinder, BroadPhase]) {
    for (const [name, { value, get }] of Object.entries(Object.getOwnPropertyDescriptors(Type.prototype))) {
      const method = name === "constructor" ? undefined : (value ?? get);
      for (const other of [undefined, {}, 1, Object.create(Type.prototype)]) if (method) assert.throws(() => method.call(other, unit, unit), (error) => error instanceof TypeError || error instanceof RangeError, `${Type.name}.${name}`);
    }
  }
  for (const one of [finder, world]) {
    one.free();
    one.free();
  }
});

/** The exports of a core that has no JavaScript around it. */
async function started(/** @type {string} */ name) {
  const module = await WebAssembly.compile(readFileSync(new URL(`../dist/${name}.wasm`, import.meta.url)));
  const instance = await WebAssembly.instantiate(module, { sweep_and_prune: { fail: () => assert.fail(), each: () => 0 } });
  return /** @type {any} */ (instance.exports);
}

test("searches take less of Rust's own stack than what is kept for them", async () => {
  const core = await started("sweep-and-prune");
  const top = core.__stack_pointer.value;
  const random = (() => { let state = 1; return () => (state = (state * 48271) % 2147483647) / 2147483647; })();
  for (const spread of [1, 100, 10_000]) {
    const count = 20_000;
    const finder = core.finder_new(3, 1);
    for (const set of [0, 1]) {
      const at = core.finder_rows(finder, set, count) >>> 0;
      const rows = new Float64Array(core.memory.buffer, at, 6 * count);
      for (let at = 0; at < rows.length; at += 6) {
        const size = random() ** 8 * 10;
        for (let axis = 0; axis < 3; axis++) {
          rows[at + axis] = spread * random() ** 3;
          rows[at + axis + 3] = (rows[at + axis] ?? 0) + size / 10;
        }
      }
    }
    for (const second of [-1, count / 10]) {
      const stack = new Uint8Array(core.memory.buffer, 0, top);
      stack.fill(0xa5);
      assert.equal(core.finder_find(finder, count / (spread === 1 ? 50 : 1), second, 0), 0);
      const used = top - new Uint8Array(core.memory.buffer, 0, top).findIndex((byte) => byte !== 0xa5);
      assert.ok(used > 100 && used < 64 * 1024, `${used} bytes of the stack were used`);
    }
    core.finder_free(finder);
  }
});
