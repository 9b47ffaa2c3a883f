// The benchmark in the visitor's own browser: what is chosen, started, shown.

import { Scenes } from "../../../bench/js/src/scenes.js";
import type { Listed } from "../../../bench/js/src/scenes.js";
import { FINDER, WORLD } from "../../../bench/js/libraries/index.js";
import runs from "virtual:benchmark-results";
import scenesUrl from "../generated/bench-scenes.wasm?url";
import { looksOf } from "./looks.ts";
import type { Point } from "./plots.ts";
import { element, fill, select, table } from "./recorded.ts";
import { type Case, duration, fastest, fastestOwn, fastestAlternative, significant, timesOf } from "./results.ts";
import { librariesFor, measure } from "./trial-here.ts";

/** The scenes that everybody can be measured on; the others try robustness. */
const SCENES = ["uniform", "clustered", "mixed", "slab", "tower", "box-pruning", "drift", "fast", "mostly-still", "teleport"];
/** Engines in WebAssembly, megabytes to load: only if they are wanted. */
const HEAVY = /rapier|jolt/;

export class BenchmarkHere {
  readonly #form = element("here") as HTMLFormElement;
  readonly #scene = select("here-scene");
  readonly #dimensions = select("here-dimensions");
  readonly #status = element("here-status");
  readonly #progress = element("here-progress") as HTMLProgressElement;
  readonly #run = element("here-run") as HTMLButtonElement;
  readonly #cancel = element("here-cancel") as HTMLButtonElement;
  readonly #scenes: readonly Listed[];
  #stop: AbortController | undefined;
  #cases: Case[] = [];

  static async start(): Promise<BenchmarkHere> {
    const scenes = await Scenes.start(await (await fetch(scenesUrl)).arrayBuffer());
    const table = scenes.table();
    return new BenchmarkHere(SCENES.flatMap((name) => table.find((scene) => scene.name === name) ?? []));
  }

  private constructor(scenes: readonly Listed[]) {
    this.#scenes = scenes;
    fill(this.#scene, scenes.map(({ name, task }) => [name, task === "track" ? `${name} (motion)` : name]));
    this.#dimensions.disabled = this.#run.disabled = false;
    for (const set of this.#form.querySelectorAll("fieldset")) set.disabled = false;
    this.#scene.addEventListener("change", () => this.#offer());
    this.#dimensions.addEventListener("change", () => this.#offer());
    this.#form.addEventListener("submit", (event) => {
      event.preventDefault();
      void this.#start();
    });
    this.#cancel.addEventListener("click", () => this.#stop?.abort());
    let width = innerWidth;
    addEventListener("resize", () => {
      if (innerWidth === width) return;
      width = innerWidth;
      void this.#draw();
    });
    this.#offer();
  }

