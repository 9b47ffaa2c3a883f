// The class against the compiled module, as classroom/demo/ ships it, and the module against the native build: the same bits.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { before, describe, test } from "node:test";

import { Simulation, SimulationError } from "../simulation.js";

const golden = readFileSync(new URL("../../golden.txt", import.meta.url), "utf8").trim().split("\n");

function run(simulation, steps) {
  let report;
  for (let step = 0; step < steps; step++) report = simulation.step();
  return report;
}

function assertRefused(code, action) {
  assert.throws(action, (error) => error instanceof SimulationError && error.code === code);
}

/** What a line of golden.txt says, by this module. */
function lineFromScratch(line, broadPhase) {
  const [scene, dimensions, bodies, size, spread, seed, steps] = line.split(" ");
  const numbers = { dimensions: +dimensions, bodies: +bodies, size: +size, spread: +spread, seed: +seed };
  const simulation = new Simulation({ scene, ...numbers, broadPhase });
  run(simulation, +steps);
  const hash = simulation.hash();
  simulation.free();
  return [scene, dimensions, bodies, size, spread, seed, steps, hash].join(" ");
}

test("nothing works before the module is loaded", () => {
  assertRefused("not-loaded", () => new Simulation());
  assert.deepEqual(Simulation.algorithms, []);
});

