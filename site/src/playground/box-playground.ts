import { numberWithin, readAddress, writeAddress } from "../experiment/address.ts";
import { type BoxColors, drawBoxes, type Window2, windowOf } from "../experiment/box-picture.ts";
import type { RunnerOptions, Lists, WorldOptions } from "../experiment/experiment.ts";
import { onAwake } from "../falling/awake.ts";
import { formatCount } from "../falling/counters.ts";
import { bindSlider } from "../falling/slider.ts";
import type { FromRace, RaceFrame, ToRace } from "../race/messages.ts";
import { MEASURES, RaceRecord } from "../race/record.ts";
import { onThemeChange } from "../shell/theme.ts";
import { type Format, FORMATS, preview, shortest, type Snapshot, write } from "./export.ts";
import { Hands, type Shown } from "./hands.ts";
import { readBoxes } from "./import.ts";
import { COUNTERS } from "./markup.ts";
import { messageOf } from "../message-of.ts";

/** What the sliders offer. */
const RANGES = {
  boxes: [1, 2, 3, 5, 10, 20, 50, 100, 200, 500, 1_000, 2_000, 5_000, 10_000, 20_000],
  size: [0.1, 0.2, 0.5, 0.7, 1, 1.5, 2, 3, 5, 10],
  spread: [1, 2, 4, 8, 16, 32, 64, 100],
} as const;
const LARGEST_SEED = 2 ** 32 - 1;
/** Numbers that change more often than this cannot be read. */
const SHOW_MS = 150;
/** The address has own boxes when no hand has moved them for this long. */
const WRITE_MS = 300;
const NOT_COUNTED = "not counted by this algorithm";

const DEFAULTS = {
  dimensions: "2", scene: "clustered", motion: "drift", boxes: "500", seed: "1", size: "1", spread: "1",
  algorithm: "sorted pairwise", sort: "insertion sort", axis: "largest variance", format: "js", step: "0", own: "",
};
/** More boxes of the visitor's own than this do not fit into an address. */
const MOST_IN_ADDRESS = 100;
/** An address leads to this step at most: it has to be computed. */
const LAST_STEP = 10_000;
/** What the choice of a scene shows where the boxes are the visitor's own. */
const OWN = "your own boxes";

type Key = keyof typeof DEFAULTS;

/**
 * `<box-playground>`: a world of boxes of the visitor's own, one algorithm at work on it, and the
 * way to take it home. It is a race with one runner: its thread is that of the race.
 */
export class BoxPlayground extends HTMLElement {
  readonly #worker = new Worker(new URL("../race/worker.ts", import.meta.url), { type: "module" });
  #lists!: Lists;
  #state = readAddress<Key>(DEFAULTS);
  #run = 0;
  #record = new RaceRecord(1);
  #frame: RaceFrame | undefined;
  /** What is shown: all there was at first, or where the visitor went. */
  #view: Window2 | undefined;
  /** The boxes with which the world begins, if they are the visitor's own. */
  #own: Float32Array | undefined;
  #hands!: Hands;
  #isHeld = false;
  #writing: ReturnType<typeof setTimeout> | undefined;
  #whenPaced: () => void = () => undefined;
  /** Own boxes that wait until those before have been searched. */
  #isWaiting = false;
  #wanted = !matchMedia("(prefers-reduced-motion: reduce)").matches;
  #awake = false;
  #shownAt = -Infinity;
  #asked = false;
  #colors: BoxColors | undefined;
  #left = new AbortController();

