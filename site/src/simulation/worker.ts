// The thread of the simulation: steps the world at its own pace, sixty times a second if it can,
// and sends what it has when the page has a buffer free for it.

import type { BroadPhaseOptions, StepReport } from "../../../classroom/simulation/wasm/simulation.js";
import { loadSimulation, Simulation } from "../balls/load.ts";
import { AXIS_NAMES, type FromSimulation, type Laws, type Measurement, type Method, type Setup, type ToSimulation } from "./messages.ts";
import { messageOf } from "../message-of.ts";

const STEP_MS = 1000 / 60;
/** Positions are sent in this many buffers: one that the page shows, one on its way. */
const BUFFERS = 2;
/** Times are means of this many steps: a browser's clock is coarse. */
const WINDOW = 30;

interface World {
  readonly run: number;
  readonly simulation: Simulation;
  readonly buffers: Float32Array[];
  /** The latest reports, at most `WINDOW` of them. */
  readonly reports: StepReport[];
  /** When the steps of the last second were taken, and at least the last two. */
  readonly taken: number[];
  /** Whether the page has not seen the latest state. */
  unseen: boolean;
}

/** A world to warm up by: large enough for all of the code, and small enough not to be waited for. */
const WARM_UP = { bodies: 2000, steps: 4 };
let isCompiled = false;

let world: World | undefined;
let running = false;
let listPairs = false;
let methods = 0;
let due = 0;
let timer: ReturnType<typeof setTimeout> | undefined;

const send = (message: FromSimulation, transfer: Transferable[] = []): void =>
  self.postMessage(message, { transfer });

function begin(run: number, setup: Setup, { gravity, substeps }: Laws, method: Method): void {
  world?.simulation.free();
  const { bodies, radius, spread, seed } = setup;
  warmUp();
  const simulation = new Simulation({
    scene: "falling",
    dimensions: 2,
    bodies,
    size: radius,
    spread,
    seed,
    gravity,
    substeps,
    broadPhase: broadPhaseOf(method),
  });
  const buffers = Array.from({ length: BUFFERS }, () => new Float32Array(simulation.positions.length));
  world = { run, simulation, buffers, reports: [], taken: [], unseen: true };
  send({ type: "begun", run, ...simulation.bounds, radii: simulation.radii.slice() });
  show(world);
}

/** A browser compiles a function when it is first called, and again when it was called often: so that the
 * times of the first steps are not those of the compiler, a few steps are run first and not shown. */
function warmUp(): void {
  if (isCompiled) return;
  isCompiled = true;
  const simulation = new Simulation({ scene: "falling", dimensions: 2, bodies: WARM_UP.bodies });
  for (let step = 0; step < WARM_UP.steps; step++) simulation.step();
  simulation.free();
}

/** An axis is a rule by its name, or one of the axes by its number. */
function broadPhaseOf({ algorithm, sort, axis }: Method): BroadPhaseOptions {
  const fixed = AXIS_NAMES.indexOf(axis);
  return { algorithm, sort, axis: fixed < 0 ? axis : fixed };
}

function step(world: World): void {
  world.reports.push(world.simulation.step());
  if (world.reports.length > WINDOW) world.reports.shift();
  const now = performance.now();
  world.taken.push(now);
  while (world.taken.length > 2 && (world.taken[0] ?? now) < now - 1000) world.taken.shift();
  world.unseen = true;
}

/** Sends the latest state, if a buffer is free; otherwise it is sent when one comes back. */
function show(world: World): void {
  const positions = world.buffers.pop();
  if (!positions) return;
  const { run, simulation } = world;
  positions.set(simulation.positions);
  const pairs = listPairs ? simulation.pairs.slice() : new Uint32Array(0);
  world.unseen = false;
  send(
    {
      type: "frame",
      run,
      step: simulation.steps,
      methods,
      running,
      pace: paceOf(world.taken),
      hash: running ? "" : simulation.hash(),
      positions,
      pairs,
      measurement: measure(world),
    },
    [positions.buffer, pairs.buffer],
  );
}

/** Sends a state that the page has seen, because something else about it has changed. */
function showAgain(world: World): void {
  world.unseen = true;
  show(world);
}

/** Steps a second; 0 until there are two of them. */
function paceOf(taken: readonly number[]): number {
  const [first = 0, last = 0] = [taken[0], taken.at(-1)];
  return last > first ? (1000 * (taken.length - 1)) / (last - first) : 0;
}

function measure({ simulation, reports }: World): Measurement {
  const latest = reports.at(-1);
  const mean = (time: (report: StepReport) => number): number | null =>
    latest ? reports.reduce((sum, report) => sum + time(report), 0) / reports.length : null;
  return {
    bodies: simulation.bodies,
    tests: latest?.tests ?? null,
    axisOverlaps: latest?.axisOverlaps ?? null,
    pairs: latest?.pairs ?? null,
    comparisons: latest?.comparisons ?? null,
    swaps: latest?.swaps ?? null,
    broadPhase: mean((report) => report.broadPhaseMs),
    narrowPhase: mean((report) => report.narrowPhaseMs),
    solving: mean((report) => report.totalMs - report.broadPhaseMs - report.narrowPhaseMs),
  };
}

/** One step if it is time, then back to the queue of messages. A late world does not catch up. */
function tick(): void {
  timer = undefined;
  if (!running || !world) return;
  const now = performance.now();
  if (now >= due) {
    due = Math.max(due + STEP_MS, now - STEP_MS);
    guarded(() => world && (step(world), show(world)));
  }
  timer = setTimeout(tick, due - performance.now());
}

function setRunning(on: boolean): void {
  running = on;
  clearTimeout(timer);
  world?.taken.splice(0);
  if (on) {
    due = performance.now();
    timer = setTimeout(tick);
  } else if (world) {
    showAgain(world);
  }
}

function receive(message: ToSimulation): void {
  switch (message.type) {
    case "begin":
      begin(message.run, message.setup, message.laws, message.method);
      break;
    case "method":
      methods++;
      if (world) {
        world.simulation.setBroadPhase(broadPhaseOf(message.method));
        world.reports.splice(0);
        showAgain(world);
      }
      break;
    case "laws":
      if (world) Object.assign(world.simulation, message.laws);
      break;
    case "pace":
      setRunning(message.running);
      break;
    case "step":
      if (world) {
        step(world);
        show(world);
      }
      break;
    case "list-pairs":
      listPairs = message.on;
      if (world && !running) showAgain(world);
      break;
    case "recycle":
      if (world && message.run === world.run) {
        world.buffers.push(message.positions);
        if (world.unseen) show(world);
      }
      break;
  }
}

/** An error of the simulation is told to the page, and stops it. */
function guarded(work: () => void): void {
  try {
    work();
  } catch (error) {
    running = false;
    send({ type: "failed", message: messageOf(error) });
  }
}

// Messages that come before the module is there wait for it, in their order.
const loaded = loadSimulation().then(
  () => {
    const { algorithms, sorts, axes } = Simulation;
    send({ type: "ready", choices: { algorithms, sorts, axes } });
  },
  (error: unknown) => {
    send({ type: "failed", message: messageOf(error) });
    throw error;
  },
);
self.addEventListener("message", ({ data }: MessageEvent<ToSimulation>) => {
  void loaded.then(() => guarded(() => receive(data)), () => undefined);
});
