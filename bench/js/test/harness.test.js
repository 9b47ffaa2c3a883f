// Keeps the benchmark from rotting: every light alternative is checked and timed on a few boxes. The heavy
// alternatives (the engines in WebAssembly) take part where they are installed and asked for.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath } from "node:url";
import { libraries } from "../libraries/index.js";
import { Candidates } from "../libraries/candidates.js";
import { create as plainSweep } from "../libraries/plain-sweep.js";
import { create as bruteForce } from "../libraries/brute-force.js";
import { buildWasm } from "../src/build.js";
import { Fingerprint } from "../src/fingerprint.js";
import { Scenes } from "../src/scenes.js";

const folder = mkdtempSync(join(tmpdir(), "bench-js-"));
after(() => rmSync(folder, { recursive: true }));

const heavy = /rapier|jolt/;
const light = libraries.filter((one) => !heavy.test(one.name));

test("every light library finds the right pairs and is timed, at rest and in motion", () => {
  const output = join(folder, "results.json");
  const main = fileURLToPath(new URL("../src/main.js", import.meta.url));
  const libraries = light.map(({ name }) => name).join();
  const { status, stdout, stderr } = spawnSync(
    process.execPath,
    [main, "--scenes", "mixed,drift", "--sizes", "150", "--rounds", "1", "--limit", "1000", "--no-native", "--libraries", libraries, "--output", output],
    { encoding: "utf8" },
  );
  assert.equal(status, 0, stderr);
  const { cases, worlds, versions } = JSON.parse(readFileSync(output, "utf8"));
  assert.deepEqual([cases.length, worlds.length], [2, 2], stdout);
  for (const { scene, dimensions, boxes, pairs, reference, results } of [...cases, ...worlds]) {
    assert.equal(boxes, 150);
    assert.equal(reference, "brute force");
    assert.ok(pairs > 20, `${pairs} pairs`);
    const task = scene === "drift" ? "track" : "find";
    const expected = light.filter((one) => one.dimensions.includes(dimensions) && one.tasks.includes(task));
    assert.deepEqual(
      results.flatMap(({ name, outcome }) => ("Timed" in outcome && outcome.Timed.ratio > 0 ? [name] : [])).sort(),
      expected.map(({ name }) => name).sort(),
      `${scene} ${dimensions}D: ${JSON.stringify(results)}`,
    );
  }
  for (const { package: name } of light) if (name) assert.match(versions[name === "sweep-and-prune" ? "sweep-and-prune" : name], /^\d/);
});

test("each call finds another scene of the kind, even where seeds do not change the boxes", async () => {
  const scenes = await Scenes.start(readFileSync(buildWasm()));
  for (const name of ["uniform", "box-pruning"]) {
    const kind = scenes.open(name, 3, 200);
    const seen = new Set(Array.from({ length: kind.varied }, () => kind.next().join()));
    assert.deepEqual([kind.varied, seen.size], [100, 100], name);
    assert.ok(seen.has(kind.next().join()), "the first scene follows the last");
  }
  const many = scenes.open("uniform", 3, 10_001);
  assert.equal(many.varied, 0);
  assert.notDeepEqual(many.next(), many.next());
});

test("a fingerprint tells sets of pairs apart, however they are ordered", () => {
  const of = (...pairs) => String(new Fingerprint().add(pairs));
  assert.equal(of(1, 2, 3, 4), of(4, 3, 1, 2));
  for (const other of [of(1, 2), of(1, 3, 2, 4), of(1, 2, 1, 2), of()]) assert.notEqual(of(1, 2, 3, 4), other);
  assert.notEqual(of(1, 2, 1, 2, 3, 4), of(1, 2, 3, 4, 3, 4));
});

test("the plain sweep holds for ties, either zero and infinite edges", async () => {
  for (const dimensions of [2, 3]) {
    const [sweep, brute] = [await plainSweep({ dimensions }), await bruteForce({ dimensions })];
    const edges = [-Infinity, -2, -1, -0, 0, 2 ** -149, 1, 2, 3, Infinity];
    let state = 1;
    const random = (n) => (state = Math.imul(state, 1103515245) + 12345) >>> 16 && (state >>> 16) % n;
    for (let round = 0; round < 50; round++) {
      const rows = new Float32Array(2 * dimensions * 40);
      for (let at = 0; at < rows.length; at += 2 * dimensions) {
        for (let axis = 0; axis < dimensions; axis++) {
          const [a, b] = [random(edges.length), random(edges.length)];
          rows[at + axis] = edges[Math.min(a, b)];
          rows[at + dimensions + axis] = edges[Math.max(a, b)];
        }
      }
      assert.equal(String(new Fingerprint().add(sweep.find(rows))), String(new Fingerprint().add(brute.find(rows))));
    }
  }
});

test("candidates come, go and are tested once more", () => {
  const candidates = new Candidates(2, 3);
  const rows = new Float32Array([0, 0, 2, 2, 1, 1, 3, 3, 2.5, 2.5, 4, 4]);
  for (const [a, b] of [[0, 1], [1, 0], [0, 2], [2, 1]]) candidates.add(a, b);
  assert.deepEqual([...candidates.exact(rows)], [0, 1, 2, 1]);
  candidates.remove(1, 0);
  assert.deepEqual([...candidates.exact(rows)], [2, 1]);
  candidates.keep((a, b) => a + b !== 3);
  assert.deepEqual([...candidates.exact(rows)], []);
});
