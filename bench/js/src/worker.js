// One library on one scene in a process of its own:
//
//     node worker.js LIBRARY SCENE DIMENSIONS BOXES
//
// It reads a request a line, `check`, `warm-up` or `time REPEATS BATCH`, and answers each with a line of JSON that
// begins with a mark: a library may print what it likes on others.
import { readFileSync, writeFileSync } from "node:fs";
import { createInterface } from "node:readline";
import { libraries } from "../libraries/index.js";
import { load } from "../libraries/load.js";
import { library as bruteForce } from "./reference.js";
import { Scenes } from "./scenes.js";
import { Trial } from "./trial.js";
import { MARK } from "./remote.js";

const [name, sceneName, dimensions, boxes] = process.argv.slice(2);

/** How long this thread has waited for a processor, because other programs had them all; milliseconds. */
function waited() {
  try {
    return Number(readFileSync("/proc/self/schedstat", "utf8").split(" ")[1]) / 1e6;
  } catch {
    return 0; // the system does not tell
  }
}

/** Counts the milliseconds but those in which other programs had the processors. */
const clock = {
  start() {
    const waitedBefore = waited();
    return { waitedBefore, began: performance.now() };
  },
  since(/** @type {{ waitedBefore: number, began: number }} */ { waitedBefore, began }) {
    const passed = performance.now() - began;
    return Math.max(0, passed - (waited() - waitedBefore));
  },
};

/** Bytes, from Linux's account of this process. */
function memory(/** @type {string} */ field) {
  try {
    const line = readFileSync("/proc/self/status", "utf8").match(new RegExp(`^${field}:\\s*(\\d+) kB`, "m"));
    return line ? 1024 * Number(line[1]) : null;
  } catch {
    return null;
  }
}

function resetPeak() {
  try {
    writeFileSync("/proc/self/clear_refs", "5");
  } catch {
    // Then it is the peak since the start.
  }
}

const answer = (/** @type {object} */ reply) => process.stdout.write(`\n${MARK}${JSON.stringify(reply)}\n`);
process.on("uncaughtException", (error) => {
  answer({ failed: String(error?.message ?? error) });
  process.exit(1);
});

const scenes = await Scenes.start(readFileSync(process.env.SCENES_WASM ?? ""));
const scene = scenes.open(sceneName ?? "", Number(dimensions), Number(boxes));
const entry = [...libraries, bruteForce].find((one) => one.name === name);
if (!entry) throw new Error(`there is no library '${name}'`);
const module = await load(entry);
resetPeak();
const before = memory("VmRSS");
const trial = await Trial.start(scene, Number(dimensions), module, clock);
answer({ ready: true });
for await (const line of createInterface({ input: process.stdin })) {
  const [request, repeats, batch] = line.split(" ");
  if (request === "check") {
    const checked = trial.check();
    const peak = memory("VmHWM");
    answer({ ...checked, peak_bytes: peak !== null && before !== null ? Math.max(0, peak - before) : null });
  } else if (request === "warm-up") {
    trial.warmUp();
    answer({ ready: true });
  } else {
    answer({ ms: trial.time(Number(repeats), Number(batch)) });
  }
}
