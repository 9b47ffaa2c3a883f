// Makes RESULTS.md from the newest results that were kept.
import { writeFileSync } from "node:fs";
import { FINDER, PLAIN, WORLD } from "../libraries/index.js";
import { NATIVE, NATIVE_WORLD } from "./measure.js";
import { all, timesOf } from "./record.js";

/**
 * @typedef {import("./record.js").Case} Case
 * @typedef {import("./record.js").Kept} Kept
 */

export function writeReport() {
  const [newest] = all();
  if (!newest) return;
  writeFileSync(new URL("../RESULTS.md", import.meta.url), report(newest));
}

/** @returns {string} */
function report(/** @type {Kept} */ kept) {
  const { machine } = kept;
  const cases = [...kept.cases, ...kept.worlds];
  const loads = cases.map((one) => one.load ?? 0);
  const revisions = [...new Set(cases.flatMap((one) => one.revision ?? []))].sort();
  return `# The JavaScript package and its alternatives

<!-- Made by bench/js/run from bench/js/results: change those, not this. -->

${kept.date}, ${machine.cpu}, ${machine.cores} cores, ${kept.node}, measured at ${revisions.join(", ")}. ${loadText(loads)}
Times are in milliseconds, from a \`Float32Array\` of boxes to stored pairs, everything included; lower is better. A
time is the median over the rounds. A ratio is the median over the rounds of how many times as long as sweep-and-prune a
library takes. The pairs of each library were checked first: those of four scenes of a kind, or of four frames, or of the
one large scene; of native code, how many there are.

## Finding all pairs

${table(kept.cases, [FINDER])}

${untimedTable(kept.cases)}

## Moving boxes

The time of a frame: from the moved boxes to their pairs, or to the pairs that began and ended. Ratios are to the faster of
the two columns of sweep-and-prune.

${table(kept.worlds, [FINDER, WORLD])}

${untimedTable(kept.worlds)}

## WebAssembly against native

The same calls of the same library on the same boxes, compiled for this machine (without threads).

${nativeTable(kept)}

## The libraries, and how each is called

| | version | what is called |
|---|---|---|
${Object.entries(kept.how)
  .map(([name, how]) => `| ${name} | ${kept.versions[name] ?? ""} | ${how} |`)
  .join("\n")}
`;
}

function loadText(/** @type {number[]} */ loads) {
  const [least, greatest] = [Math.min(...loads), Math.max(...loads)];
  const range = `load average ${least.toFixed(1)} to ${greatest.toFixed(1)}`;
  return greatest > 2.5
    ? `**Provisional: other programs were running (${range}); time spent waiting for a processor is not counted.**`
    : `The machine was otherwise idle (${range}, of which measuring itself makes 1 to 2).`;
}

const order = ["uniform", "clustered", "mixed", "slab", "tower", "box-pruning", "drift", "fast", "mostly-still", "teleport"];
const place = (/** @type {Case} */ one) => (order.indexOf(one.scene) + 1 || order.length + 1) * 1e9;

const byScene = (/** @type {Case} */ a, /** @type {Case} */ b) =>
  place(a) - place(b) || a.scene.localeCompare(b.scene) || a.dimensions - b.dimensions || a.boxes - b.boxes;

/** The times of the faster of these settings of sweep-and-prune. */
function best(/** @type {Case} */ one, /** @type {readonly string[]} */ own) {
  const times = own.flatMap((name) => timesOf(one, name) ?? []);
  return times.sort((a, b) => a.median_ns - b.median_ns)[0];
}

/**
 * Many a round's time is another's multiple: the median of the ratios, where both took part.
 *
 * @param {import("./record.js").Times} one
 * @param {import("./record.js").Times} own
 */
export function ratio(one, own) {
  const ratios = one.rounds_ns.flatMap((time, at) => (own.rounds_ns[at] ? [time / own.rounds_ns[at]] : []));
  ratios.sort((a, b) => a - b);
  return ratios[ratios.length >> 1] ?? NaN;
}

/**
 * The alternatives that were timed, the fastest first, without the plain sweep.
 *
 * @param {Case} one
 */
