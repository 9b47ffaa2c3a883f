// A run in this browser: libraries in workers, checked, then timed in rounds.

import type { Library } from "../../../bench/js/libraries/index.js";
import { library as bruteForce, REFERENCE_LIMIT } from "../../../bench/js/src/reference.js";
import type { Answer, Ready, Start, Time } from "./messages.ts";
import type { Case, Entry } from "./results.ts";
import { messageOf } from "../message-of.ts";
import { median } from "../median.ts";

/** A worker that does not answer for this long (ms) is stopped. */
const LIMIT = 10_000;
/** Who takes longer for a call is not timed, in ms. */
const TOO_SLOW = 3_000;
const ROUNDS = 5;
/** A library's turn in a round, in ms. */
const TURN = 30;

interface Wish {
  readonly scene: string;
  readonly dimensions: number;
  readonly sizes: readonly number[];
  readonly libraries: readonly Library[];
}

/** Runs it all, a case for each number of boxes; `progress` is told how far it is, from 0 to 1. */
export async function* measure(
  wish: Wish,
  progress: (done: number, what: string) => void,
  signal: AbortSignal,
): AsyncGenerator<Case> {
  const slow = new Map<string, number>();
  for (const [at, boxes] of wish.sizes.entries()) {
    const part = (share: number, what: string): void => progress((at + share) / wish.sizes.length, what);
    yield await measureOne(wish, boxes, part, signal, slow);
  }
}

interface Running {
  readonly library: Library;
  readonly remote: Remote;
  readonly ready: Ready;
  readonly rounds: number[];
}

async function measureOne(
  { scene, dimensions, libraries }: Wish,
  boxes: number,
  progress: (share: number, what: string) => void,
  signal: AbortSignal,
  slow: Map<string, number>,
): Promise<Case> {
  const setting = { scene, dimensions, boxes };
  const remotes: Remote[] = [];
  const results: Entry[] = [];
  const drop = ({ name, alternative }: Library, why: string): void => {
    results.push({ name, alternative, outcome: { Untimed: { why } } });
  };
  const check = async (library: Library): Promise<Running | undefined> => {
    const known = slow.get(library.name);
    if (known !== undefined && known * boxes > TOO_SLOW) {
      drop(library, "skipped: too slow with fewer boxes");
      return undefined;
    }
    const remote = new Remote(signal);
    remotes.push(remote);
    try {
      const ready = await remote.ask({ ...setting, library: library.name });
      slow.set(library.name, ready.estimate / boxes);
      return { library, remote, ready, rounds: [] };
    } catch (error) {
      signal.throwIfAborted();
      if (error instanceof TooLong) slow.set(library.name, Infinity);
      drop(library, messageOf(error));
      return undefined;
    }
  };

  try {
    let running: Running[] = [];
    const size = boxes.toLocaleString("en");
    progress(0, `the right pairs of ${size} boxes`);
    const right = boxes <= REFERENCE_LIMIT ? await check(bruteForce) : undefined;
    for (const [at, library] of libraries.entries()) {
      progress((0.6 * (at + 1)) / (libraries.length + 1), `${library.name} checked on ${size} boxes`);
      const one = await check(library);
      if (one) running.push(one);
    }
    const agreed = right ?? running.find((one) => running.some((other) => isWitness(one, other)));
    running = running.filter(({ library, ready }) => {
      const why = !agreed
        ? "no second library to check it against"
        : ready.fingerprint !== agreed.ready.fingerprint
          ? `wrong pairs, ${ready.pairs} of them`
          : ready.estimate > TOO_SLOW
            ? `over ${TOO_SLOW / 1000} s`
            : undefined;
      if (why) drop(library, why);
      return !why;
    });

    for (let round = 0; round < ROUNDS; round++) {
      progress(0.6 + (0.4 * round) / ROUNDS, `round ${round + 1} of ${ROUNDS} on ${size} boxes`);
      for (let at = 0; at < running.length; at++) {
        const one = running[(at + round) % running.length];
        if (!one || (round >= 2 && one.ready.estimate > 500)) continue;
        const calls = Math.min(Math.max(1, Math.round(TURN / Math.max(one.ready.estimate, 0.01))), 500);
        one.rounds.push(await one.remote.ask({ calls }));
      }
    }
    const timed = running.map(({ library: { name, alternative }, rounds }): Entry => ({ name, alternative, outcome: { Timed: { median_ns: median(rounds) * 1e6 } } }));
    const reference = right ? bruteForce.name : agreed ? "two libraries that agree" : "nothing";
    return { ...setting, pairs: agreed?.ready.pairs ?? 0, reference, results: [...timed, ...results] };
  } finally {
    for (const remote of remotes) remote.stop();
  }
}

/** Whether two libraries from different packages found the same. */
function isWitness(one: Running, other: Running): boolean {
  return one.library.package !== other.library.package && one.ready.fingerprint === other.ready.fingerprint;
}

class TooLong extends Error {}

/** A library in its worker. */
class Remote {
  readonly #worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });

  constructor(private readonly cancelled: AbortSignal) {}

  stop(): void {
    this.#worker.terminate();
  }

  ask(message: Start): Promise<Ready>;
  ask(message: Time): Promise<number>;
  ask(message: Start | Time): Promise<Ready | number> {
    const over = new AbortController();
    const { signal } = over;
    return new Promise<Ready | number>((resolve, reject) => {
      const timer = setTimeout(() => reject(new TooLong(`over ${LIMIT / 1000} s`)), LIMIT);
      signal.addEventListener("abort", () => clearTimeout(timer));
      this.#worker.addEventListener("message", ({ data }: MessageEvent<Answer>) => ("failed" in data ? reject(new Error(data.failed)) : resolve(data.value)), { signal });
      this.#worker.addEventListener("error", ({ message }) => reject(new Error(message || "its worker did not start")), { signal });
      this.cancelled.addEventListener("abort", () => reject(this.cancelled.reason), { signal });
      if (this.cancelled.aborted) reject(this.cancelled.reason);
      else this.#worker.postMessage(message);
    }).finally(() => over.abort());
  }
}