  connectedCallback(): void {
    this.#worker.addEventListener("message", ({ data }: MessageEvent<FromRace>) => this.#receive(data));
    this.#worker.addEventListener("error", ({ message }) => this.#say(message));
    const { signal } = this.#left;
    onThemeChange(() => {
      this.#colors = undefined;
      this.#requestShow();
    }, signal);
    new ResizeObserver(() => {
      this.#view = undefined;
      this.#requestShow();
    }).observe(this.#part("picture"));
    onAwake(this, (awake) => {
      this.#awake = awake;
      this.#pace();
    }, signal);
    const setView = (view: Window2 | undefined): void => {
      this.#view = view;
      this.#requestShow();
    };
    const button = (part: string): HTMLButtonElement => this.#part<HTMLButtonElement>(part);
    this.#hands = new Hands({
      surface: this.#part("surface"),
      buttons: { draw: button("draw"), add: button("add"), delete: button("delete"), undo: button("undo"), clear: button("clear") },
      shown: () => this.#shown,
      view: () => this.#view,
      setView,
      setHeld: (isHeld) => {
        this.#isHeld = isHeld;
        this.#pace();
        this.#showPreview();
      },
      setBoxes: (shown) => this.#setOwn(shown),
      select: (text) => {
        this.#part("selected").textContent = text;
        this.#requestShow();
      },
    });
    this.#bindImport();
  }

  disconnectedCallback(): void {
    this.#left.abort();
    this.#worker.terminate();
  }

  // Controls

  #setUp(lists: Lists): void {
    this.#lists = lists;
    this.#bindChoice("dimensions", undefined, () => this.#fill());
    this.#bindChoice("scene");
    this.#bindChoice("motion", lists.motions.map(({ name }) => name));
    this.#bindChoice("algorithm", lists.algorithms);
    this.#bindChoice("sort", lists.sorts);
    this.#bindChoice("axis");
    this.#fill();
    for (const key of ["boxes", "size", "spread"] as const) {
      bindSlider({
        slider: this.#part<HTMLInputElement>(key),
        output: this.#part(`${key}-value`),
        values: RANGES[key],
        value: this.#world()[key],
        format: key === "boxes" ? formatCount : (value) => (key === "size" ? `× ${value}` : `${value} : 1`),
        changed: (value) => this.#change(key, String(value)),
      });
    }
    const seed = this.#part<HTMLInputElement>("seed");
    seed.value = String(this.#world().seed);
    seed.addEventListener("change", () => {
      seed.value = String(numberWithin(String(Math.round(seed.valueAsNumber)), 0, LARGEST_SEED, 1));
      this.#change("seed", seed.value);
    });
    this.#bindButtons();
    this.#bindExport();
    for (const control of this.querySelectorAll<HTMLInputElement>(":disabled:not([data-part=delete], [data-part=undo])")) control.disabled = false;
    this.#readOwn();
    const step = Math.round(numberWithin(this.#state.step, 0, LAST_STEP, 0));
    // An address that leads to a step shows that step.
    if (step > 0) this.#wanted = false;
    this.#begin(step);
    this.#pace();
  }

  /** The boxes that the address holds. */
  #readOwn(): void {
    if (this.#state.own === "") return;
    try {
      const { dimensions, boxes } = readBoxes(this.#state.own.replaceAll(";", "\n"));
      this.#own = boxes;
      this.#state.dimensions = String(dimensions);
      this.#part<HTMLSelectElement>("dimensions").value = this.#state.dimensions;
      this.#fill();
    } catch (error) {
      this.#state.own = "";
      this.#part("imported").textContent = `The boxes of the address were left out. ${messageOf(error)}`;
    }
  }

  #bindChoice(key: "dimensions" | "scene" | "motion" | keyof RunnerOptions, names?: readonly string[], before = (): void => {}): void {
    const select = this.#part<HTMLSelectElement>(key);
    if (names) select.replaceChildren(...names.map((name) => new Option(name)));
    if (select.options.length > 0) this.#choose(key);
    select.addEventListener("change", () => {
      this.#state[key] = select.value;
      if (key === "dimensions" || key === "scene") this.#forgetOwn();
      before();
      this.#change(key, select.value);
    });
  }

  /** The scenes and the axes that exist in the chosen dimensions. */
  #fill(): void {
    const dimensions = Number(this.#state.dimensions);
    const { scenes, axes } = this.#lists;
    const there = scenes.filter(({ dimensions: [least, most] }) => least <= dimensions && dimensions <= most);
    const isOwn = this.#own !== undefined;
    this.#part("scene").replaceChildren(...(isOwn ? [new Option(OWN, "")] : []), ...there.map(({ name }) => new Option(name)));
    this.#part("axis").replaceChildren(...axes.slice(0, axes.length - 3 + dimensions).map((name) => new Option(name)));
    if (!isOwn) this.#choose("scene");
    this.#choose("axis");
  }

  /** Shows what the state says, or the default where there is no such thing, or the first. */
  #choose(key: Key): void {
    const select = this.#part<HTMLSelectElement>(key);
    const names = [...select.options].map(({ value }) => value);
    const name = [this.#state[key], DEFAULTS[key], names[0] ?? ""].find((name) => names.includes(name)) ?? "";
    select.value = this.#state[key] = name;
  }

  #bindButtons(): void {
    this.#onClick("play", () => {
      this.#wanted = !this.#wanted;
      this.#pace();
    });
    this.#onClick("step", () => {
      this.#wanted = false;
      this.#pace();
      this.#send({ type: "step" });
    });
    this.#onClick("reset", () => {
      this.#keep("step", "0");
      this.#begin();
    });
    this.#onClick("fit", () => {
      this.#view = undefined;
      this.#requestShow();
    });
  }

  #bindExport(): void {
    this.#choose("format");
    const format = this.#part<HTMLSelectElement>("format");
    format.addEventListener("change", () => {
      this.#keep("format", format.value);
      this.#showPreview();
    });
    // The world stops at the step that is taken along: what is shown is what is copied.
    const snapshot = async (): Promise<Snapshot> => {
      this.#wanted = false;
      this.#pace();
      // The thread may have taken another step meanwhile.
      await new Promise<void>((resolve) => (this.#whenPaced = resolve));
      this.#showNow();
      const taken = this.#snapshot();
      if (!taken) throw new Error("there are no boxes yet");
      return taken;
    };
    const reportDone = (text: (taken: Snapshot) => string, work: (taken: Snapshot) => Promise<void>): void => {
      const output = this.#part("exported");
      const done = async (): Promise<string> => {
        const taken = await snapshot();
        await work(taken);
        return text(taken);
      };
      done().then(
        (text) => (output.textContent = text),
        (error: unknown) => (output.textContent = `That did not work: ${messageOf(error)}`),
      );
    };
    this.#onClick("copy", () =>
      reportDone(({ step }) => `Step ${formatCount(step)} copied.`, async (taken) => navigator.clipboard.writeText(await write(taken, this.#format()))),
    );
    this.#onClick("share", () =>
      reportDone(({ step }) => `Address of step ${formatCount(step)} copied.`, async ({ address }) => {
        if (address === "") throw new Error(`more than ${MOST_IN_ADDRESS} boxes of your own do not fit into an address; download them instead, and import them there`);
        await navigator.clipboard.writeText(address);
      }),
    );
    this.#onClick("download", () =>
      reportDone(({ step }) => `Step ${formatCount(step)} downloaded.`, async (taken) => {
        const { type, file } = FORMATS[this.#format()];
        const link = document.createElement("a");
        link.href = URL.createObjectURL(new Blob([await write(taken, this.#format())], { type }));
        link.download = file;
        link.click();
        URL.revokeObjectURL(link.href);
      }),
    );
  }

  /** Boxes come from a file that is chosen or dropped on the picture, or from text. */
  #bindImport(): void {
    const file = this.#part<HTMLInputElement>("file");
    const pasted = this.#part<HTMLTextAreaElement>("pasted");
    const take = (text: string): void => {
      const output = this.#part("imported");
      try {
        const imported = readBoxes(text);
        this.#hands.replace(() => imported);
        this.#view = undefined;
        output.textContent = `${formatCount(imported.boxes.length / (2 * imported.dimensions))} boxes imported.`;
      } catch (error) {
        output.textContent = messageOf(error);
      }
    };
    const takeFile = (given: File | undefined): void => void given?.text().then(take);
    this.#onClick("import", () => file.click());
    file.addEventListener("change", () => {
      takeFile(file.files?.[0]);
      file.value = "";
    });
    this.#onClick("paste", () => take(pasted.value));
    const surface = this.#part("surface");
    surface.addEventListener("dragover", (event) => event.preventDefault());
    surface.addEventListener("drop", (event) => {
      event.preventDefault();
      takeFile(event.dataTransfer?.files[0]);
    });
  }

  #onClick(part: string, act: () => void): void {
    this.#part(part).addEventListener("click", act);
  }

  #format(): Format {
    return this.#state.format as Format;
  }

  #keep(key: Key, text: string): void {
    this.#state[key] = text;
    writeAddress(this.#state, DEFAULTS);
  }

  #change(key: Key, text: string): void {
    this.#state.step = "0";
    this.#keep(key, text);
    this.#begin();
  }

  // Boxes of the visitor's own

  /** The boxes that the picture shows; of own ones those that were placed last. */
  get #shown(): Shown | undefined {
    const { dimensions } = this.#world();
    const boxes = this.#isHeld || this.#frame === undefined ? this.#own : this.#frame.boxes;
    return boxes && { dimensions, boxes };
  }

  /** These boxes are the world from now on, at its first step. */
  #setOwn({ dimensions, boxes }: Shown): void {
    const isAsBefore = this.#own !== undefined && dimensions === this.#world().dimensions;
    this.#own = boxes;
    this.#state.dimensions = String(dimensions);
    this.#state.step = "0";
    if (!isAsBefore) {
      this.#part<HTMLSelectElement>("dimensions").value = this.#state.dimensions;
      this.#fill();
    }
    // A browser refuses an address that changes with every move of a hand.
    clearTimeout(this.#writing);
    this.#writing = setTimeout(() => this.#keep("own", this.#ownText()), WRITE_MS);
    // While the thread is busy with the last ones, those between are left out.
    if (this.#frame === undefined && this.#run > 0 && this.#isHeld) this.#isWaiting = true;
    else this.#place();
  }

  #place(): void {
    this.#isWaiting = false;
    this.#record = new RaceRecord(1);
    this.#frame = undefined;
    this.#send({ type: "begin", run: ++this.#run, world: this.#world(), runners: [this.#method()], keep: true });
    this.#describe();
  }

  #forgetOwn(): void {
    clearTimeout(this.#writing);
    this.#own = undefined;
    this.#state.own = "";
    this.#hands.forget();
    this.#fill();
  }

  /** The own boxes, as the address holds them; nothing if there are too many. */
  #ownText(): string {
    const { dimensions } = this.#world();
    const row = 2 * dimensions;
    const count = (this.#own?.length ?? 0) / row;
    if (!this.#own || count > MOST_IN_ADDRESS) return "";
    const boxes = this.#own;
    return Array.from({ length: count }, (_, box) => Array.from(boxes.subarray(row * box, row * (box + 1)), shortest).join(",")).join(";");
  }

  #world(): WorldOptions {
    const { dimensions, scene, motion, boxes, seed, size, spread } = this.#state;
    return {
      dimensions: dimensions === "3" ? 3 : 2,
      scene,
      motion,
      boxes: this.#own ? this.#own.length / (dimensions === "3" ? 6 : 4) : Math.round(numberWithin(boxes, 1, 20_000, Number(DEFAULTS.boxes))),
      seed: Math.round(numberWithin(seed, 0, LARGEST_SEED, 1)),
      size: numberWithin(size, 0.01, 100, 1),
      spread: numberWithin(spread, 1, 1000, 1),
      ...(this.#own && { own: this.#own }),
    };
  }

  #method(): RunnerOptions {
    const { algorithm, sort, axis } = this.#state;
    return { algorithm, sort, axis };
  }

  #snapshot(): Snapshot | undefined {
    const [lane] = this.#frame?.lanes ?? [];
    if (!this.#frame || !lane || !("report" in lane)) return undefined;
    const { step, boxes } = this.#frame;
    return { world: this.#world(), method: this.#method(), step, boxes, pairs: lane.report.pairs, address: this.#addressOf(step) };
  }

  /** The address that leads back to a step; none if the boxes do not fit into it. */
  #addressOf(step: number): string {
    clearTimeout(this.#writing);
    this.#keep("own", this.#ownText());
    const address = new URL(location.href);
    address.searchParams.delete("step");
    if (step > 0 && step <= LAST_STEP) address.searchParams.set("step", String(step));
    return this.#own && this.#state.own === "" ? "" : address.href;
  }

  #begin(steps = 0): void {
    this.#record = new RaceRecord(1);
    this.#frame = undefined;
    this.#view = undefined;
    this.#part("message").textContent = "";
    const { scenes, motions } = this.#lists;
    const about = [scenes.find(({ name }) => name === this.#state.scene), motions.find(({ name }) => name === this.#state.motion)];
    this.#part("about").textContent = about.map((item) => item?.description ?? "").join(" ");
    this.#send({ type: "begin", run: ++this.#run, world: this.#world(), runners: [this.#method()], steps });
    this.#describe();
  }

  #pace(): void {
    if (!this.#lists) return;
    this.#send({ type: "pace", running: this.#wanted && this.#awake && !this.#isHeld });
    this.#part("play").textContent = this.#wanted ? "Pause" : "Play";
    this.#describe();
    this.#requestShow();
  }

  #send(message: ToRace): void {
    this.#worker.postMessage(message);
  }

  // What comes from the thread

  #receive(message: FromRace): void {
    if ("run" in message && message.run !== this.#run) return;
    switch (message.type) {
      case "ready":
        this.#setUp(message.lists);
        break;
      case "refused":
        this.#part("message").textContent = message.reason;
        this.dataset["step"] = "refused";
        this.#requestShow();
        break;
      case "frame":
        this.#frame = message;
        this.#record.add(message);
        if (this.#isWaiting) this.#place();
        else this.#requestShow();
        break;
      case "paced":
        this.#whenPaced();
        break;
      case "failed":
        this.#say(`That did not work: ${message.message}`);
        break;
    }
  }

  #requestShow(): void {
    if (this.#asked) return;
    this.#asked = true;
    requestAnimationFrame(() => {
      this.#asked = false;
      this.#show();
    });
  }

  #show(): void {
    const frame = this.#frame;
    if (!frame) return;
    this.#draw(frame);
    const now = performance.now();
    if (!this.#wanted || frame.step === 0 || now - this.#shownAt >= SHOW_MS) this.#showNumbers(frame, now);
    this.#send({ type: "seen", run: frame.run });
  }

  /** The numbers and the text to be copied, of the same step as the picture. */
  #showNumbers(frame: RaceFrame, now: number): void {
    this.#shownAt = now;
    this.#showCounters(frame);
    this.#showPreview();
    if (!this.#wanted) this.#describe();
  }

  /** Shows the last step completely, at once. */
  #showNow(): void {
    if (!this.#frame) return;
    this.#draw(this.#frame);
    this.#showNumbers(this.#frame, performance.now());
  }

  #draw({ boxes, pairs }: RaceFrame): void {
    const canvas = this.#part<HTMLCanvasElement>("picture");
    const { clientWidth: width, clientHeight: height } = canvas;
    const { dimensions } = this.#world();
    this.#view ??= windowOf(boxes, dimensions, width, height);
    if (!this.#colors) {
      const style = getComputedStyle(this);
      const color = (name: string): string => style.getPropertyValue(`--${name}`).trim();
      this.#colors = { box: color("ramp-1"), highlighted: color("ramp-4"), line: color("stage"), selected: color("ink") };
    }
    drawBoxes(canvas, { width, height }, this.#view, boxes, dimensions, pairs, this.#colors, this.#hands.selected);
  }

  #showCounters({ step, lanes }: RaceFrame): void {
    const [lane] = lanes;
    const report = lane && "report" in lane ? lane.report : undefined;
    const ms = this.#record.level(0, MEASURES[0]);
    this.dataset["step"] = String(step);
    this.#part("moment").textContent = `Step ${formatCount(step)}`;
    this.#part("message").textContent = lane && "out" in lane ? lane.out : "";
    for (const { key } of COUNTERS) {
      const value = key === "ms" ? ms : (report?.[key] ?? null);
      const cell = this.#find(`[data-counter="${key}"] dd`);
      cell.textContent = value === null ? "–" : key === "ms" ? `${value.toFixed(value < 100 ? 2 : 0)} ms` : formatCount(value);
      cell.title = value === null && report ? NOT_COUNTED : "";
    }
    // A choice that would change nothing is not offered.
    const { algorithm } = this.#state;
    const plain = this.#lists.algorithms.slice(0, 3).includes(algorithm);
    this.#part<HTMLSelectElement>("sort").disabled = plain;
    this.#part<HTMLSelectElement>("axis").disabled = plain || algorithm.endsWith("every axis");
    for (const part of ["boxes", "size", "spread"]) this.#part<HTMLInputElement>(part).disabled = this.#own !== undefined;
  }

  #showPreview(): void {
    const snapshot = this.#snapshot();
    const code = this.#part("preview");
    const text = snapshot ? preview(snapshot, this.#format()) : " ";
    if (code.textContent !== text) code.textContent = text;
  }

  /** Tells what is going on: seldom enough to be read out. */
  #describe(): void {
    const { boxes, scene, motion } = this.#world();
    const what = this.#own ? `${formatCount(boxes)} boxes of your own` : `${formatCount(boxes)} boxes, ${scene}`;
    const where = `${what}, ${motion}, by ${this.#state.algorithm}.`;
    const [lane] = this.#frame?.lanes ?? [];
    const found = lane && "report" in lane ? ` ${formatCount(lane.report.pairs)} pairs.` : "";
    this.#say(this.#wanted ? where : `Paused after step ${formatCount(this.#frame?.step ?? 0)}: ${where}${found}`);
  }

  #say(text: string): void {
    const status = this.#part("status");
    if (status.textContent !== text) status.textContent = text;
  }

  #part<E extends HTMLElement = HTMLElement>(name: string): E {
    return this.#find<E>(`[data-part="${name}"]`);
  }

  #find<E extends HTMLElement = HTMLElement>(selector: string): E {
    const found = this.querySelector<E>(selector);
    if (!found) throw new Error(`<box-playground> has no ${selector}`);
    return found;
  }
}
