// Measures whole steps: the broad phases of an engine take turns, step by step.
import { engines } from "./engines.js";

const median = (times) => times.sort((a, b) => a - b)[times.length >> 1];

/** The median milliseconds of a step, and the contacts of the first step, for each broad phase of an engine. */
async function measure(name, scene, count, steps) {
  const { broadPhases, create } = engines[name];
  const worlds = [];
  for (const broadPhase of broadPhases) worlds.push({ broadPhase, step: await create(scene, count, broadPhase), times: [] });
  for (const world of worlds) world.contacts = world.step();
  // The first third lets the compiler and the bodies settle.
  for (let step = 0; step < steps; step++) {
    for (let at = 0; at < worlds.length; at++) {
      const world = worlds[(at + step) % worlds.length];
      const begun = performance.now();
      world.step();
      const ms = performance.now() - begun;
      if (3 * step >= steps) world.times.push(ms);
    }
  }
  return worlds.map(({ broadPhase, times, contacts }) => ({ broadPhase, ms: median(times), contacts }));
}

globalThis.measure = measure;
globalThis.scenesOf = (name) => engines[name].scenes ?? ["gas", "pile"];
globalThis.names = Object.keys(engines);
globalThis.ready = true;
