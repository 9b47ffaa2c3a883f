// The algorithms side by side, each with its choices and its counters.

import type { Lists, RunnerOptions } from "../experiment/experiment.ts";
import type { Lane } from "../experiment/messages.ts";
import { showCounters } from "../panel/counters.ts";
import { COUNTERS, laneMarkup } from "./markup.ts";

/** How many algorithms can run side by side. */
export const MOST_LANES = 4;
const NOT_COUNTED = "not counted: the library reports only its pairs, and not every algorithm sorts";
const CHOICES = ["algorithm", "sort", "axis"] as const;
/** What is added, the first that is not there yet. */
const ADDED = ["find pairs", "swap-driven sweep", "global pairwise", "sorted pairwise"];

/** The names of a lane's choices in the address. Those of the first algorithm have no number. */
export const keysOf = (lane: number): Readonly<Record<keyof RunnerOptions, string>> =>
  lane === 1 ? { algorithm: "algorithm", sort: "sort", axis: "axis" } : { algorithm: String(lane), sort: `${lane}.sort`, axis: `${lane}.axis` };

export class Lanes {
  #lanes: readonly RunnerOptions[] = [];

  constructor(
    private readonly place: HTMLElement,
    private readonly lists: Lists,
    private readonly changed: (lanes: readonly RunnerOptions[]) => void,
  ) {}

  /** Writes the choices of these algorithms. The axes are those of a world with this number of dimensions. */
  set(lanes: readonly RunnerOptions[], dimensions: number): void {
    const { algorithms, sorts, axes } = this.lists;
    const names = { algorithm: algorithms, sort: sorts, axis: axes.slice(0, axes.length - 3 + dimensions) };
    this.#lanes = lanes.map((lane) => (names.axis.includes(lane.axis) ? lane : { ...lane, axis: names.axis[0] ?? "" }));
    this.place.innerHTML = lanes.map((_, at) => laneMarkup(at + 1)).join("");
    this.#lanes.forEach((lane, at) => {
      for (const choice of CHOICES) {
        const select = this.#select(at, choice);
        select.replaceChildren(...names[choice].map((name) => new Option(name)));
        select.value = lane[choice];
        select.disabled = false;
        select.addEventListener("change", () => {
          this.#lanes = this.#lanes.map((lane, place) => (place === at ? { ...lane, [choice]: select.value } : lane));
          this.#offer(at);
          this.changed(this.#lanes);
        });
      }
      this.#offer(at);
      const remove = this.#lane(at).querySelector<HTMLButtonElement>("button");
      remove?.addEventListener("click", () => {
        this.set(this.#lanes.filter((_, place) => place !== at), dimensions);
        this.changed(this.#lanes);
        this.#select(at - 1, "algorithm").focus();
      });
    });
  }

  get all(): readonly RunnerOptions[] {
    return this.#lanes;
  }

  add(dimensions: number): void {
    const algorithm = ADDED.find((name) => this.#lanes.every((lane) => lane.algorithm !== name)) ?? "find pairs";
    this.set([...this.#lanes, { ...this.#lanes[0]!, algorithm }], dimensions);
    this.changed(this.#lanes);
    this.#select(this.#lanes.length - 1, "algorithm").focus();
  }

  /** `levels` are the mean times. */
  show(results: readonly Lane[] | undefined, levels: readonly (number | null)[]): void {
    this.#lanes.forEach((_, at) => {
      const result = results?.[at];
      const shown = result && "report" in result ? { ...result.report, level: levels[at] ?? null } : undefined;
      showCounters(this.#lane(at), COUNTERS, shown, NOT_COUNTED);
      this.#lane(at).querySelector(".lane-out")!.textContent = result && "out" in result ? result.out : "";
    });
  }

  /** A choice that would change nothing is not offered. */
  #offer(at: number): void {
    const algorithm = this.#lanes[at]?.algorithm ?? "";
    const isPlain = this.lists.algorithms.slice(0, 3).includes(algorithm);
    this.#select(at, "sort").disabled = isPlain;
    this.#select(at, "axis").disabled = isPlain || algorithm.endsWith("every axis");
  }

  #lane(at: number): HTMLElement {
    return this.place.children[at] as HTMLElement;
  }

  #select(at: number, choice: keyof RunnerOptions): HTMLSelectElement {
    return this.#lane(at).querySelector<HTMLSelectElement>(`[data-part="${choice}"]`)!;
  }
}
