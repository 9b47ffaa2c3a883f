// The benchmark in the visitor's own browser: what is chosen, started, shown.

import { Scenes } from "../../../bench/js/src/scenes.js";
import type { Listed } from "../../../bench/js/src/scenes.js";
import { FINDER, type Library, libraries, WORLD } from "../../../bench/js/libraries/index.js";
import scenesUrl from "../generated/bench-scenes.wasm?url";
import { formatCount } from "../panel/counters.ts";
import { bars } from "./bars.ts";
import { type Case, duration, fastest, fastestOther, fastestOwn, significant } from "./results.ts";
import { measure } from "./trial-here.ts";

/** The scenes that everybody can be measured on; the others try robustness. */
const SCENES = ["uniform", "clustered", "mixed", "slab", "tower", "box-pruning", "drift", "fast", "mostly-still", "teleport"];
/** The libraries that are measured, the best known first, five of them beside sweep-and-prune; engines that load megabytes are left out. */
const MEASURED = ["plain sweep", "flatbush", "rbush", "box-intersect", "matter-js", "rbush-3d", "cannon-es", "detect-collisions", "planck", "p2-es"];
const MOST = 5;

function measured(dimensions: number, task: Listed["task"]): Library[] {
  const all = libraries.filter((one) => one.dimensions.includes(dimensions) && one.tasks.includes(task));
  const others = MEASURED.flatMap((name) => all.find((library) => library.name === name) ?? []).slice(0, MOST);
  return [...all.filter(({ name }) => name === FINDER || name === WORLD), ...others];
}

export class BenchmarkHere {
  readonly #form = element<HTMLFormElement>("here");
  readonly #scene = element<HTMLSelectElement>("here-scene");
  readonly #dimensions = element<HTMLSelectElement>("here-dimensions");
  readonly #status = element("here-status");
  readonly #progress = element<HTMLProgressElement>("here-progress");
  readonly #run = element<HTMLButtonElement>("here-run");
  readonly #cancel = element<HTMLButtonElement>("here-cancel");
  #stop: AbortController | undefined;
  #cases: Case[] = [];

  static async start(): Promise<BenchmarkHere> {
    const scenes = await Scenes.start(await (await fetch(scenesUrl)).arrayBuffer());
    const table = scenes.table();
    return new BenchmarkHere(SCENES.flatMap((name) => table.find((scene) => scene.name === name) ?? []));
  }

  private constructor(private readonly scenes: readonly Listed[]) {
    this.#scene.replaceChildren(...scenes.map(({ name, task }) => new Option(task === "track" ? `${name} (motion)` : name, name)));
    this.#scene.disabled = this.#dimensions.disabled = this.#run.disabled = false;
    for (const set of this.#form.querySelectorAll("fieldset")) set.disabled = false;
    this.#scene.addEventListener("change", () => this.#offer());
    this.#dimensions.addEventListener("change", () => this.#offer());
    this.#form.addEventListener("submit", (event) => {
      event.preventDefault();
      void this.#start();
    });
    this.#cancel.addEventListener("click", () => this.#stop?.abort());
    this.#offer();
  }

  get #listed(): Listed {
    return this.scenes.find(({ name }) => name === this.#scene.value)!;
  }

  /** Offers what there is for the scene. */
  #offer(): void {
    const { dimensions, description, task } = this.#listed;
    element("here-description").textContent = description;
    for (const option of this.#dimensions.options) option.disabled = !dimensions.includes(Number(option.value));
    if (this.#dimensions.selectedOptions[0]?.disabled) this.#dimensions.value = "3";
    const names = measured(Number(this.#dimensions.value), task).map(({ name }) => name);
    element("here-alternatives").textContent = `Measured: ${names.join(", ")}.`;
  }

  async #start(): Promise<void> {
    const { name: scene, task } = this.#listed;
    const dimensions = Number(this.#dimensions.value);
    const sizes = [...this.#form.querySelectorAll<HTMLInputElement>("input[name=size]:checked")].map(({ value }) => Number(value));
    if (sizes.length === 0) {
      this.#status.textContent = "Choose at least one number of boxes.";
      return;
    }
    const stop = (this.#stop = new AbortController());
    this.#busy(true);
    this.#cases = [];
    const progress = (done: number, what: string): void => {
      this.#progress.value = done;
      this.#status.textContent = `Measuring: ${what} ...`;
    };
    try {
      for await (const one of measure({ scene, dimensions, sizes, libraries: measured(dimensions, task) }, progress, stop.signal)) {
        this.#cases.push(one);
        element("here-results").innerHTML = this.#cases.map((one) => bars(one, `${formatCount(one.boxes)} boxes, ${formatCount(one.pairs)} pairs, checked against ${one.reference}`, one.results)).join("");
      }
      this.#progress.value = 1;
      this.#status.textContent = `Done. ${verdict(this.#cases.at(-1))}`;
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
}

/** The result for the largest number of boxes, in a sentence. */
function verdict(one: Case | undefined): string {
  const own = one && fastestOwn(one);
  if (!one || !own) return "";
  const alternative = fastestOther(one);
  const size = `${formatCount(one.boxes)} boxes`;
  if (!alternative) return `sweep-and-prune finds the ${formatCount(one.pairs)} pairs of ${size} in ${duration(own)}.`;
  return `${size}: ${fastest(one)} is the fastest. sweep-and-prune takes ${duration(own)}; the fastest alternative, ${alternative.name}, takes ${significant(alternative.ratio)} times as long.`;
}

function element<E extends HTMLElement = HTMLElement>(id: string): E {
  return document.querySelector<E>(`#${id}`)!;
}
