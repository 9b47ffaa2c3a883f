// The static index against flatbush, rbush and (for points) kdbush in Node: building, searching, memory, and loading.
//
//   npm run build -w js && node --expose-gc bench/js/spatial-index.js [--sizes 10000,100000,1000000] [--rounds 7]
//
// All libraries run in one process and in turn. What each search finds is compared before any is timed. Times are
// minima over the rounds, and ratios those of minima: others / sweep-and-prune, above 1 is slower.
import { parseArgs } from "node:util";
import Flatbush from "flatbush";
import KDBush from "kdbush";
import RBush from "rbush";
import { Index, init } from "../../js/dist/spatial-index-inline.js";

const { values: flags } = parseArgs({
  options: { sizes: { type: "string", default: "10000,100000,1000000" }, rounds: { type: "string", default: "7" } },
});
const rounds = Number(flags.rounds);
await init();

/** @type {Record<string, { for: "boxes" | "points" | "both", build(rows: Float64Array | Float32Array): any, search(index: any, area: number[]): ArrayLike<number>, bytes?(index: any): number }>} */
const libraries = {
  "sweep-and-prune": {
    for: "both",
    build: (rows) => new Index(rows, { dimensions: 2 }),
    search: (index, area) => index.search(area),
    bytes: (index) => index.data.length,
  },
  flatbush: {
    for: "both",
    build(rows) {
      const index = new Flatbush(rows.length / 4, 16, /** @type {any} */ (rows.constructor));
      for (let at = 0; at < rows.length; at += 4) index.add(rows[at], rows[at + 1], rows[at + 2], rows[at + 3]);
      index.finish();
      return index;
    },
    search: (index, [minX, minY, maxX, maxY]) => index.search(minX, minY, maxX, maxY),
    bytes: (index) => index.data.byteLength,
  },
  rbush: {
    for: "boxes",
    build(rows) {
      const boxes = Array.from({ length: rows.length / 4 }, (_, index) => ({
        minX: rows[4 * index], minY: rows[4 * index + 1], maxX: rows[4 * index + 2], maxY: rows[4 * index + 3], index,
      }));
      return new RBush().load(boxes);
    },
    search: (index, [minX, minY, maxX, maxY]) => index.search({ minX, minY, maxX, maxY }).map((/** @type {any} */ box) => box.index),
  },
  kdbush: {
    for: "points",
    build(rows) {
      const index = new KDBush(rows.length / 4, 64, /** @type {any} */ (rows.constructor));
      for (let at = 0; at < rows.length; at += 4) index.add(rows[at], rows[at + 1]);
      return index.finish();
    },
    search: (index, [minX, minY, maxX, maxY]) => index.range(minX, minY, maxX, maxY),
  },
};

function random(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let mixed = Math.imul(seed ^ (seed >>> 15), seed | 1);
    mixed ^= mixed + Math.imul(mixed ^ (mixed >>> 7), mixed | 61);
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 2 ** 32;
  };
}

/** Boxes or points in the unit square: uniform, or in a thousandth as many clusters. */
function scene(count, isClustered, arePoints, Rows) {
  const next = random(count);
  const rows = new Rows(4 * count);
  const side = arePoints ? 0 : Math.sqrt(1 / count);
  const centers = Array.from({ length: Math.max(4, count / 1000) }, () => [next(), next()]);
  const normal = () => (next() + next() + next() - 1.5) / 30;
  for (let at = 0; at < rows.length; at += 4) {
    const [x, y] = isClustered ? centers[Math.floor(next() * centers.length)].map((center) => center + normal()) : [next(), next()];
    rows.set([x, y, x + side * next(), y + side * next()], at);
  }
  return rows;
}

/** Squares around boxes of the scene, as large as they must be to overlap about so many. */
function areas(rows, index, hits) {
  const count = Math.max(20, Math.min(2000, Math.floor(100_000 / (hits + 20))));
  return Array.from({ length: count }, (_, query) => {
    const at = 4 * ((query * 7919) % (rows.length / 4));
    const center = [rows[at], rows[at + 1]];
    const radius = hits === 1 ? 0 : 0.886 * index.neighbors(center, hits).at(-1).distance;
    return [center[0] - radius, center[1] - radius, center[0] + radius, center[1] + radius];
  });
}

const digits = (value) => value.toPrecision(3);

function time(work) {
  const start = performance.now();
  work();
  return performance.now() - start;
}

/** Prints a row: the time of sweep-and-prune, and how many times as long the others take. */
function row(label, names, work, per = 1) {
  const times = names.map(() => /** @type {number[]} */ ([]));
  for (let round = 0; round < rounds; round++) {
    globalThis.gc?.();
    names.forEach((name, at) => times[at].push(time(() => work(name))));
  }
  const ratios = times.slice(1).map((other) => digits(Math.min(...other) / Math.min(...times[0])));
  console.log(`| ${label} | ${digits((1000 * Math.min(...times[0])) / per)} µs | ${names.slice(1).map((name, at) => `${name} ${ratios[at]}`).join(", ")} |`);
}

console.log("| scene | sweep-and-prune | times as long |\n|---|--:|---|");
for (const count of flags.sizes.split(",").map(Number)) {
  for (const Rows of [Float64Array, Float32Array]) {
    for (const [arePoints, isClustered] of [[false, false], [false, true], [true, false]]) {
      const rows = scene(count, isClustered, arePoints, Rows);
      const names = Object.keys(libraries).filter((name) => libraries[name].for !== (arePoints ? "boxes" : "points"));
      const title = `${count} ${isClustered ? "clustered" : "uniform"} ${arePoints ? "points" : "boxes"}, ${Rows.name}`;
      row(`${title}: build`, names, (name) => libraries[name].build(rows).free?.());
      const built = Object.fromEntries(names.map((name) => [name, libraries[name].build(rows)]));
      const { data } = built["sweep-and-prune"];
      console.log(`| ${title}: bytes | ${data.length} | flatbush ${digits(built.flatbush.data.byteLength / data.length)} |`);
      row(`${title}: from`, ["sweep-and-prune"], () => Index.from(data).free());
      for (const hits of [1, 100, 10_000]) {
        const queries = areas(rows, built["sweep-and-prune"], hits);
        const search = (name, area) => libraries[name].search(built[name], area);
        let found = 0;
        for (const area of queries.slice(0, 50)) {
          const expected = Array.from(search("sweep-and-prune", area)).sort((a, b) => a - b).join();
          found += expected.split(",").length;
          for (const name of names) {
            // kdbush is given the points in single precision and the area in double.
            if (Array.from(search(name, area)).sort((a, b) => a - b).join() !== expected && Rows === Float64Array) throw new Error(`${name} finds others`);
          }
        }
        const all = (name) => queries.forEach((area) => search(name, area));
        row(`${title}: search, ${Math.round(found / Math.min(50, queries.length))} hits`, names, all, queries.length);
      }
      built["sweep-and-prune"].free();
    }
  }
}
