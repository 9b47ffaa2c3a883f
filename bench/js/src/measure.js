// Measures one case: a scene, a number of dimensions, a number of boxes. Every library runs in a
// process of its own, its pairs are checked before it is timed, and every round times all of them
// in turn, so that what slows the machine slows them all; ratios are taken within a round.
import { fileURLToPath } from "node:url";
import { FINDER, WORLD } from "../libraries/index.js";
import { load, revision } from "./machine.js";
import { median } from "./record.js";
import { library as bruteForce, REFERENCE_LIMIT } from "./reference.js";
import { NoAnswer, Remote } from "./remote.js";

const WORKER = fileURLToPath(new URL("worker.js", import.meta.url));

/** A library's turn in a round takes about so long, in milliseconds. */
const TURN = 20;
/** A library that takes longer than this (ms) for all scenes of a round takes fewer scenes. */
const LONGEST_ROUND = 1000;
/** The fewest scenes of a round. */
const FEWEST_SCENES = 10;
/** Shorter calls are timed together until they take so long. */
const BATCH = 1;
/** No library takes part in more rounds once it has taken so long, but for the first three. */
const PATIENCE = 1000;
/** A library whose call takes this long (ms) needs no warm-up after its pairs were checked. */
const LONG = 200;
/** A library this many times as slow as the fastest alternative is not measured with ten times as many boxes. */
const BEHIND = 4;

/** The names of sweep-and-prune compiled for this machine. */
export const NATIVE = "native";
export const NATIVE_WORLD = "native, BroadPhase";

/**
 * @typedef {import("./record.js").Case} Case
 * @typedef {import("./record.js").Entry} Entry
 * @typedef {{ name: string, alternative: boolean, package: string }} Library
 * @typedef {{ library: Library, remote: Remote, fingerprint: string, pairs: number, peak_bytes: number | null,
 *   estimate: number, varied: number, rounds: number[], spent: number }} Running
 */

export class Measurement {
  /** How long libraries took at how many boxes of a scene: what more boxes will take at least. */
  #slow = new Map();
  /** The fastest alternative so far on a scene: its name, at how many boxes, and how long it took. */
  #fastest = new Map();
  /** What was found in the case under way, by those that are too slow to be timed too. */
  #witnesses = /** @type {{ library: Library, fingerprint: string, pairs: number }[]} */ ([]);

  /**
   * @param {{ rounds: number, limit: number, wasm: string, native: string | undefined }} options
   *   `limit` in milliseconds
   * @param {(done: number) => void} progress
   */
  constructor(options, progress) {
    this.options = options;
    this.progress = progress;
  }

  /**
   * Takes from a result how long libraries take: a library that is too slow is not asked again.
   *
   * @param {Case} earlier
   * @param {readonly Library[]} libraries
   */
  learn({ scene, dimensions, boxes, results }, libraries) {
    for (const { name, outcome } of results) {
      const library = libraries.find((one) => one.name === name);
      if (!library || !("Timed" in outcome)) continue;
      const took = outcome.Timed.median_ns / 1e6;
      this.#slow.set(`${scene} ${dimensions} ${name}`, { boxes, took });
      const fastest = this.#fastest.get(`${scene} ${dimensions}`);
      if (isAlternative({ library }) && !(fastest?.boxes === boxes && fastest.took < took)) {
        this.#fastest.set(`${scene} ${dimensions}`, { name, boxes, took });
      }
    }
  }

