import { readAddress, numberWithin, writeAddress } from "../experiment/address.ts";
import { type BoxColors, drawBoxes, type Window2, windowOf } from "../experiment/box-picture.ts";
import type { RunnerOptions, Lists, WorldOptions } from "../experiment/experiment.ts";
import { onAwake } from "../falling/awake.ts";
import { formatCount } from "../falling/counters.ts";
import { bindSlider } from "../falling/slider.ts";
import { drawLines } from "../plot/line-plot.ts";
import { onThemeChange } from "../shell/theme.ts";
import { LANE_COUNTERS, LANES } from "./markup.ts";
import type { FromRace, Lane, RaceFrame, ToRace } from "./messages.ts";
import { MEASURES, type Measure, RaceRecord, SHOWN } from "./record.ts";
import { countersOf, verdict } from "./wording.ts";

/** The numbers of boxes that the slider offers. */
const BOXES = [10, 20, 50, 100, 200, 500, 1_000, 2_000, 5_000, 10_000, 20_000];
const LARGEST_SEED = 2 ** 32 - 1;
/** Numbers and lines that change more often than this cannot be read. */
const SHOW_MS = 150;
/** An empty place. */
const NONE = "none";
const NOT_COUNTED = "not counted: the library reports only its pairs, and not every algorithm sorts";

/** Who races, and where, unless the address says otherwise. */
const DEFAULTS = {
  dimensions: "2", scene: "uniform", motion: "drift", boxes: "1000", seed: "1", plot: "ms", log: "yes",
  "1": "global pairwise", "1.sort": "insertion sort", "1.axis": "largest variance",
  "2": "sorted pairwise", "2.sort": "insertion sort", "2.axis": "largest variance",
  "3": "swap-driven sweep", "3.sort": "insertion sort", "3.axis": "largest variance",
  "4": "find pairs", "4.sort": "insertion sort", "4.axis": "largest variance",
};

type Key = keyof typeof DEFAULTS;
interface Colors {
  readonly lanes: readonly string[];
  readonly boxes: BoxColors;
  readonly ink: string;
  readonly muted: string;
  readonly grid: string;
}

type LaneChoice = "algorithm" | "sort" | "axis";

/**
 * `<race-track>`: up to four runners on the same boxes, in lockstep, on a thread of their own.
 * Its inside is written by `markup.ts`.
 */
export class RaceTrack extends HTMLElement {
  readonly #worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });
  #lists!: Lists;
  #state = readAddress<Key>(DEFAULTS);
  #run = 0;
  #record = new RaceRecord(0);
  #frame: RaceFrame | undefined;
  #wanted = !matchMedia("(prefers-reduced-motion: reduce)").matches;
  #awake = false;
  #shownAt = -Infinity;
  #asked = false;
  #colors: Colors | undefined;
  /** What the picture shows: where all boxes were at first. */
  #view: Window2 | undefined;
  #left = new AbortController();

  connectedCallback(): void {
    this.#worker.addEventListener("message", ({ data }: MessageEvent<FromRace>) => this.#receive(data));
    this.#worker.addEventListener("error", ({ message }) => this.#say(message));
    const { signal } = this.#left;
    onThemeChange(() => {
      this.#colors = undefined;
      this.#requestShow();
    }, signal);
    const resized = new ResizeObserver(() => {
      this.#view = undefined;
      this.#requestShow();
    });
    for (const part of ["picture", "plot"]) resized.observe(this.#part(part));
    onAwake(this, (awake) => {
      this.#awake = awake;
      this.#pace();
    }, signal);
  }

  disconnectedCallback(): void {
    this.#left.abort();
    this.#worker.terminate();
  }

  // Controls

  #setUp(lists: Lists): void {
    this.#lists = lists;
    this.#bindChoice("dimensions", undefined, () => this.#fillScenes());
    this.#fillScenes();
    this.#bindChoice("scene");
    this.#bindChoice("motion", lists.motions.map(({ name }) => name));
    bindSlider({
      slider: this.#part<HTMLInputElement>("boxes"),
      output: this.#part("boxes-value"),
      values: BOXES,
      value: this.#world().boxes,
      format: formatCount,
      changed: (boxes) => this.#change("boxes", String(boxes)),
    });
    const seed = this.#part<HTMLInputElement>("seed");
    seed.value = String(this.#world().seed);
    seed.addEventListener("change", () => {
      seed.value = String(numberWithin(String(Math.round(seed.valueAsNumber)), 0, LARGEST_SEED, 1));
      this.#change("seed", seed.value);
    });
    for (let lane = 1; lane <= LANES; lane++) {
      const names = lane > 2 ? [...lists.algorithms, NONE] : lists.algorithms;
      this.#bindLane(lane, "algorithm", names);
      this.#bindLane(lane, "sort", lists.sorts);
      this.#bindLane(lane, "axis", lists.axes);
    }
    this.#bindPlot();
    this.#bindButtons();
    for (const control of this.querySelectorAll<HTMLInputElement>(":disabled")) control.disabled = false;
    this.#begin();
    this.#pace();
  }

  #bindChoice(key: "dimensions" | "scene" | "motion", names?: readonly string[], before = (): void => {}): void {
    const select = this.#part<HTMLSelectElement>(key);
    if (names) select.replaceChildren(...names.map((name) => new Option(name)));
    this.#choose(select, key);
    select.addEventListener("change", () => {
      this.#state[key] = select.value;
      before();
      this.#change(key, select.value);
    });
  }