function alternativesOf(one) {
  const alternatives = one.results.filter((entry) => entry.alternative && entry.name !== PLAIN && "Timed" in entry.outcome);
  const found = alternatives.map(({ name }) => ({ name, times: /** @type {import("./record.js").Times} */ (timesOf(one, name)) }));
  return found.sort((a, b) => a.times.median_ns - b.times.median_ns);
}

/** What the package promises: at least this many times faster than the fastest alternative. */
const goal = (/** @type {number} */ boxes) => (boxes >= 10_000 ? 10 : 3);
/** And than the plain sweep. */
const PLAIN_GOAL = 1.5;

function table(/** @type {Case[]} */ cases, /** @type {readonly string[]} */ own) {
  const head = ["scene", "boxes", "pairs", ...own, "fastest alternative", "ratio", "next", "plain sweep", "ratio"];
  const rows = [...cases].sort(byScene).flatMap((one) => {
    const mine = best(one, own);
    if (!mine) return [];
    const [first, second] = alternativesOf(one);
    const plain = timesOf(one, PLAIN);
    const mark = (/** @type {number} */ is, /** @type {number} */ wanted) => `${figure(is)}${is < wanted ? " (goal " + wanted + ")" : ""}`;
    return [
      [
        `${one.scene} ${one.dimensions}D`,
        one.boxes.toLocaleString("en"),
        Math.round(one.pairs).toLocaleString("en"),
        ...own.map((name) => ms(timesOf(one, name))),
        first ? `${first.name} ${ms(first.times)}` : "",
        first ? mark(ratio(first.times, mine), goal(one.boxes)) : "",
        second ? `${second.name} ${ms(second.times)}` : "",
        ms(plain),
        plain ? mark(ratio(plain, mine), PLAIN_GOAL) : untimed(one, PLAIN),
      ],
    ];
  });
  return markdown(head, rows);
}

function nativeTable(/** @type {Kept} */ kept) {
  const rows = [...kept.cases, ...kept.worlds].sort(byScene).flatMap((one) =>
    [
      [FINDER, NATIVE],
      [WORLD, NATIVE_WORLD],
    ].flatMap(([name = "", native = ""]) => {
      const [wasm, compiled] = [timesOf(one, name), timesOf(one, native)];
      if (!wasm || !compiled) return [];
      const what = name === WORLD ? "`BroadPhase`" : "`PairFinder`";
      return [[`${one.scene} ${one.dimensions}D`, one.boxes.toLocaleString("en"), what, ms(wasm), ms(compiled), figure(ratio(wasm, compiled))]];
    }),
  );
  return markdown(["scene", "boxes", "", "WebAssembly", "native", "ratio"], rows);
}

/** The libraries that were not timed, and why: a line for each reason. */
function untimedTable(/** @type {Case[]} */ cases) {
  const rows = [...cases].sort(byScene).flatMap((one) => {
    /** @type {Map<string, string[]>} */
    const names = new Map();
    for (const { name, outcome } of one.results) {
      if ("Untimed" in outcome) names.set(outcome.Untimed.why, [...(names.get(outcome.Untimed.why) ?? []), name]);
    }
    return [...names].map(([why, of]) => [`${one.scene} ${one.dimensions}D`, one.boxes.toLocaleString("en"), of.join(", "), why]);
  });
  if (rows.length === 0) return "Every library was timed on every scene.";
  return `<details><summary>Not timed, and why</summary>\n\n${markdown(["scene", "boxes", "libraries", "why"], rows)}\n\n</details>`;
}

function untimed(/** @type {Case} */ one, /** @type {string} */ name) {
  const outcome = one.results.find((entry) => entry.name === name)?.outcome;
  return outcome && "Untimed" in outcome ? outcome.Untimed.why : "";
}

const figure = (/** @type {number} */ number) => (number >= 100 ? number.toFixed(0) : number.toPrecision(number >= 10 ? 3 : 2));

function ms(/** @type {import("./record.js").Times | undefined} */ times) {
  return times ? figure(times.median_ns / 1e6) : "";
}

function markdown(/** @type {readonly string[]} */ head, /** @type {readonly (readonly string[])[]} */ rows) {
  const line = (/** @type {readonly string[]} */ cells) => `| ${cells.join(" | ")} |`;
  return [line(head), line(head.map((_, at) => (at === 0 ? "---" : "---:"))), ...rows.map(line)].join("\n");
}