  /**
   * @param {import("./scenes.js").Library} scene
   * @param {number} dimensions
   * @param {number} boxes
   * @param {readonly import("../libraries/index.js").Library[]} libraries
   * @returns {Promise<Case | string>} why there is nothing, if there is nothing
   */
  async measure(scene, dimensions, boxes, libraries) {
    const setting = [scene.name, String(dimensions), String(boxes)];
    /** @type {Running[]} */
    let running = [];
    /** @type {Entry[]} */
    const results = [];
    this.#witnesses = [];
    const drop = (/** @type {Library} */ { name, alternative }, /** @type {string} */ why) =>
      results.push({ name, alternative, outcome: { Untimed: { why } } });

    try {
      const right = boxes <= REFERENCE_LIMIT ? await this.#reference(setting) : undefined;
      // Two at a time: nothing is timed yet except libraries that are too slow.
      for (let at = 0; at < libraries.length; at += 2) {
        const two = libraries.slice(at, at + 2);
        const checked = await Promise.all(two.map((library) => this.#check(library, setting)));
        for (const [i, one] of checked.entries()) {
          if (typeof one === "string") drop(/** @type {Library} */ (two[i]), one);
          else running.push(one);
        }
        this.progress((0.5 * (at + 2)) / (libraries.length + 2));
      }
      const reference = right ?? agreement(this.#witnesses);
      if (!reference) return "no two libraries agree";
      for (const one of running) {
        if (one.fingerprint !== reference.fingerprint) {
          drop(one.library, `other pairs, ${one.pairs.toLocaleString("en")} of them`);
          one.remote.stop();
        }
      }
      running = running.filter((one) => one.fingerprint === reference.fingerprint);
      running.push(...(await this.#natives(scene, setting, reference.pairs)));
      await this.#rounds(running, drop);

      const base = (name) => running.find((one) => one.library.name === name)?.rounds;
      const own = (scene.task === "track" ? base(WORLD) : undefined) ?? base(FINDER) ?? [];
      const timed = running.filter((one) => one.rounds.length > 0);
      results.unshift(
        ...timed.map((one) => ({ name: one.library.name, alternative: one.library.alternative, outcome: { Timed: times(one, own) } })),
      );
      /** @type {Case} */
      const measured = {
        scene: scene.name,
        dimensions,
        boxes,
        pairs: reference.pairs,
        reference: reference.how,
        revision: revision(),
        load: load(),
        results,
      };
      // From the rounds: in the few calls before them a library may have had to do what it does seldom.
      this.learn(measured, libraries);
      return measured;
    } finally {
      for (const one of running) one.remote.stop();
    }
  }

  #start(/** @type {string} */ name, /** @type {string[]} */ setting) {
    return new Remote(process.execPath, [WORKER, name, ...setting], { SCENES_WASM: this.options.wasm });
  }

  async #reference(/** @type {string[]} */ setting) {
    const remote = this.#start(bruteForce.name, setting);
    try {
      await remote.ask("", 60_000);
      const { fingerprint, pairs } = await remote.ask("check", 60_000);
      return { fingerprint, pairs, how: bruteForce.name };
    } finally {
      remote.stop();
    }
  }

  /**
   * A library that has found the pairs once and had its warm-up, or why it takes no part.
   *
   * @param {Library} library
   * @param {string[]} setting
   * @returns {Promise<Running | string>}
   */
  async #check(library, setting) {
    const { limit } = this.options;
    const [scene, dimensions, boxes] = setting;
    const key = `${scene} ${dimensions} ${library.name}`;
    const known = this.#slow.get(key);
    // Nothing here takes less than proportionally longer for more boxes.
    if (known && (known.took * Number(boxes)) / known.boxes > limit) {
      return `over ${limit / 1000} s, as its time for ${known.boxes.toLocaleString("en")} boxes shows`;
    }
    const fastest = this.#fastest.get(`${scene} ${dimensions}`);
    if (known && isAlternative({ library }) && fastest?.boxes === known.boxes && 10 * known.boxes <= Number(boxes)) {
      const behind = known.took / fastest.took;
      if (behind > BEHIND) return `${behind.toFixed(1)} times as slow as ${fastest.name} with ${known.boxes.toLocaleString("en")} boxes`;
    }
    const remote = this.#start(library.name, setting);
    try {
      await remote.ask("", 10_000 + 4 * limit);
      const { fingerprint, pairs, peak_bytes, longest, varied } = await remote.ask("check", 4 * limit);
      this.#witnesses.push({ library, fingerprint, pairs });
      if (longest > 2 * limit) throw new NoAnswer(`over ${limit / 1000} s`);
      if (longest < LONG) await remote.ask("warm-up", 10_000 + limit);
      const repeats = longest < LONG ? 3 : 1;
      const estimate = median((await remote.ask(`time ${repeats} 1`, 10_000 + repeats * limit)).ms);
      if (estimate > limit) throw new NoAnswer(`over ${limit / 1000} s`);
      return { library, remote, fingerprint, pairs, peak_bytes, estimate, varied, rounds: [], spent: 0 };
    } catch (error) {
      remote.stop();
      if (!(error instanceof NoAnswer)) throw error;
      if (error.message.startsWith("over")) this.#slow.set(key, { boxes: Number(boxes), took: Infinity });
      return error.message.startsWith("over") ? `over ${limit / 1000} s` : error.message;
    }
  }

  /**
   * The library compiled for this machine, if it was.
   *
   * @param {import("./scenes.js").Library} scene
   * @param {string[]} setting
   * @param {number} expected how many pairs there are
   * @returns {Promise<Running[]>}
   */
  async #natives(scene, setting, expected) {
    const { native } = this.options;
    if (!native) return [];
    const names = scene.task === "track" ? [NATIVE, NATIVE_WORLD] : [NATIVE];
    return Promise.all(
      names.map(async (name) => {
        const remote = new Remote(native, name === NATIVE_WORLD ? [...setting, "world"] : setting);
        await remote.ask("", 20_000);
        const { pairs } = await remote.ask("check", 20_000);
        if (pairs !== expected) throw new Error(`${name} finds ${pairs} pairs, not ${expected}: ${setting.join(" ")}`);
        const { ns } = await remote.ask("time 3 1", 20_000);
        const library = { name, alternative: false, package: "" };
        return { library, remote, fingerprint: "", pairs: 0, peak_bytes: null, estimate: median(ns) / 1e6, varied: 0, rounds: [], spent: 0 };
      }),
    );
  }

  /**
   * @param {Running[]} running
   * @param {(library: Library, why: string) => void} drop
   */
  async #rounds(running, drop) {
    const { rounds, limit } = this.options;
    const lost = new Set();
    for (let round = 0; round < rounds; round++) {
      for (let at = 0; at < running.length; at++) {
        // Each round begins with another.
        const one = /** @type {Running} */ (running[(at + round) % running.length]);
        if (lost.has(one) || (round >= 3 && one.spent > PATIENCE)) continue;
        const estimate = Math.max(one.estimate, 0.01);
        const batch = Math.ceil(BATCH / estimate);
        const varied = Math.max(...running.map((each) => each.varied));
        const scenes = Math.max(FEWEST_SCENES, Math.min(varied, Math.round(LONGEST_ROUND / estimate)));
        const repeats = varied ? Math.ceil(scenes / batch) : Math.max(1, Math.round(TURN / (batch * estimate)));
        try {
          // The limit is for what takes too long once; here it only guards against hanging.
          const { ms, ns } = await one.remote.ask(`time ${repeats} ${batch}`, 10 * limit + 10_000);
          const all = ms ?? ns.map((/** @type {number} */ time) => time / 1e6);
          one.spent += all.reduce((/** @type {number} */ sum, /** @type {number} */ time) => sum + time, 0) * batch;
          one.rounds[round] = (varied ? mean(all) : median(all)) * 1e6;
        } catch (error) {
          if (!(error instanceof NoAnswer)) throw error;
          lost.add(one);
          one.rounds.length = 0;
          drop(one.library, error.message);
        }
      }
      this.progress(0.5 + (0.5 * (round + 1)) / rounds);
    }
  }
}

