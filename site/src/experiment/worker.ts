// The thread of an experiment: one step of the world, then every runner on the same boxes, one after
// another, so that none disturbs the clock of another.

import { Experiment, type RunnerOptions, type Report, type WorldOptions } from "./experiment.ts";
import { Falling, loadSimulation } from "./falling.ts";
import { formatCount } from "../panel/counters.ts";
import { FALLING } from "./scene.ts";
import type { FromExperiment, Lane, ToExperiment } from "./messages.ts";
import { messageOf } from "../message-of.ts";

/** More steps per second would be too fast to watch. */
const STEP_MS = 50;
/** Balls fall in time. */
const FALLING_MS = 1000 / 60;
/** A world with more pairs than this would fill the memory. */
const MOST_PAIRS = 2_000_000;
/** The most tests: they take about a second. */
const MOST_TESTS = 3e8;
/** The most overlaps that are kept: they take about 200 MB. */
const MOST_KEPT = 5e6;
/** A runner that takes longer than this twice in a row is out: the others are waiting. */
const BUDGET_MS = 400;
/** The same, counting included. */
const BUDGET_IN_ALL_MS = 2000;

interface Runner {
  readonly options: RunnerOptions;
  /** Its number in the experiment. */
  number: number;
  /** Steps over the budget in a row. */
  late: number;
  out: string | undefined;
}

interface Session {
  readonly run: number;
  readonly world: WorldOptions;
  /** What moves the boxes, if balls do. */
  readonly falling: Falling | undefined;
  readonly runners: Runner[];
  step: number;
  /** Whether the page has not shown the last frame. */
  unseen: boolean;
}

let session: Session | undefined;
let running = false;
let due = 0;
let timer: ReturnType<typeof setTimeout> | undefined;

const send = (message: FromExperiment, transfer: Transferable[] = []): void => self.postMessage(message, { transfer });

function begin(experiment: Experiment, { run, world, runners: options, steps = 0, keep = false }: Extract<ToExperiment, { type: "begin" }>): void {
  const isKept = keep && session?.world.dimensions === world.dimensions && session.runners.every(({ out }) => out === undefined);
  const kept = isKept ? session?.runners : undefined;
  session?.falling?.free();
  session = undefined;
  const falling = isFalling(world) ? new Falling(world) : undefined;
  if (falling) for (let step = 0; step < steps; step++) falling.advance();
  experiment.begin(falling ? { ...world, own: falling.rows } : world, isKept);
  if (!falling) for (let step = 0; step < steps; step++) experiment.advance();
  const pairs = experiment.countPairs();
  if (pairs > MOST_PAIRS) {
    const reason = `${formatCount(world.boxes)} boxes of this scene make ${formatCount(pairs)} pairs; the limit is ${formatCount(MOST_PAIRS)}. Choose fewer or smaller boxes, or another scene.`;
    send({ type: "refused", run, reason });
    return;
  }
  let number = 0;
  const runners = kept ?? options.map((options): Runner => ({ options, number: 0, late: 0, out: undefined }));
  for (const runner of runners) {
    runner.out = refusal(experiment, runner.options);
    if (kept || runner.out !== undefined) continue;
    experiment.enter(runner.options);
    runner.number = number++;
  }
  session = { run, world, falling, runners, step: steps, unseen: false };
  compete(experiment, session);
}

const isFalling = ({ scene, own }: WorldOptions): boolean => scene === FALLING && !own;

/** Why a runner cannot even begin, if it cannot. */
function refusal(experiment: Experiment, options: RunnerOptions): string | undefined {
  const { tests, kept } = experiment.forecast(options);
  if (tests > MOST_TESTS) return `Stopped: it would have to look at ${formatCount(tests)} pairs per step; the limit is ${formatCount(MOST_TESTS)}.`;
  if (kept > MOST_KEPT) return `Stopped: it would have to keep ${formatCount(kept)} overlaps in memory; the limit is ${formatCount(MOST_KEPT)}.`;
  return undefined;
}