  get #listed(): Listed {
    const found = this.#scenes.find(({ name }) => name === this.#scene.value);
    if (!found) throw new Error("no scene is chosen");
    return found;
  }

  /** Offers what there is for the scene. */
  #offer(): void {
    const { dimensions, description, task } = this.#listed;
    element("here-description").textContent = description;
    for (const option of this.#dimensions.options) option.disabled = !dimensions.includes(Number(option.value));
    if (this.#dimensions.selectedOptions[0]?.disabled) this.#dimensions.value = "3";
    const offered = librariesFor(Number(this.#dimensions.value), task).filter(({ name }) => ![FINDER, WORLD].includes(name));
    element("here-alternatives").replaceChildren(
      ...offered.map(({ name }) => {
        const label = document.createElement("label");
        const box = document.createElement("input");
        box.type = "checkbox";
        box.name = "alternative";
        box.value = name;
        box.checked = !HEAVY.test(name);
        label.append(box, HEAVY.test(name) ? `${name} (loads megabytes)` : name);
        return label;
      }),
    );
  }

  #checked(name: string): string[] {
    const boxes = this.#form.querySelectorAll<HTMLInputElement>(`input[name=${name}]:checked`);
    return [...boxes].map(({ value }) => value);
  }

  async #start(): Promise<void> {
    const { name: scene, task } = this.#listed;
    const dimensions = Number(this.#dimensions.value);
    const sizes = this.#checked("size").map(Number);
    const alternatives = this.#checked("alternative");
    if (sizes.length === 0) {
      this.#status.textContent = "Choose at least one number of boxes.";
      return;
    }
    const libraries = librariesFor(dimensions, task).filter(({ name }) => [FINDER, WORLD, ...alternatives].includes(name));
    const stop = (this.#stop = new AbortController());
    this.#busy(true);
    this.#cases = [];
    const progress = (done: number, what: string): void => {
      this.#progress.value = done;
      this.#status.textContent = `Measuring: ${what} ...`;
    };
    try {
      for await (const one of measure({ scene, dimensions, sizes, libraries, isMoving: task === "track" }, progress, stop.signal)) {
        this.#cases.push(one);
        element("here-results").hidden = false;
        element("here-table").replaceChildren(...table(this.#cases));
        await this.#draw();
      }
      this.#progress.value = 1;
      this.#status.textContent = `Done. ${verdict(this.#cases.at(-1))}${asRecorded(this.#cases.at(-1), task === "track" ? "worlds" : "cases")}`;
    } catch (error) {
      this.#progress.value = 0;
      this.#status.textContent = stop.signal.aborted ? "Cancelled." : `The measurement failed: ${String(error)}`;
    } finally {
      this.#busy(false);
    }
  }

  #busy(isBusy: boolean): void {
    for (const set of this.#form.querySelectorAll("fieldset")) set.disabled = isBusy;
    this.#scene.disabled = this.#dimensions.disabled = isBusy;
    // The focus stays on what can be pressed.
    const [on, off] = isBusy ? [this.#cancel, this.#run] : [this.#run, this.#cancel];
    const hadFocus = document.activeElement === off;
    on.disabled = false;
    if (hadFocus) on.focus();
    off.disabled = true;
  }

  async #draw(): Promise<void> {
    const points = this.#cases.flatMap(({ boxes, results }) =>
      results.flatMap((entry): Point[] => {
        const times = timesOf(entry);
        return times ? [{ name: entry.name, alternative: entry.alternative, boxes, value: times.median_ns }] : [];
      }),
    );
    if (points.length === 0) return;
    const { drawLines } = await import("./plots.ts");
    drawLines(element("plot-here"), points, looksOf(points), { unit: "time" });
  }
}

/** The result for the largest number of boxes, in a sentence. */
function verdict(one: Case | undefined): string {
  const own = one && fastestOwn(one);
  if (!one || !own) return "";
  const alternative = fastestAlternative(one);
  const size = `${one.boxes.toLocaleString("en")} boxes`;
  if (!alternative) return `sweep-and-prune finds the ${one.pairs.toLocaleString("en")} pairs of ${size} in ${duration(own)}.`;
  return `${size}: ${fastest(one)} is the fastest. sweep-and-prune takes ${duration(own)}; the fastest alternative, ${alternative.name}, takes ${significant(alternative.ratio)} times as long.`;
}

/** Whether the recorded run of the same case agrees on which library is the fastest, and which alternative. */
function asRecorded(one: Case | undefined, task: "cases" | "worlds"): string {
  const run = runs.find(({ kind }) => kind === "javascript");
  const kept = one && run?.[task].find(({ scene, dimensions, boxes }) => scene === one.scene && dimensions === one.dimensions && boxes === one.boxes);
  const [then, now] = [kept && fastestAlternative(kept), one && fastestAlternative(one)];
  if (!kept || !then || !now || !run) return "";
  const isSame = fastest(kept) === fastest(one) && then.name === now.name;
  const said = `${fastest(kept)} is the fastest, ${then.name} the fastest alternative (${significant(then.ratio)} times as long)`;
  return isSame ? ` The recorded run in Node agrees: ${said}.` : ` In the recorded run in Node, ${said}: another machine, another engine, or a library that was not selected here.`;
}