/** Whether it is another library: neither sweep-and-prune nor the plain sweep. */
function isAlternative(/** @type {{ library: Library }} */ { library }) {
  return library.alternative && library.package !== "";
}

/**
 * The pairs that sweep-and-prune and an alternative agree on, or two alternatives.
 *
 * @param {readonly { library: Library, fingerprint: string, pairs: number }[]} witnesses
 */
function agreement(witnesses) {
  for (const one of witnesses) {
    const other = witnesses.find((it) => it !== one && it.library.package !== one.library.package && it.fingerprint === one.fingerprint);
    if (other) return { fingerprint: one.fingerprint, pairs: one.pairs, how: `${one.library.name} and ${other.library.name} agree` };
  }
  return undefined;
}

/**
 * @param {Running} one
 * @param {number[]} own
 * @returns {import("./record.js").Times}
 */
function times({ rounds, peak_bytes }, own) {
  const ratios = rounds.flatMap((time, round) => (own[round] === undefined ? [] : [time / own[round]]));
  return {
    median_ns: median(rounds),
    min_ns: Math.min(...rounds),
    rounds_ns: rounds,
    ratio: ratios.length > 0 ? median(ratios) : null,
    peak_bytes,
  };
}

/** The mean: different scenes take different times, so all of them count. */
function mean(/** @type {number[]} */ numbers) {
  return numbers.reduce((sum, number) => sum + number, 0) / numbers.length;
}