/** Lets every runner that is in find the pairs, each step another one first. */
function compete(experiment: Experiment, session: Session): void {
  const { runners, step } = session;
  const reports = new Map<Runner, Report>();
  runners.forEach((_, place) => {
    const runner = runners[(place + step) % runners.length];
    if (!runner || runner.out !== undefined) return;
    const started = performance.now();
    const report = experiment.run(runner.number, true);
    const inAll = performance.now() - started;
    reports.set(runner, report);
    // The first step sorts from scratch and makes room: it does not count.
    const isLate = report.ms > BUDGET_MS || inAll > BUDGET_IN_ALL_MS;
    runner.late = step > 0 && isLate ? runner.late + 1 : 0;
    if (runner.late < 2) return;
    runner.out =
      report.ms > BUDGET_MS
        ? `Stopped: a step took ${formatCount(report.ms)} ms; the limit is ${BUDGET_MS} ms.`
        : `Stopped: a step and its counting took ${formatCount(inAll)} ms; the limit is ${formatCount(BUDGET_IN_ALL_MS)} ms.`;
  });
  const lanes = runners.map((runner): Lane => {
    const report = reports.get(runner);
    return report ? { report } : { out: runner.out ?? "" };
  });
  const first = runners.find((runner) => reports.has(runner));
  const pairs = first ? experiment.pairs(first.number).slice() : new Uint32Array(0);
  const boxes = experiment.boxes.slice();
  session.unseen = true;
  const balls = session.falling?.balls;
  send({ type: "frame", run: session.run, step, boxes, pairs, lanes, balls }, [boxes.buffer, pairs.buffer, ...(balls ? [balls.positions.buffer] : [])]);
}

function advance(experiment: Experiment): void {
  if (!session) return;
  const { falling, world } = session;
  falling?.advance();
  // The runners stay, with what they have kept.
  if (falling) experiment.begin({ ...world, own: falling.rows }, true);
  else experiment.advance();
  session.step++;
  compete(experiment, session);
}

/** One step if it is time and the page has shown the last, then back to the queue of messages. */
function tick(experiment: Experiment): void {
  timer = undefined;
  if (!running || !session || session.unseen) return;
  const now = performance.now();
  if (now < due) {
    timer = setTimeout(() => tick(experiment), due - now);
    return;
  }
  due = now + (session.falling ? FALLING_MS : STEP_MS);
  try {
    advance(experiment);
  } catch (error) {
    fail(error);
  }
}

function receive(experiment: Experiment, message: ToExperiment): void {
  switch (message.type) {
    case "begin":
      begin(experiment, message);
      break;
    case "pace":
      running = message.running;
      send({ type: "paced" });
      break;
    case "step":
      advance(experiment);
      break;
    case "seen":
      if (session && message.run === session.run) session.unseen = false;
      break;
  }
  timer ??= setTimeout(() => tick(experiment));
}

/** An error is sent to the page, and stops the session. */
function fail(error: unknown): void {
  running = false;
  send({ type: "failed", message: messageOf(error) });
}

new PerformanceObserver((list) => send({ type: "loaded", files: list.getEntries().map(({ name }) => name) })).observe({ type: "resource", buffered: true });

// Messages that come before the experiment is there wait for it, in their order.
let queue: Promise<Experiment> = Experiment.load().then(
  (experiment) => {
    send({ type: "ready", lists: experiment.lists });
    return experiment;
  },
  (error: unknown) => {
    send({ type: "failed", message: messageOf(error) });
    throw error;
  },
);
self.addEventListener("message", ({ data }: MessageEvent<ToExperiment>) => {
  queue = queue.then(async (experiment) => {
    try {
      if (data.type === "begin" && isFalling(data.world)) await loadSimulation();
      receive(experiment, data);
    } catch (error) {
      fail(error);
    }
    return experiment;
  });
  queue.catch(() => undefined);
});
