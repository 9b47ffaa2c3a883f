// The benchmark: see `bench/js/run --help`.
import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { parseArgs } from "node:util";
import { libraries, FINDER, WORLD } from "../libraries/index.js";
import { buildNative, buildWasm } from "./build.js";
import { describe } from "./machine.js";
import { Measurement } from "./measure.js";
import { open, put, timesOf, versionOf, write } from "./record.js";
import { writeReport } from "./report.js";
import { Scenes } from "./scenes.js";

/** What is measured unless scenes are named. */
const DEFAULT_SCENES = ["uniform", "clustered", "mixed", "slab", "tower", "box-pruning", "drift", "fast", "mostly-still", "teleport"];

const HELP = `Measures the JavaScript package and its alternatives, and keeps the results in bench/js/results.

  --quick            1,000 and 10,000 boxes, three rounds
  --scenes LIST      names of scenes and motions, or "all" for every one
  --sizes LIST       numbers of boxes (1000,10000,100000)
  --dimensions LIST  2, 3 or both
  --libraries LIST   only the libraries whose names begin with one of these, and sweep-and-prune
  --rounds N         rounds of a case (5)
  --limit SECONDS    a library that takes longer for one call is not timed (1)
  --minutes N        begin no case after this many minutes
  --output FILE      the file of results; those of other boxes in it are kept
  --report           measure nothing; make the table from what was kept
  --no-native        leave out the library compiled for this machine
`;

const { values: flags } = parseArgs({
  options: {
    quick: { type: "boolean" },
    scenes: { type: "string" },
    sizes: { type: "string" },
    dimensions: { type: "string", default: "2,3" },
    libraries: { type: "string", default: "" },
    rounds: { type: "string" },
    limit: { type: "string", default: "1" },
    minutes: { type: "string", default: "Infinity" },
    output: { type: "string" },
    report: { type: "boolean" },
    "no-native": { type: "boolean" },
    help: { type: "boolean" },
  },
});
const list = (/** @type {string | undefined} */ text) => (text ? text.split(",") : []);

if (flags.help) {
  process.stdout.write(HELP);
} else if (flags.report) {
  writeReport();
} else {
  await run();
}

async function run() {
  const wasm = buildWasm();
  const scenes = await Scenes.start(readFileSync(wasm));
  const table = scenes.table();
  const names = flags.scenes === "all" ? table.map(({ name }) => name) : list(flags.scenes);
  const chosen = (names.length > 0 ? names : DEFAULT_SCENES).map((name) => {
    const scene = table.find((scene) => scene.name === name);
    if (!scene) throw new Error(`there is no scene '${name}'`);
    return scene;
  });
  const sizes = list(flags.sizes ?? (flags.quick ? "1000,10000" : "1000,10000,100000")).map(Number);
  const rounds = Number(flags.rounds ?? (flags.quick ? 3 : 5));
  const installed = libraries.filter((one) => one.package === "" || versionOf(one.package));
  const wanted = list(flags.libraries);
  const chosenLibraries = installed.filter(
    ({ name }) => wanted.length === 0 || [FINDER, WORLD].includes(name) || wanted.some((start) => name.startsWith(start)),
  );
  const plan = [];
  for (const boxes of sizes.sort((a, b) => a - b)) {
    for (const scene of chosen) {
      for (const dimensions of list(flags.dimensions).map(Number)) {
        if (scene.dimensions.includes(dimensions)) plan.push({ scene, dimensions, boxes });
      }
    }
  }

  const { kept, file } = open(describe(), flags.output && resolve(flags.output));
  console.log(`${kept.machine.cpu}, ${kept.machine.cores} cores, load ${kept.machine.load}; ${kept.node}`);
  const began = Date.now();
  const seconds = () => (Date.now() - began) / 1000;
  let [done, label] = [0, ""];
  const show = (/** @type {number} */ part) => bar((done + part) / plan.length, seconds(), label);
  const measurement = new Measurement(
    { rounds, limit: 1000 * Number(flags.limit), wasm, native: flags["no-native"] ? undefined : buildNative() },
    show,
  );
  const earlier = [...kept.cases, ...kept.worlds].filter(({ boxes }) => boxes < Math.min(...sizes));
  for (const one of earlier.sort((a, b) => a.boxes - b.boxes)) measurement.learn(one, libraries);
  for (const { scene, dimensions, boxes } of plan) {
    if (seconds() > 60 * Number(flags.minutes)) {
      line(`${plan.length - done} cases were not begun: the time is over`);
      break;
    }
    label = `${scene.name} ${dimensions}D ${boxes.toLocaleString("en")}`;
    show(0);
    const measured = chosenLibraries.filter((one) => one.dimensions.includes(dimensions) && one.tasks.includes(scene.task));
    const result = await measurement.measure(scene, dimensions, boxes, measured);
    done += 1;
    if (typeof result === "string") {
      line(`${label}: left out, ${result}`);
      continue;
    }
    line(summary(label, result));
    put(scene.task === "track" ? kept.worlds : kept.cases, result);
    write(file, kept);
  }
  bar(1, seconds(), "");
  line(`Kept in ${file}`);
  if (!flags.output) writeReport();
}

/** One line on a case. */
function summary(/** @type {string} */ label, /** @type {import("./record.js").Case} */ result) {
  const show = (/** @type {string} */ name) => {
    const times = timesOf(result, name);
    return times ? `${name} ${(times.median_ns / 1e6).toPrecision(3)} ms` : undefined;
  };
  const alternatives = result.results
    .filter((entry) => entry.alternative && "Timed" in entry.outcome)
    .sort((a, b) => /** @type {any} */ (a.outcome).Timed.median_ns - /** @type {any} */ (b.outcome).Timed.median_ns);
  const first = alternatives[0];
  const ratio = first && timesOf(result, first.name)?.ratio;
  const untimed = result.results.flatMap(({ name, outcome }) => ("Untimed" in outcome ? [`${name}: ${outcome.Untimed.why}`] : []));
  const parts = [show(FINDER), show(WORLD), show("native"), first && `${show(first.name)} (${ratio?.toPrecision(3)} times)`, ...untimed];
  return `${label}: ${parts.filter(Boolean).join("; ")}`;
}

/** Prints a line above the bar. */
function line(/** @type {string} */ text) {
  if (process.stdout.isTTY) process.stdout.write("\r\x1b[2K");
  console.log(text);
}

/** Draws the bar, where there is a terminal. */
function bar(/** @type {number} */ part, /** @type {number} */ seconds, /** @type {string} */ label) {
  if (!process.stdout.isTTY) return;
  const width = 30;
  const filled = Math.round(part * width);
  const left = part > 0.02 ? `, ${Math.round((seconds * (1 - part)) / part)} s left` : "";
  process.stdout.write(`\r\x1b[2K[${"#".repeat(filled)}${".".repeat(width - filled)}] ${Math.round(100 * part)}%${left} ${label}`);
}
