// A worker in which calls of the core end halfway, as they do where the engine's stack runs out within them: the exports
// are replaced before the package is imported.
import { parentPort } from "node:worker_threads";

const { instantiate } = WebAssembly;
let isInterrupted = false;
/** @type {any} */
let stack;

/** @type {any} */ (WebAssembly).instantiate = async (/** @type {any} */ module, /** @type {any} */ imports) => {
  const { exports } = /** @type {any} */ (await instantiate(module, imports));
  const replaced = { ...exports };
  for (const name of ["world_update", "finder_find"]) {
    if (!(name in exports)) continue;
    stack = exports.__stack_pointer;
    replaced[name] = (/** @type {number} */ handle, /** @type {number[]} */ ...more) => {
      if (!isInterrupted) return exports[name](handle, ...more);
      isInterrupted = false;
      new Uint32Array(exports.memory.buffer)[handle / 4] = 1;
      exports.__stack_pointer.value -= 4096;
      throw new RangeError("Maximum call stack size exceeded");
    };
  }
  return { exports: replaced };
};

const { init, PairFinder } = await import("sweep-and-prune");
const { BroadPhase, init: initWorlds } = await import("sweep-and-prune/broad-phase");

const outcome = (/** @type {() => unknown} */ call) => {
  try {
    call();
    return "none";
  } catch (error) {
    return error;
  }
};

await init();
const finder = new PairFinder({ dimensions: 2 });
const boxes = [0, 0, 2, 2, 5, 5, 6, 6, 2, 1, 3, 4];
isInterrupted = true;
const found = [String(outcome(() => finder.find(boxes))), /** @type {any} */ (outcome(() => finder.find(boxes))).name, String(finder.find(boxes))];

await initWorlds();
const top = stack.value;
const world = new BroadPhase({ dimensions: 2 });
const id = world.insert(0, 0, 1, 1);
const other = new BroadPhase({ dimensions: 2 });
isInterrupted = true;
const update = String(outcome(() => world.update()));
const calls = [() => world.update(), () => world.insert(0, 0, 1, 1), () => world.set(id, [0, 0, 1, 1]), () => world.pairs(), () => world.size, () => world.snapshot(), () => world.overlapping([0, 0, 1, 1]), () => world.buffers(1)];
const later = calls.map((call) => /** @type {any} */ (outcome(call)).name);
other.insert(0, 0, 1, 1);
const isStackBack = stack.value === top;
const free = outcome(() => world.free());
const afterwards = String(outcome(() => world.update()));
parentPort?.postMessage({ update, later, free, afterwards, isStackBack, other: other.size, finder: found });