describe("loaded", () => {
  before(async () => {
    const bytes = readFileSync(new URL("../../../demo/dist/simulation.wasm", import.meta.url));
    const loading = Simulation.load(bytes);
    assert.equal(Simulation.load(bytes), loading, "loading twice is loading once");
    await loading;
  });

  test("the states are those of the native build, over every algorithm", () => {
    assert.ok(golden.length >= 6);
    for (const algorithm of Simulation.algorithms) {
      const fromScratch = golden.map((line) => lineFromScratch(line, { algorithm }));
      assert.deepEqual(fromScratch, golden, algorithm);
    }
  });

  test("lists what can be chosen", () => {
    assert.equal(Simulation.algorithms[0], "find pairs");
    assert.ok(Simulation.algorithms.includes("global pairwise"));
    assert.ok(Simulation.sorts.includes("insertion sort"));
    assert.deepEqual(Simulation.axes, ["largest variance", "longest extent"]);
  });

  test("a step reports counts, or null where nothing is counted", () => {
    const simulation = new Simulation({ bodies: 100, size: 0.5 });
    const first = simulation.step();
    assert.equal(first.broadPhases, 1, "for all substeps");
    assert.equal(first.tests, null);
    assert.equal(first.swaps, null);
    simulation.setBroadPhase({ algorithm: "global pairwise" });
    const brute = simulation.step();
    assert.equal(brute.tests, (100 * 99) / 2);
    assert.equal(brute.comparisons, 0);
    simulation.setBroadPhase({ algorithm: "sorted pairwise", sort: "insertion sort", axis: 1 });
    assert.ok(run(simulation, 60).tests < brute.tests);
    simulation.counting = false;
    const last = simulation.step();
    assert.equal(last.tests, null);
    assert.ok(last.totalMs >= last.broadPhaseMs && last.broadPhaseMs >= 0);
    assert.equal(simulation.pairs.length, 2 * last.pairs);
    assert.ok(last.contacts > 0 && last.contacts <= last.pairs);
    assert.equal(simulation.steps, 63);
    simulation.free();
  });

  test("views show the state, inside the box", () => {
    const simulation = new Simulation({ dimensions: 2, bodies: 300, size: 0.1, spread: 4 });
    const { min, max } = simulation.bounds;
    assert.deepEqual([min, max[0]], [[-5, 0], 5]);
    const start = simulation.positions.slice();
    run(simulation, 90);
    const { positions, radii, velocities } = simulation;
    assert.deepEqual([positions.length, radii.length, velocities.length], [600, 300, 600]);
    assert.notDeepEqual(positions, start);
    positions.forEach((at, index) => {
      const radius = radii[index >> 1];
      assert.ok(at >= Math.fround(min[index % 2] + radius) && at <= Math.fround(max[index % 2] - radius));
    });
    simulation.free();
  });

  test("views that are made again survive the growth of memory", () => {
    const small = new Simulation({ scene: "bouncing" });
    const before = small.positions.slice();
    const large = new Simulation({ bodies: 60_000, size: 0.1 });
    assert.deepEqual(small.positions, before);
    assert.equal(large.positions.length, 180_000);
    small.free();
    large.free();
  });

  test("given balls, as given", () => {
    const balls = [{ x: 150, y: 250, radius: 50 }, { x: 300, y: 150, radius: 55, vx: -20 }];
    const simulation = new Simulation({ scene: "bouncing", balls });
    assert.deepEqual([...simulation.positions], [150, 250, 300, 150]);
    assert.deepEqual([...simulation.radii], [50, 55]);
    assert.deepEqual(simulation.bounds, { min: [0, 0], max: [600, 400] });
    assert.deepEqual([simulation.gravity, simulation.substeps], [500, 4]);
    assert.equal(Math.fround(0.96), simulation.restitution);
    simulation.free();
  });

  test("settings change live, and are clamped", () => {
    const simulation = new Simulation({ bodies: 50, size: 0.5, gravity: 0, restitution: 1, substeps: 2 });
    const energy = simulation.energy();
    run(simulation, 30);
    assert.ok(Math.abs(simulation.energy() - energy) < 1e-4 * energy, "weightless and without loss");
    simulation.gravity = -3;
    simulation.restitution = 7;
    simulation.substeps = 1e9;
    simulation.collisions = false;
    assert.deepEqual([simulation.gravity, simulation.restitution, simulation.substeps], [-3, 1, 32]);
    assert.equal(simulation.collisions, false);
    assert.equal(simulation.step().broadPhases, 1);
    simulation.free();
  });

  test("what is refused changes nothing", () => {
    const simulation = new Simulation({ bodies: 20, size: 0.5 });
    for (const name of ["gravity", "restitution", "substeps"]) {
      assertRefused("invalid-option", () => (simulation[name] = NaN));
      assertRefused("invalid-option", () => (simulation[name] = "fast"));
    }
    assertRefused("invalid-option", () => simulation.setBroadPhase({ algorithm: "magic" }));
    assertRefused("invalid-option", () => simulation.setBroadPhase({ algorithm: "sorted pairwise", sort: "bogo" }));
    simulation.setBroadPhase({ algorithm: "sorted pairwise", axis: 2 });
    assertRefused("invalid-option", () => simulation.setBroadPhase({ algorithm: "sorted pairwise", axis: 3 }));
    assert.ok(Math.abs(simulation.gravity - 9.81) < 1e-6);
    assert.ok(simulation.step().tests !== null);
    simulation.free();
  });

  test("impossible starts are refused", () => {
    const ball = { x: 100, y: 100, radius: 10 };
    for (const options of [
      { scene: "flying" },
      { dimensions: 4 },
      { scene: "bouncing", dimensions: 3 },
      { bodies: NaN },
      { size: "large" },
      { gravity: NaN },
      { broadPhase: { algorithm: "magic" } },
      { scene: "bouncing", balls: [{ ...ball, x: NaN }] },
      { scene: "bouncing", balls: [{ ...ball, radius: -1 }] },
      { scene: "bouncing", balls: [{ ...ball, x: 5 }] },
      { scene: "bouncing", balls: [{ y: 5 }] },
    ]) {
      assertRefused("invalid-option", () => new Simulation(options));
    }
    assertRefused("no-room", () => new Simulation({ scene: "bouncing", bodies: 1000, size: 50 }));
    assertRefused("too-many", () => new Simulation({ scene: "bouncing", balls: Array(5000).fill(ball) }));
  });

  test("extreme options are clamped, and run", () => {
    for (const options of [
      { bodies: 0 },
      { bodies: -5, size: -5, spread: -5, seed: -5 },
      { bodies: 3, size: 1e30, spread: 1e30, seed: 1e30 },
      { bodies: 3, gravity: Infinity, restitution: Infinity, substeps: Infinity },
      { scene: "bouncing", width: 0, height: Infinity },
      { scene: "bouncing", balls: Array(500).fill({ x: 100, y: 100, radius: 10 }) },
    ]) {
      const simulation = new Simulation(options);
      run(simulation, 3);
      assert.ok(simulation.positions.every(Number.isFinite));
      simulation.free();
    }
  });

  test("a saved moment can be gone back to, until it is forgotten", () => {
    const simulation = new Simulation({ scene: "bouncing", bodies: 12 });
    run(simulation, 100);
    const moment = simulation.save();
    const here = simulation.hash();
    run(simulation, 50);
    const later = simulation.hash();
    simulation.restore(moment);
    assert.equal(simulation.hash(), here);
    assert.equal(simulation.steps, 100);
    run(simulation, 50);
    assert.equal(simulation.hash(), later);
    simulation.forget(moment);
    simulation.forget(moment);
    assertRefused("invalid-option", () => simulation.restore(moment));
    assert.equal(simulation.hash(), later);
    assert.equal(simulation.save(), moment, "its place is used again");
    simulation.free();
  });

  test("a ball is placed, inside the walls", () => {
    const simulation = new Simulation({ scene: "bouncing", balls: [{ x: 50, y: 50, radius: 10 }] });
    simulation.place(0, { x: 1000, y: 60 });
    assert.deepEqual([...simulation.positions], [590, 60]);
    assertRefused("invalid-option", () => simulation.place(1, { x: 1, y: 1 }));
    assertRefused("invalid-option", () => simulation.place(0, { x: NaN, y: 1 }));
    assert.deepEqual([...simulation.positions], [590, 60]);
    simulation.free();
  });

  test("freed is freed, and its place is used again", () => {
    const simulation = new Simulation({ bodies: 10, size: 0.5 });
    simulation.free();
    simulation.free();
    const next = new Simulation({ bodies: 20, size: 0.5 });
    assertRefused("freed", () => simulation.step());
    assertRefused("freed", () => simulation.positions);
    assertRefused("freed", () => (simulation.gravity = 1));
    assert.equal(next.bodies, 20);
    next.free();
  });
});
