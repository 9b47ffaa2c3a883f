// The figures of the READMEs are those of the results: of bench/RESULTS.md and bench/js/RESULTS.md, which are made
// from the recorded runs. Each claim has a pattern that says how the READMEs write it.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

const root = dirname(dirname(fileURLToPath(import.meta.url)));
const read = (path) => readFileSync(join(root, path), "utf8");
const DOCUMENTS = ["README.md", "core/README.md", "js/README.md", "python/README.md", "CHANGELOG.md"];

/** The rows of the first table under a heading, as lists of cells. */
function table(text, heading) {
  const section = text.split(/^#+ /m).find((it) => it.startsWith(heading));
  assert.ok(section, `the results have no section "${heading}"`);
  const rows = section.slice(section.indexOf("\n|") + 1).split(/\n(?!\|)/, 1)[0].split("\n");
  return rows.slice(2).map((row) => row.split("|").slice(1, -1).map((cell) => cell.trim()));
}

/** The results in Rust of the machine that README.md names. */
function resultsOfReadme() {
  const [, machine, date] = /from raw boxes to stored pairs\. (.+?), \d+ cores, (\d{4}-\d\d-\d\d)/.exec(read("README.md")) ?? [];
  const heading = `\n## ${machine}, ${date}\n`;
  const [, results] = read("bench/RESULTS.md").split(heading);
  assert.ok(results, `bench/RESULTS.md has no results of the machine and day of README.md:${heading}`);
  return results;
}

const rust = resultsOfReadme();
const javascript = read("bench/js/RESULTS.md");

const uniform = new Map(
  table(rust, "Against the fastest alternative")
    .filter(([scene]) => scene === "uniform 3D")
    .map(([, boxes, , own, fastest]) => [boxes, { own, fastest }]),
);
const means = new Map(table(rust, "How many times slower").map(([boxes, , mean, , least]) => [boxes, { mean, least }]));
const open = new Set(table(rust, "Against the fastest alternative").map(([scene]) => scene));
const twoThreads = table(rust, "Two threads").filter(([, boxes]) => boxes === "100,000");
const gains = twoThreads.filter(([scene]) => open.has(scene)).map((row) => Number(row[4]));
const allGains = twoThreads.map((row) => Number(row[4]));
const geometricMean = (numbers) => Math.exp(numbers.reduce((sum, number) => sum + Math.log(number), 0) / numbers.length);
/** By "fast 3D 10,000" the row of that motion. */
const worlds = new Map(table(rust, "Against finding all pairs from scratch").map((row) => [`${row[0]} ${row[1]}`, row]));
const inJavaScript = new Map(
  ["Finding all pairs", "Moving boxes"].flatMap((heading) =>
    table(javascript, heading).map((row) => [`${row[0]} ${row[1]}`, row]),
  ),
);
const native = table(javascript, "WebAssembly against native").map((row) => Number(row[5]));

/** Whether two figures as written are the least and the most of numbers, rounded. */
const isRange = (least, most, numbers) => isRounded(least, Math.min(...numbers)) && isRounded(most, Math.max(...numbers));

/** How many times as long as from scratch a `BroadPhase` takes if all bodies fly, or some jump. */
const overScratch = (bodies) =>
  ["fast 2D", "fast 3D", "teleport 2D", "teleport 3D"].map((motion) => Number(worlds.get(`${motion} ${bodies}`)[4]));

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
    name: "rows of the scene uniform 3D with the mean and the minimum over all scenes",
    pattern: /^\| ([\d,]+) \| ([\d.]+ [nµm]?s) \| ([^:|]+): ([\d.]+ [nµm]?s) \| ([\d.]+) times as long \| ([\d.]+) times \|/gm,
    check: ([, boxes, own, name, time, mean, least]) =>
      isTime(own, uniform.get(boxes).own) &&
      uniform.get(boxes).fastest === `${name} ${time}` &&
      isRounded(mean, means.get(boxes).mean) &&
      isRounded(least, means.get(boxes).least),
  },
  {
    name: "what two threads gain at 100,000 boxes, on the scenes that every library is measured on",
    pattern: /two threads gain ([\d.]+) to ([\d.]+) times/gi,
    check: ([, least, most]) => isRange(least, most, gains),
  },
  {
    name: "what two threads gain at 100,000 boxes, on all scenes",
    pattern: /and ([\d.]+) to ([\d.]+) times on all (\d+) \(([\d.]+) times in the geometric mean; on (\w+) scenes two are slower/g,
    check: ([, least, most, scenes, mean, slower]) =>
      isRange(least, most, allGains) &&
      Number(scenes) === allGains.length &&
      isRounded(mean, geometricMean(allGains)) &&
      ["no", "one", "two", "three", "four", "five", "six"][allGains.filter((gain) => gain < 1).length] === slower,
  },
  {
    name: "BroadPhase against from scratch if all bodies fly or some jump, at three sizes",
    pattern:
      /([\d.]+) to ([\d.]+) times as long at ([\d,]+) bodies, ([\d.]+) to ([\d.]+) times at ([\d,]+), ([\d.]+) to ([\d.]+) times at ([\d,]+)\./g,
    check: ([, ...written]) =>
      [0, 3, 6].every((at) => isRange(written[at], written[at + 1], overScratch(written[at + 2]))),
  },
  {
    name: "BroadPhase against from scratch if all bodies fly or some jump, at one size",
    pattern: /a `BroadPhase` of ([\d,]+) bodies takes ([\d.]+) to ([\d.]+) times as long as finding all pairs/g,
    check: ([, bodies, least, most]) => isRange(least, most, overScratch(bodies)),
  },
  {
    name: "BroadPhase against from scratch if all bodies drift",
    pattern: /At ([\d,]+) it takes longer even if all drift slowly: ([\d.]+) times as long, and ([\d.]+) times at ([\d,]+) in 2D/g,
    check: ([, bodies, written, in2D, fewer]) =>
      ["drift 2D", "drift 3D"].every((motion) => isRounded(written, worlds.get(`${motion} ${bodies}`)[4])) &&
      isRounded(in2D, worlds.get(`drift 2D ${fewer}`)[4]) &&
      Number(worlds.get(`drift 3D ${fewer}`)[4]) < 1,
  },
  {
    name: "JavaScript: rows of the scene uniform",
    pattern: /^\| ([\d,]+) in ([23]D) \| ([\d.]+) \| ([^|]+?) ([\d.]+) \| ([\d.]+) \|/gm,
    check: ([, boxes, dimensions, own, name, time, plain]) => {
      const row = inJavaScript.get(`uniform ${dimensions} ${boxes}`);
      return row[3] === own && row[4] === `${name} ${time}` && row[7] === plain;
    },
  },
  {
    name: "JavaScript: one frame of 10,000 moving bodies in 2D",
    pattern:
      /takes ([\d.]+) ms if most bodies rest, ([\d.]+) ms if all drift slowly, ([\d.]+) ms if all move fast, and ([\d.]+) ms if some jump anywhere\. Finding all pairs from scratch with `PairFinder` takes ([\d.]+)(?: to ([\d.]+))? ms/g,
    check: ([, ...written]) => {
      const rows = ["mostly-still", "drift", "fast", "teleport"].map((motion) => inJavaScript.get(`${motion} 2D 10,000`));
      const scratch = rows.map((row) => Number(row[3]));
      return rows.every((row, at) => row[4] === written[at]) && isRange(written[4], written[5] ?? written[4], scratch);
    },
  },
  {
    name: "JavaScript: a frame of BroadPhase against from scratch",
    pattern: /^\| (all drift slowly|5 % jump anywhere, or all move fast) \| ([\d.]+) to ([\d.]+) times/gm,
    check: ([, how, least, most]) => {
      const motions = how.startsWith("all") ? ["drift"] : ["fast", "teleport"];
      const rows = [...inJavaScript].filter(([name]) => motions.includes(name.split(" ")[0])).map(([, row]) => row);
      return rows.length > 0 && isRange(least, most, rows.map((row) => Number(row[4]) / Number(row[3])));
    },
  },
  {
    name: "JavaScript: WebAssembly against native code",
    pattern: /WebAssembly takes ([\d.]+) to ([\d.]+) times as long as the same code compiled natively/g,
    check: ([, least, most]) => isRange(least, most, native),
  },
];

