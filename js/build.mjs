// Builds js/dist/: the compiled cores twice, without and with vector instructions, the modules,
// their declarations. Fails if a build is not what its name says, or over its size budget.
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import binaryen from "binaryen";
import { begin, buildDeclarations, buildModules, compile, writeCore, writeForRequire } from "../scripts/npm-package.mjs";
import { orderBySimilarity } from "../scripts/wasm-order.mjs";

const here = fileURLToPath(new URL(".", import.meta.url));
const dist = join(here, "dist");

/** Loops are unrolled less than by default, which saves 3 KB of `BroadPhase` after gzip, and 200 bytes of the finder. */
const unrolling = (most) => `-Cllvm-args=-unroll-threshold=${most}`;
/** The finder for size: 40 KB instead of 63, for at most 4 % of its speed (2026-11-22); its loops for speed take no more. */
const smallWithFastLoops = { all: "s", core: 3, flags: ["-Cllvm-args=-inline-threshold=17", unrolling(75)] };
/** BroadPhase for speed: about 17 KB more, for up to a third less time. Inlining more makes it larger, not faster. */
const fast = { all: 3, core: 3, flags: ["-Cllvm-args=-inline-threshold=23", unrolling(150)] };
/**
 * One type of box: as fast with less inlined and unrolled, and 3.4 KB smaller (10,000 bodies at rest, drifting and flying, 2026-11-28);
 * with loops unrolled up to 30 flying bodies take 1.1 of the time.
 */
const fastForOne = { all: 3, core: 3, flags: ["-Cllvm-args=-inline-threshold=20", unrolling(50)] };

/**
 * The cores, each a feature of js/wasm/, with budgets in bytes after gzip: what a page downloads
 * before the first call.
 */
const cores = [
  { name: "sweep-and-prune", feature: "finder", budget: 40 * 1024, levels: smallWithFastLoops },
  // Of these, 1.4 KB are for errors where an answer does not fit in memory.
  { name: "broad-phase", feature: "broad-phase", budget: 155_500, levels: fast },
  // For a game that needs nothing but events: one type of box.
  { name: "events-2d", feature: "events-2d", budget: 70_500, levels: fastForOne },
  { name: "events-3d", feature: "events-3d", budget: 70_500, levels: fastForOne },
];

/**
 * The entries, with budgets of what they import in all. 2 KB of each are messages that name what is wrong with a call, and
 * 40 bytes of each module name its source map.
 * Each has an inline form, with its core inside.
 */
const entries = [
  // Of these, 1 KB is for pairs in chunks, and 60 bytes are for sprites, which are no boxes.
  { name: "index", inline: "inline", budget: 11_300 },
  // Of these, 1.7 KB are for many queries in one call, and 1.1 KB for data of bodies, clones and restoring in place.
  { name: "broad-phase", inline: "broad-phase-inline", budget: 17_100 },
  { name: "events-2d", inline: "events-2d-inline", budget: 11_500 },
  { name: "events-3d", inline: "events-3d-inline", budget: 11_500 },
].map(withSource);

/**
 * The entries for engines, with budgets of what they import in all. They use the cores of `index` and `broad-phase`, so they have
 * no inline form.
 */
const engines = [
  { name: "matter-js", budget: 12_150 },
  { name: "cannon-es", budget: 12_050 },
  { name: "excalibur", budget: 18_700 },
  { name: "phaser", budget: 12_300 },
  { name: "three", budget: 18_700 },
  { name: "pixi", budget: 18_400 },
].map(withSource);

/** Without and with vector instructions. */
const builds = [
  { suffix: ".wasm", directory: "wasm-scalar", flags: [], simd: false },
  { suffix: ".simd.wasm", directory: "wasm-simd", flags: ["-Ctarget-feature=+simd128"], simd: true },
];

function withSource(entry) {
  return { ...entry, source: `src/entries/${entry.name}.ts` };
}

const end = begin(here);
// Two at a time: the compiler's last pass, over the whole program, takes one processor.
await Promise.all(builds.map(buildCores));
const inlined = entries.map(({ inline, source }) => ({ name: inline, source: `inline:${source}` }));
await buildModules(here, [...entries, ...inlined, ...engines], { hasMaps: true });
writeForRequire(here, [...entries, ...inlined, ...engines].map(({ name }) => name));
await buildDeclarations(here, [...entries, ...engines], { isForRequire: true });
end();

async function buildCores({ suffix, directory, flags, simd }) {
  for (const { name, feature, budget, levels } of cores) {
    const compiled = await compile("sweep-and-prune-wasm", { features: [feature], directory: join(directory, feature), flags, levels });
    writeCore(join(dist, name + suffix), optimizeAgain(compiled, simd), { budget, simd });
  }
}

/**
 * Makes compiled code 2 to 3 % smaller after gzip, and as fast (10,000 bodies in 3D that drift and fly, 2026-11-26), with
 * Binaryen. It may use the instructions that Rust uses by default, and no others.
 */
function optimizeAgain(compiled, simd) {
  const module = binaryen.readBinary(compiled);
  const { BulkMemory, BulkMemoryOpt, MultiValue, MutableGlobals, NontrappingFPToInt, ReferenceTypes, SIMD128, SignExt } = binaryen.Features;
  const features = BulkMemory | BulkMemoryOpt | MultiValue | MutableGlobals | NontrappingFPToInt | ReferenceTypes | SignExt | (simd ? SIMD128 : 0);
  module.setFeatures(features);
  // At level 3 a file is larger, and no faster. The compiler has inlined what pays: inlining again takes 500 bytes more.
  binaryen.setOptimizeLevel(2);
  binaryen.setShrinkLevel(0);
  binaryen.setAlwaysInlineMaxSize(1);
  binaryen.setFlexibleInlineMaxSize(1);
  binaryen.setOneCallerInlineMaxSize(1);
  // The second time finds 300 bytes more.
  module.optimize();
  module.optimize();
  const bytes = Buffer.from(module.emitBinary());
  module.dispose();
  return orderBySimilarity(binaryen, bytes, features);
}
