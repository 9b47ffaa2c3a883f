// The figures of the READMEs are those of the results: of bench/RESULTS.md and bench/js/RESULTS.md, which are made
// from the recorded runs. A claim that no document makes is skipped; its pattern says how it has to be written.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

const root = dirname(dirname(fileURLToPath(import.meta.url)));
const read = (path) => readFileSync(join(root, path), "utf8");
const DOCUMENTS = ["README.md", "core/README.md", "js/README.md", "python/README.md", "CHANGELOG.md"];

/** The rows of the table under a heading, as lists of cells. */
function table(text, heading) {
  const section = text.split(/^#+ /m).find((it) => it.startsWith(heading));
  assert.ok(section, `the results have no section "${heading}"`);
  const rows = section.split("\n").filter((line) => line.startsWith("|"));
  return rows.slice(2).map((row) => row.split("|").slice(1, -1).map((cell) => cell.trim()));
}

const rust = read("bench/RESULTS.md");
const javascript = read("bench/js/RESULTS.md");

const uniform = new Map(
  table(rust, "Against the fastest alternative")
    .filter(([scene]) => scene === "uniform 3D")
    .map(([, boxes, , own, fastest]) => [boxes, { own, fastest }]),
);
const means = new Map(table(rust, "How many times slower").map(([boxes, , mean, , least]) => [boxes, { mean, least }]));
const open = new Set(table(rust, "Against the fastest alternative").map(([scene]) => scene));
const gains = table(rust, "Two threads")
  .filter(([scene, boxes]) => open.has(scene) && boxes === "100,000")
  .map((row) => Number(row[4]));
const classic = table(rust, "The classic scene").map((row) => row[2]);
const ratios = (heading, size) =>
  table(javascript, heading)
    .filter((row) => row[1] === size)
    .flatMap((row) => row.slice(4).find((cell) => /^\d[\d.]*$/.test(cell)) ?? [])
    .map(Number);

/** Whether a figure as written is `exact`, rounded to as many digits as it has. */
function isRounded(written, exact) {
  const number = Number(written.replaceAll(",", ""));
  const digits = /\.(\d+)/.exec(written)?.[1].length ?? 0;
  return Math.abs(number - Number(String(exact).replaceAll(",", ""))) <= 0.5000001 * 10 ** -digits;
}

/** "35.6 µs (note)" with the number of the results: units have to agree too. */
function isTime(written, exact) {
  const [, number, unit] = /^([\d.,]+) (ns|µs|ms|s)\b/.exec(written) ?? [];
  const [, exactNumber, exactUnit] = /([\d.,]+) (ns|µs|ms|s)\b/.exec(exact);
  return unit === exactUnit && isRounded(number, exactNumber);
}

/** How a claim is written, and whether what it says is right. */
const CLAIMS = [
  {
    name: "a row with the time of uniform 3D, the fastest alternative and the geometric mean",
    pattern: /^\| ([\d,]+) \| ([\d.]+ [nµm]?s) \| ([\d.]+ [nµm]?s) \(([^)]+)\) \| ([\d.]+) times faster \|/gm,
    check: ([, boxes, own, time, name, mean]) =>
      isTime(own, uniform.get(boxes).own) &&
      isTime(time, uniform.get(boxes).fastest) &&
      uniform.get(boxes).fastest.startsWith(`${name} `) &&
      isRounded(mean, means.get(boxes).mean),
  },
  {
    name: "the geometric means in prose",
    pattern: /([\d.]+) times as long at 1,000 boxes, ([\d.]+) times at 10,000, ([\d.]+) times at 100,000 and ([\d.]+) times at 1,000,000/g,
    check: ([, ...written]) =>
      ["1,000", "10,000", "100,000", "1,000,000"].every((boxes, at) => isRounded(written[at], means.get(boxes).mean)),
  },
  {
    name: "the closest alternative of all scenes",
    pattern: /(?:the closest takes|the nearest is) ([\d.]+) times/g,
    check: ([, written]) => isRounded(written, Math.min(...[...means.values()].map(({ least }) => Number(least)))),
  },
  {
    name: "what two threads gain at 100,000 boxes, on the scenes that every library is measured on",
    pattern: /two threads (?:gain|are) ([\d.]+) to ([\d.]+) times(?: faster than one at 100,000 boxes)?/gi,
    check: ([, least, most]) => isRounded(least, Math.min(...gains)) && isRounded(most, Math.max(...gains)),
  },
  {
    name: "the classic scene",
    pattern: /([\d,]+) and ([\d,]+) thousand cycles/g,
    check: ([, few, many]) => isRounded(few, classic[0]) && isRounded(many, classic[1]),
  },
  {
    name: "JavaScript: the range of ratios to find pairs at 10,000 boxes",
    pattern: /fastest (?:other package|alternative) takes (?:from )?([\d.]+) to ([\d.]+) times as long(?:, by scene| to find (?:all )?pairs)/g,
    check: ([, least, most]) => {
      const all = ratios("Finding all pairs", "10,000");
      return isRounded(least, Math.min(...all)) && isRounded(most, Math.max(...all));
    },
  },
];

const texts = DOCUMENTS.map((path) => [path, read(path).replace(/\n(?![\n|])/g, (line) => line)]);

for (const { name, pattern, check } of CLAIMS) {
  const found = texts.flatMap(([path, text]) => {
    // Prose runs over the ends of lines; rows of tables do not.
    const whole = pattern.flags.includes("m") ? text : text.replace(/\s+/g, " ");
    return [...whole.matchAll(pattern)].map((match) => ({ path, match }));
  });
  test(`figures: ${name}`, { skip: found.length === 0 && "no document makes this claim" }, () => {
    const wrong = found.filter(({ match }) => !check(match)).map(({ path, match }) => `${path}: ${match[0]}`);
    assert.deepEqual(wrong, []);
  });
}

test("figures: some are found, and a wrong one is seen", () => {
  const rows = CLAIMS[0];
  const [boxes, { own, fastest }] = [...uniform][1];
  const [, name, time] = /^(.*) ([\d.]+ [nµm]?s)$/.exec(fastest);
  const row = (mean) => [...`| ${boxes} | ${own} | ${time} (${name}) | ${mean} times faster |`.matchAll(rows.pattern)][0];
  assert.ok(rows.check(row(Number(means.get(boxes).mean).toFixed(1))));
  assert.ok(!rows.check(row((Number(means.get(boxes).mean) + 0.2).toFixed(1))));
});