  /** The scenes that exist in the chosen dimensions. */
  #fillScenes(): void {
    const dimensions = Number(this.#state.dimensions);
    const there = this.#lists.scenes.filter(({ dimensions: [least, most] }) => least <= dimensions && dimensions <= most);
    const select = this.#part<HTMLSelectElement>("scene");
    select.replaceChildren(...there.map(({ name }) => new Option(name)));
    this.#choose(select, "scene");
    const axes = this.#lists.axes.slice(0, this.#lists.axes.length - 3 + dimensions);
    for (let lane = 1; lane <= LANES; lane++) {
      const axis = this.#lanePart<HTMLSelectElement>(lane, "axis");
      axis.replaceChildren(...axes.map((name) => new Option(name)));
      this.#choose(axis, `${lane}.axis` as Key);
    }
  }

  #bindLane(lane: number, part: LaneChoice, names: readonly string[]): void {
    const select = this.#lanePart<HTMLSelectElement>(lane, part);
    const key = (part === "algorithm" ? String(lane) : `${lane}.${part}`) as Key;
    if (part !== "axis") select.replaceChildren(...names.map((name) => new Option(name)));
    this.#choose(select, key);
    select.addEventListener("change", () => this.#change(key, select.value));
  }

  /** Shows what the state says, or the default where there is no such thing, or the first. */
  #choose(select: HTMLSelectElement, key: Key): void {
    const names = [...select.options].map(({ value }) => value);
    const name = [this.#state[key], DEFAULTS[key], names[0] ?? ""].find((name) => names.includes(name)) ?? "";
    select.value = this.#state[key] = name;
  }

  #bindPlot(): void {
    const measure = this.#part<HTMLSelectElement>("measure");
    this.#choose(measure, "plot");
    measure.addEventListener("change", () => this.#keep("plot", measure.value));
    const log = this.#part<HTMLInputElement>("log");
    log.checked = this.#state.log !== "no";
    log.addEventListener("change", () => this.#keep("log", log.checked ? "yes" : "no"));
  }

  #bindButtons(): void {
    const onClick = (part: string, act: () => void): void => this.#part(part).addEventListener("click", act);
    onClick("play", () => {
      this.#wanted = !this.#wanted;
      this.#pace();
    });
    onClick("step", () => {
      this.#wanted = false;
      this.#pace();
      this.#send({ type: "step" });
    });
    onClick("reset", () => this.#begin());
  }

  #keep(key: Key, text: string): void {
    this.#state[key] = text;
    writeAddress(this.#state, DEFAULTS);
    this.#requestShow();
  }

  #change(key: Key, text: string): void {
    this.#keep(key, text);
    this.#begin();
  }

