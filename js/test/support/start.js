// A worker that starts the package with the options it is given, finds pairs, and posts them: a
// module can be started only once, so each way to start needs a thread of its own.
import { parentPort, workerData } from "node:worker_threads";
import { boxesAmong, boxesSpread, random } from "./boxes.js";

const { entry, options } = workerData;
/** @type {typeof import("sweep-and-prune")} */
const { findPairs, init } = await import(entry);
const { simd } = await init(options);
const next = random(9);
const results = /** @type {const} */ ([1, 2, 3]).flatMap((dimensions) =>
  [Float32Array, Float64Array].flatMap((Rows) => [
    findPairs(Rows.from(boxesSpread(next, 5000, dimensions)), { dimensions }),
    ...Array.from({ length: 100 }, () =>
      findPairs(Rows.from(boxesAmong(next, Math.floor(next() * 60), dimensions)), { dimensions }),
    ),
  ]),
);
parentPort?.postMessage({ simd, results });