const texts = DOCUMENTS.map((path) => [path, read(path).replace(/\n(?![\n|])/g, (line) => line)]);

for (const { name, pattern, check } of CLAIMS) {
  const found = texts.flatMap(([path, text]) => {
    // Prose runs over the ends of lines; rows of tables do not.
    const whole = pattern.flags.includes("m") ? text : text.replace(/\s+/g, " ");
    return [...whole.matchAll(pattern)].map((match) => ({ path, match }));
  });
  test(`figures: ${name}`, () => {
    assert.ok(found.length > 0, "no README makes this claim any more: remove it here, or change its pattern");
    const wrong = found.filter(({ match }) => !check(match)).map(({ path, match }) => `${path}: ${match[0]}`);
    assert.deepEqual(wrong, []);
  });
}

test("figures: a wrong one is seen", () => {
  const rows = CLAIMS[0];
  const [boxes, { own, fastest }] = [...uniform][1];
  const [, name, time] = /^(.*) ([\d.]+ [nµm]?s)$/.exec(fastest);
  const { mean, least } = means.get(boxes);
  const row = (figure) => [...`| ${boxes} | ${own} | ${name}: ${time} | ${figure} times as long | ${least} times |`.matchAll(rows.pattern)][0];
  assert.ok(rows.check(row(mean)));
  assert.ok(!rows.check(row((Number(mean) + 0.2).toFixed(2))));
});