  #world(): WorldOptions {
    const { dimensions, scene, motion, boxes, seed } = this.#state;
    return {
      dimensions: dimensions === "3" ? 3 : 2,
      scene,
      motion,
      boxes: Math.round(numberWithin(boxes, 1, 20_000, Number(DEFAULTS.boxes))),
      seed: Math.round(numberWithin(seed, 0, LARGEST_SEED, 1)),
      size: 1,
      spread: 1,
    };
  }

  /** Who races, with the lanes they are in. */
  #runners(): { lane: number; options: RunnerOptions }[] {
    const lanes = Array.from({ length: LANES }, (_, place) => {
      const part = (name: string): string => this.#state[`${place + 1}${name}` as Key];
      return { lane: place + 1, options: { algorithm: part(""), sort: part(".sort"), axis: part(".axis") } };
    });
    return lanes.filter(({ options }) => options.algorithm !== NONE);
  }

  #begin(): void {
    const runners = this.#runners();
    this.#record = new RaceRecord(runners.length);
    this.#frame = undefined;
    this.#view = undefined;
    this.#part("alarm").textContent = "";
    // Nothing of the race before stays, however long the first step takes.
    this.#part("message").textContent = "Working …";
    this.#part("moment").textContent = "Working …";
    this.#part("verdict").textContent = "\u00a0";
    const picture = this.#part<HTMLCanvasElement>("picture");
    picture.getContext("2d")?.clearRect(0, 0, picture.width, picture.height);
    delete this.dataset["step"];
    this.#showNumbers(undefined);
    const { scenes, motions } = this.#lists;
    const about = [scenes.find(({ name }) => name === this.#state.scene), motions.find(({ name }) => name === this.#state.motion)];
    this.#part("about").textContent = about.map((item) => item?.description ?? "").join(" ");
    this.#send({ type: "begin", run: ++this.#run, world: this.#world(), runners: runners.map(({ options }) => options) });
    this.#describe();
    this.#requestShow();
  }

  #pace(): void {
    if (!this.#lists) return;
    this.#send({ type: "pace", running: this.#wanted && this.#awake });
    this.#part("play").textContent = this.#wanted ? "Pause" : "Play";
    this.#describe();
    this.#requestShow();
  }

  #send(message: ToRace): void {
    this.#worker.postMessage(message);
  }

  // What comes from the race

  #receive(message: FromRace): void {
    switch (message.type) {
      case "ready":
        this.#setUp(message.lists);
        break;
      case "refused":
        if (message.run === this.#run) this.#refuse(message.reason);
        break;
      case "frame":
        if (message.run === this.#run) this.#add(message);
        break;
      case "failed":
        this.#say(`That did not work: ${message.message}`);
        break;
    }
  }

  #refuse(reason: string): void {
    this.#part("message").textContent = reason;
    this.#part("moment").textContent = "Not begun";
    this.dataset["step"] = "refused";
    this.#requestShow();
  }

  #add(frame: RaceFrame): void {
    if (!this.#frame) this.#part("message").textContent = "";
    const wereOut = this.#frame?.lanes.map((lane) => "out" in lane);
    this.#frame = frame;
    this.#record.add(frame);
    const { disagreed } = this.#record;
    if (disagreed) this.#alarm(disagreed.step, disagreed.lanes);
    if (frame.lanes.some((lane, place) => "out" in lane && wereOut?.[place] === false)) this.#describe();
    this.#requestShow();
  }

  #alarm(step: number, places: readonly number[]): void {
    const lanes = places.map((place) => `lane ${this.#runners()[place]?.lane}`).join(" and ");
    this.#part("alarm").textContent = `In step ${formatCount(step)}, ${lanes} found other pairs than the first one. One of them is wrong.`;
  }

  #requestShow(): void {
    if (this.#asked || !this.#lists) return;
    this.#asked = true;
    requestAnimationFrame(() => {
      this.#asked = false;
      this.#show();
    });
  }

  #show(): void {
    const frame = this.#frame;
    const now = performance.now();
    if (frame) this.#drawPicture(frame);
    if (!this.#wanted || now - this.#shownAt >= SHOW_MS || frame === undefined) {
      this.#shownAt = now;
      this.#showNumbers(frame);
      this.#drawPlot();
      if (!this.#wanted) this.#describe();
    }
    if (frame) this.#send({ type: "seen", run: frame.run });
  }

  #showNumbers(frame: RaceFrame | undefined): void {
    const runners = this.#runners();
    for (let lane = 1; lane <= LANES; lane++) {
      const place = runners.findIndex((runner) => runner.lane === lane);
      this.#showLane(lane, place, frame?.lanes[place]);
    }
    if (!frame) return;
    this.dataset["step"] = String(frame.step);
    this.#part("moment").textContent = `Step ${formatCount(frame.step)}`;
    const levels = runners.map(({ options }, place) => ({ name: options.algorithm, ms: frame.lanes[place] && "report" in frame.lanes[place] ? this.#record.level(place, MEASURES[0]) : null }));
    this.#part("verdict").textContent = verdict(frame, this.#record, levels);
  }

  #showLane(lane: number, place: number, result: Lane | undefined): void {
    const ms = place < 0 ? null : this.#record.level(place, MEASURES[0]);
    const texts = countersOf(result, ms);
    for (const { key } of LANE_COUNTERS) {
      const cell = this.#find(`[data-lane="${lane}"] [data-counter="${key}"] dd`);
      cell.textContent = texts[key] ?? "–";
      cell.title = texts[key] === null && result && "report" in result ? NOT_COUNTED : "";
    }
    this.#lanePart(lane, "out").textContent = result && "out" in result ? result.out : "";
    // A choice that would change nothing is not offered.
    const algorithm = this.#state[String(lane) as Key];
    const plain = [NONE, ...this.#lists.algorithms.slice(0, 3)].includes(algorithm);
    this.#lanePart<HTMLSelectElement>(lane, "sort").disabled = plain;
    this.#lanePart<HTMLSelectElement>(lane, "axis").disabled = plain || algorithm.endsWith("every axis");
  }

  // Pictures

  #drawPicture({ boxes, pairs }: RaceFrame): void {
    const canvas = this.#part<HTMLCanvasElement>("picture");
    const { clientWidth: width, clientHeight: height } = canvas;
    const dimensions = this.#world().dimensions;
    const colors = (this.#colors ??= this.#readColors());
    this.#view ??= windowOf(boxes, dimensions, width, height);
    drawBoxes(canvas, { width, height }, this.#view, boxes, dimensions, pairs, colors.boxes);
  }

  #drawPlot(): void {
    const canvas = this.#part<HTMLCanvasElement>("plot");
    const { lanes, ink, muted, grid } = (this.#colors ??= this.#readColors());
    const measure: Measure = MEASURES.find(({ key }) => key === this.#state.plot) ?? MEASURES[0];
    const lines = this.#runners().map(({ lane, options }, place) => ({
      name: options.algorithm,
      color: lanes[lane - 1] ?? ink,
      values: this.#record.line(place, measure),
    }));
    drawLines(canvas, canvas.clientWidth, canvas.clientHeight, {
      lines, first: this.#record.first, steps: SHOWN, logarithmic: this.#state.log !== "no", label: measure.unit, ink, muted, grid,
    });
  }

  #readColors(): Colors {
    const style = getComputedStyle(this);
    const color = (name: string): string => style.getPropertyValue(`--${name}`).trim();
    const lanes = [...this.querySelectorAll("legend")].map((legend) => getComputedStyle(legend).borderTopColor);
    const boxes = { box: color("ramp-1"), highlighted: color("ramp-4"), line: color("stage") };
    return { lanes, boxes, ink: color("ink"), muted: color("muted"), grid: color("line") };
  }

  // What is told in words

  /** Tells what is going on: seldom enough to be read out. */
  #describe(): void {
    const { boxes, scene, motion } = this.#world();
    const out = this.#frame?.lanes.filter((lane) => "out" in lane).length ?? 0;
    const who = `${this.#runners().length - out} algorithms${out > 0 ? `, ${out} stopped` : ""}`;
    const where = `${formatCount(boxes)} boxes, ${scene}, ${motion}`;
    this.#say(this.#wanted ? `${who}: ${where}.` : `Paused after step ${formatCount(this.#frame?.step ?? 0)}. ${who}: ${where}.`);
  }

  #say(text: string): void {
    const status = this.#part("status");
    if (status.textContent !== text) status.textContent = text;
  }

  #lanePart<E extends HTMLElement = HTMLElement>(lane: number, name: LaneChoice | "out"): E {
    return this.#find<E>(`[data-lane="${lane}"] [data-part="${name}"]`);
  }

  #part<E extends HTMLElement = HTMLElement>(name: string): E {
    return this.#find<E>(`[data-part="${name}"]`);
  }

  #find<E extends HTMLElement = HTMLElement>(selector: string): E {
    const found = this.querySelector<E>(selector);
    if (!found) throw new Error(`<race-track> has no ${selector}`);
    return found;
  }
}
