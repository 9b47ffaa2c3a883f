// What is kept: one file a machine and day, in the format of bench/README.md.
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { libraries } from "../libraries/index.js";

export const RESULTS = fileURLToPath(new URL("../results", import.meta.url));

/**
 * @typedef {{ median_ns: number, min_ns: number, rounds_ns: number[], ratio: number | null, peak_bytes: number | null }} Times
 * @typedef {{ name: string, alternative: boolean, outcome: { Timed: Times } | { Untimed: { why: string } } }} Entry
 * @typedef {{ scene: string, dimensions: number, boxes: number, pairs: number, reference: string,
 *   revision: string | null, load: number | null, results: Entry[] }} Case
 * @typedef {{ date: string, machine: any, node: string, versions: Record<string, string>,
 *   how: Record<string, string>, cases: Case[], worlds: Case[] }} Kept
 */

/**
 * The file of this machine and day, with what is in it so far.
 *
 * @param {any} machine
 * @param {string | undefined} path
 */
export function open(machine, path) {
  const date = new Date().toISOString().slice(0, 10);
  const name = machine.cpu.toLowerCase().match(/[a-z0-9]+/g).join("-");
  const file = path ?? join(RESULTS, `${name}-${date}.json`);
  /** @type {Kept} */
  const kept = read(file) ?? { date, machine, node: "", versions: {}, how: {}, cases: [], worlds: [] };
  Object.assign(kept, { date, machine, node: `Node ${process.versions.node}, V8 ${process.versions.v8}` });
  for (const { name, package: from, how } of libraries) {
    kept.how[name] = how;
    const version = from && versionOf(from);
    if (version) kept.versions[name] = version;
  }
  return { kept, file };
}

/** @returns {Kept | undefined} */
export function read(/** @type {string} */ file) {
  try {
    return JSON.parse(readFileSync(file, "utf8"));
  } catch (error) {
    if (/** @type {any} */ (error).code === "ENOENT") return undefined;
    throw error;
  }
}

/** All that were kept, the newest first. */
export function all() {
  const names = readdirSync(RESULTS).filter((name) => name.endsWith(".json"));
  const files = names.map((name) => /** @type {Kept} */ (read(join(RESULTS, name))));
  return files.sort((a, b) => b.date.localeCompare(a.date));
}

export function write(/** @type {string} */ file, /** @type {Kept} */ kept) {
  mkdirSync(dirname(file), { recursive: true });
  writeFileSync(file, `${JSON.stringify(kept, null, 1)}\n`);
}

/**
 * Adds a case, or replaces the one of the same boxes.
 *
 * @param {Case[]} cases
 * @param {Case} one
 */
export function put(cases, one) {
  const isSame = (/** @type {Case} */ other) =>
    other.scene === one.scene && other.dimensions === one.dimensions && other.boxes === one.boxes;
  const at = cases.findIndex(isSame);
  if (at < 0) cases.push(one);
  else cases[at] = one;
}

/** @returns {Times | undefined} */
export function timesOf(/** @type {Case} */ { results }, /** @type {string} */ name) {
  const outcome = results.find((entry) => entry.name === name)?.outcome;
  return outcome && "Timed" in outcome ? outcome.Timed : undefined;
}

/** The median of at least one number. */
export function median(/** @type {readonly number[]} */ numbers) {
  const sorted = [...numbers].sort((a, b) => a - b);
  const [low, high] = [sorted[(sorted.length - 1) >> 1], sorted[sorted.length >> 1]];
  return (/** @type {number} */ (low) + /** @type {number} */ (high)) / 2;
}

/** The version of a package, or nothing if it is not installed. */
export function versionOf(/** @type {string} */ name) {
  for (const from of createRequire(import.meta.url).resolve.paths(name) ?? []) {
    const found = read(join(from, name, "package.json"));
    if (found) return /** @type {any} */ (found).version;
  }
  return undefined;
}
