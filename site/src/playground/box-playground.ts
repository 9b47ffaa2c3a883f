import { numberWithin, readAddress, writeAddress } from "../experiment/address.ts";
import { type BoxColors, drawBoxes, type Window2, windowOf } from "../experiment/box-picture.ts";
import type { Lists, RunnerOptions, WorldOptions } from "../experiment/experiment.ts";
import { FALLING, GRAVITIES } from "../experiment/scene.ts";
import type { ExperimentFrame, FromExperiment, ToExperiment } from "../experiment/messages.ts";
import { ExperimentRecord, MEASURES, SHOWN } from "../experiment/record.ts";
import { showLoadFailure } from "../load-failed.ts";
import { messageOf } from "../message-of.ts";
import { bruteForceTests, formatCount } from "../panel/counters.ts";
import { whenNear } from "../panel/awake.ts";
import { PanelElement } from "../panel/panel-element.ts";
import { LARGEST_SEED } from "../panel/parts.ts";
import { drawLines } from "../plot/line-plot.ts";
import { keep } from "../shell/shell.ts";
import { onThemeChange } from "../shell/theme.ts";
import { colorOf } from "../view/theme.ts";
import { BallsPicture } from "./balls.ts";
import { type Format, FORMATS, preview, shortest, type Snapshot, write } from "./export.ts";
import { Hands, type Shown } from "./hands.ts";
import { readBoxes } from "./import.ts";
import { keysOf, Lanes, MOST_LANES } from "./lanes.ts";
import { laneMarkup } from "./markup.ts";
import { verdict } from "./verdict.ts";

/** What the sliders offer. */
const RANGES = {
  boxes: [1, 2, 3, 5, 10, 20, 50, 100, 200, 500, 1_000, 2_000, 5_000, 10_000, 20_000, 50_000, 100_000],
  size: [0.1, 0.2, 0.5, 0.7, 1, 1.5, 2, 3, 5, 10],
  spread: [1, 2, 4, 8, 16, 32, 64, 100],
} as const;
/** Numbers that change more often than this cannot be read. */
const SHOW_MS = 150;
/** The address has own boxes when no hand has moved them for this long. */
const WRITE_MS = 300;

/** No further algorithm. */
const NONE = "none";
const FURTHER = { sort: "insertion sort", axis: "largest variance" };

const DEFAULTS = {
  dimensions: "2", scene: "clustered", motion: "drift", boxes: "500", seed: "1", size: "1", spread: "1",
  algorithm: "sorted pairwise", ...FURTHER,
  "2": NONE, "2.sort": FURTHER.sort, "2.axis": FURTHER.axis,
  "3": NONE, "3.sort": FURTHER.sort, "3.axis": FURTHER.axis,
  "4": NONE, "4.sort": FURTHER.sort, "4.axis": FURTHER.axis,
  plot: "ms", log: "yes", format: "js", step: "0", own: "",
};
/** More boxes of the visitor's own than this do not fit into an address. */
const MOST_IN_ADDRESS = 100;
/** An address leads to this step at most: it has to be computed. */
const LAST_STEP = 10_000;
/** The scenes that are offered at once; the others after `MORE`. */
const SCENES = [FALLING, "uniform", "clustered", "mixed", "tower", "grid"];
const MORE = "more …";
/** What the choice of a scene shows where the boxes are the visitor's own. */
const OWN = "your own boxes";

type Key = keyof typeof DEFAULTS;

interface Colors {
  readonly boxes: BoxColors;
  readonly lanes: readonly string[];
  readonly ink: string;
  readonly muted: string;
  readonly grid: string;
}

/**
 * `<box-playground>`: a world of boxes, up to four algorithms at work on it in lockstep, on a thread of their own,
 * and the way to take it home. Attributes say how it begins, by the names of `DEFAULTS`. Its inside is written by `markup.ts`;
 * of one that is `compact` the half that edits and exports is hidden.
 */
export class BoxPlayground extends PanelElement {
  #worker: Worker | undefined;
  #lists: Lists | undefined;
  #lanes!: Lanes;
  #defaults: Readonly<Record<Key, string>> = DEFAULTS;
  #state: Record<Key, string> = DEFAULTS;
  #run = 0;
  #record = new ExperimentRecord(0);
  #frame: ExperimentFrame | undefined;
  /** What is shown: all there was at first, or where the visitor went. */
  #view: Window2 | undefined;
  /** The boxes with which the world begins, if they are the visitor's own. */
  #own: Float32Array | undefined;
  #hands!: Hands;
  #balls!: BallsPicture;
  /** Why balls cannot be drawn, if so. */
  #noPicture = "";
  #isHeld = false;
  #writing: ReturnType<typeof setTimeout> | undefined;
  #whenPaced: () => void = () => undefined;
  /** Whether the choice of a scene has all of them. */
  #offersAll = false;
  /** Own boxes that wait until those before have been searched. */
  #isWaiting = false;
  #shownAt = -Infinity;
  #colors: Colors | undefined;

  protected start(): void {
    this.#defaults = { ...DEFAULTS, ...Object.fromEntries([...this.attributes].filter(({ name }) => name in DEFAULTS).map(({ name, value }) => [name, value])) };
    this.#state = readAddress<Key>(this.#defaults);
    // The algorithms of the address have their places at once: nothing jumps when their names are known.
    const lanes = 1 + [2, 3, 4].filter((lane) => this.#state[keysOf(lane).algorithm as Key] !== NONE).length;
    this.named("add-algorithm").hidden = lanes === MOST_LANES;
    if (lanes > 1) this.named("lanes").innerHTML = Array.from({ length: lanes }, (_, at) => laneMarkup(at + 1)).join("");
    this.#offerByScene();
    void whenNear([this], this.signal).then(() => this.#open());
  }

  #open(): void {
    this.#worker = new Worker(new URL("../experiment/worker.ts", import.meta.url), { type: "module" });
    this.#worker.addEventListener("message", ({ data }: MessageEvent<FromExperiment>) => this.#receive(data));
    this.#worker.addEventListener("error", ({ message }) => this.#fail(message ?? "its script"));
    onThemeChange(() => {
      this.#colors = undefined;
      this.requestShow();
    }, this.signal);
    this.#balls = new BallsPicture(this.named("orbit"), this.signal, () => this.requestShow(), (error) => {
      this.#noPicture = `There is no picture: ${messageOf(error)}.`;
      this.write("message", this.#noPicture);
    });
    this.onResize(["picture", "orbit", "lines"], () => {
      this.#balls.resize();
      this.#setView(undefined);
    });
    this.followAwake();
    const button = (part: string): HTMLButtonElement => this.named<HTMLButtonElement>(part);
    this.#hands = new Hands({
      surface: this.named("surface"),
      buttons: { draw: button("draw"), add: button("add"), delete: button("delete"), undo: button("undo"), clear: button("clear") },
      shown: () => this.#shown,
      view: () => this.#view,
      setView: (view) => this.#setView(view),
      setHeld: (isHeld) => {
        this.#isHeld = isHeld;
        this.pace();
        this.#showPreview();
      },
      setBoxes: (shown) => this.#setOwn(shown),
      select: (text) => {
        this.write("selected", text);
        this.requestShow();
      },
    });
    // Among balls there is nothing to draw on: their boxes are the visitor's own from then on.
    this.onClick("draw", () => this.#isFalling && this.#hands.replace((shown) => shown));
    this.#bindImport();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.#worker?.terminate();
  }

  // Controls

  #setUp(given: Lists): void {
    const falling = { name: FALLING, description: "Balls fall into a box and bounce off each other; the algorithms search their boxes.", dimensions: [2, 3] } as const;
    const lists = { ...given, scenes: [falling, ...given.scenes] };
    this.#lists = lists;
    for (const key of ["dimensions", "scene", "motion"] as const) this.#bindChoice(key);
    this.#lanes = new Lanes(this.named("lanes"), lists, (lanes) => {
      this.#keepLanes(lanes);
      this.#change("step", "0");
    });
    this.#fill(this.#lanesOfAddress(lists));
    this.onClick("add-algorithm", () => this.#lanes.add(this.#world().dimensions));
    this.#bindPlot();
    for (const key of ["boxes", "size", "spread"] as const) {
      this.bindSlider(
        key,
        RANGES[key],
        this.#world()[key],
        key === "boxes" ? formatCount : (value) => (key === "size" ? `× ${value}` : `${value} : 1`),
        (value) => this.#change(key, String(value)),
      );
    }
    this.bindSeed(this.#world().seed, (seed) => this.#change("seed", String(seed)));
    this.#bindButtons();
    this.#bindExport();
    for (const control of this.querySelectorAll<HTMLInputElement>(":disabled:not([data-part=delete], [data-part=undo], .lane *)")) control.disabled = false;
    this.#readOwn();
    const step = Math.round(numberWithin(this.#state.step, 0, LAST_STEP, 0));
    // An address that leads to a step shows that step, and own boxes stand still until Play.
    if (step > 0 || this.#own) this.wanted = false;
    this.#begin(step);
    this.pace();
  }

  /** The boxes that the address holds. */
  #readOwn(): void {
    if (this.#state.own === "") return;
    try {
      const { dimensions, boxes } = readBoxes(this.#state.own.replaceAll(";", "\n"));
      this.#own = boxes;
      this.#state.dimensions = String(dimensions);
      this.named<HTMLSelectElement>("dimensions").value = this.#state.dimensions;
      this.#fill();
    } catch (error) {
      this.#state.own = "";
      this.write("imported", `The boxes of the address were left out. ${messageOf(error)}`);
    }
  }

  #bindChoice(key: "dimensions" | "scene" | "motion"): void {
    const select = this.named<HTMLSelectElement>(key);
    if (select.options.length > 0) this.#choose(key);
    select.addEventListener("change", () => {
      if (select.value === MORE) return this.#offerAllScenes();
      this.#state[key] = select.value;
      if (key === "dimensions" || key === "scene") this.#forgetOwn();
      if (key === "dimensions") this.#fill();
      this.#change(key, select.value);
    });
  }

  /** The scenes and the axes that exist in the chosen dimensions. */
  #fill(lanes = this.#lanes.all): void {
    const { dimensions } = this.#world();
    const there = (this.#lists?.scenes ?? []).filter(({ dimensions: [least, most] }) => least <= dimensions && dimensions <= most);
    const isOwn = this.#own !== undefined;
    const names = there.map(({ name }) => name).filter((name) => this.#offersAll || SCENES.includes(name) || name === this.#state.scene);
    this.named("scene").replaceChildren(...(isOwn ? [new Option(OWN, "")] : []), ...names.map((name) => new Option(name)), ...(this.#offersAll ? [] : [new Option(MORE)]));
    if (!isOwn) this.#choose("scene");
    const motions = this.#isFalling ? Object.keys(GRAVITIES) : (this.#lists?.motions ?? []).map(({ name }) => name);
    this.named("motion").replaceChildren(...motions.map((name) => new Option(name)));
    this.#choose("motion");
    this.#offerByScene();
    this.#lanes.set(lanes, dimensions);
    this.#keepLanes(this.#lanes.all);
  }

  get #isFalling(): boolean {
    return !this.#own && this.#state.scene === FALLING;
  }

  /** A picture of balls cannot be moved, nor balls by hand; lines are drawn between discs. */
  #offerByScene(): void {
    for (const part of ["fit", "hands-hint"]) this.named(part).hidden = this.#isFalling;
    this.named("balls-hint").hidden = !this.#isFalling;
    this.named("links").hidden = !this.#isFalling || this.#state.dimensions === "3";
  }

  /** All scenes from now on, with the chosen one still chosen. */
  #offerAllScenes(): void {
    this.#offersAll = true;
    this.#fill();
    this.named<HTMLSelectElement>("scene").value = this.#own ? "" : this.#state.scene;
  }

  /** The algorithms that the address names: the first always, the others where there are such. */
  #lanesOfAddress({ algorithms, sorts, axes }: Lists): RunnerOptions[] {
    const known = (key: string, names: readonly string[]): string => {
      const name = this.#state[key as Key];
      return names.includes(name) ? name : this.#defaults[key as Key];
    };
    const all = Array.from({ length: MOST_LANES }, (_, at): RunnerOptions => {
      const { algorithm, sort, axis } = keysOf(at + 1);
      return { algorithm: known(algorithm, algorithms), sort: known(sort, sorts), axis: known(axis, axes) };
    });
    return all.filter(({ algorithm }) => algorithm !== NONE);
  }

  #keepLanes(lanes: readonly RunnerOptions[]): void {
    for (let lane = 1; lane <= MOST_LANES; lane++) {
      const keys = keysOf(lane);
      const { algorithm, sort, axis } = lanes[lane - 1] ?? { algorithm: NONE, ...FURTHER };
      Object.assign(this.#state, { [keys.algorithm]: algorithm, [keys.sort]: sort, [keys.axis]: axis });
    }
    this.named("add-algorithm").hidden = lanes.length === MOST_LANES;
    // The script in the head of the page has done so before the first picture.
    document.documentElement.classList.toggle("races", lanes.length > 1);
    this.#colors = undefined;
  }

  #bindPlot(): void {
    this.#choose("plot");
    const plot = this.named<HTMLSelectElement>("plot");
    const log = this.named<HTMLInputElement>("log");
    log.checked = this.#state.log !== "no";
    plot.addEventListener("change", () => this.#keep("plot", plot.value));
    log.addEventListener("change", () => this.#keep("log", log.checked ? "yes" : "no"));
    for (const control of [plot, log]) control.addEventListener("change", () => this.#drawPlot());
  }

  /** Shows what the state says, or the default where there is no such thing, or the first. */
  #choose(key: Key): void {
    const select = this.named<HTMLSelectElement>(key);
    const names = [...select.options].map(({ value }) => value);
    const name = [this.#state[key], this.#defaults[key], names[0] ?? ""].find((name) => names.includes(name)) ?? "";
    select.value = this.#state[key] = name;
  }

  #bindButtons(): void {
    this.bindTransport(
      () => this.#send({ type: "step" }),
      () => {
        this.#keep("step", "0");
        this.#begin();
      },
    );
    this.named("links").addEventListener("change", () => this.requestShow());
    this.onClick("fit", () => this.#setView(undefined));
  }

  #setView(view: Window2 | undefined): void {
    this.#view = view;
    this.requestShow();
  }

  #bindExport(): void {
    this.#choose("format");
    const format = this.named<HTMLSelectElement>("format");
    format.addEventListener("change", () => {
      this.#keep("format", format.value);
      this.#showPreview();
    });
    // The world stops at the step that is taken along: what is shown is what is copied.
    const snapshot = async (): Promise<Snapshot> => {
      this.setWanted(false);
      // The thread may have taken another step meanwhile.
      await new Promise<void>((resolve) => (this.#whenPaced = resolve));
      this.#showNow();
      const taken = this.#snapshot();
      if (!taken) throw new Error("no algorithm is done with these boxes");
      return taken;
    };
    const onExport = (part: string, says: (step: string) => string, work: (taken: Snapshot) => Promise<void>): void =>
      this.onClick(part, async () => {
        try {
          const taken = await snapshot();
          await work(taken);
          this.write("exported", says(formatCount(taken.step)));
        } catch (error) {
          this.write("exported", `That did not work: ${messageOf(error)}`);
        }
      });
    onExport("copy", (step) => `Step ${step} copied.`, async (taken) => navigator.clipboard.writeText(await write(taken, this.#format())));
    onExport("share", (step) => `Address of step ${step} copied.`, async ({ address, step, world }) => {
      if (world.boxes === 0) throw new Error("there are no boxes to share");
      if (step > LAST_STEP) throw new Error(`an address leads to step ${formatCount(LAST_STEP)} at most; download the boxes instead, and import them there`);
      if (address === "") throw new Error(`more than ${MOST_IN_ADDRESS} boxes of your own do not fit into an address; download them instead, and import them there`);
      await navigator.clipboard.writeText(address);
    });
    onExport("download", (step) => `Step ${step} downloaded.`, async (taken) => {
      const { type, file } = FORMATS[this.#format()];
      const link = document.createElement("a");
      link.href = URL.createObjectURL(new Blob([await write(taken, this.#format())], { type }));
      link.download = file;
      link.click();
      URL.revokeObjectURL(link.href);
    });
  }

  /** Boxes come from a file that is chosen or dropped on the picture, or from text. */
  #bindImport(): void {
    const file = this.named<HTMLInputElement>("file");
    const pasted = this.named<HTMLTextAreaElement>("pasted");
    const take = (text: string): void => {
      try {
        const imported = readBoxes(text);
        this.#hands.replaceAll(imported);
        this.#view = undefined;
        this.write("imported", `${formatCount(imported.boxes.length / (2 * imported.dimensions))} boxes imported.`);
      } catch (error) {
        this.write("imported", messageOf(error));
      }
    };
    const takeFile = (given: File | undefined): void => void given?.text().then(take, (error: unknown) => this.write("imported", messageOf(error)));
    this.onClick("import", () => file.click());
    file.addEventListener("change", () => {
      takeFile(file.files?.[0]);
      file.value = "";
    });
    this.onClick("paste", () => take(pasted.value));
    const stage = this.find(".panel-stage");
    stage.addEventListener("dragover", (event) => event.preventDefault());
    stage.addEventListener("drop", (event) => {
      event.preventDefault();
      takeFile(event.dataTransfer?.files[0]);
    });
  }

  #format(): Format {
    return this.#state.format as Format;
  }

  #keep(key: Key, text: string): void {
    this.#state[key] = text;
    const motion = this.#isFalling ? Object.keys(GRAVITIES)[0]! : this.#defaults.motion;
    writeAddress(this.#state, { ...this.#defaults, motion });
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
    // What is placed by hand or by a file stands still until Play.
    if (this.wanted) this.setWanted(false);
    const isAsBefore = this.#own !== undefined && dimensions === this.#world().dimensions;
    this.#own = boxes;
    this.#state.dimensions = String(dimensions);
    this.#state.step = "0";
    if (!isAsBefore) {
      this.named<HTMLSelectElement>("dimensions").value = this.#state.dimensions;
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
    this.#restart({ keep: true });
  }

  /** Lets the thread begin with the chosen world and algorithms: nothing is known of them yet. */
  #restart(how: { readonly keep: true } | { readonly steps: number }): void {
    const runners = this.#lanes.all;
    this.#record = new ExperimentRecord(runners.length);
    this.#frame = undefined;
    this.#noPicture = "";
    for (const part of ["boxes", "size", "spread"]) this.named<HTMLInputElement>(part).disabled = this.#own !== undefined;
    this.#send({ type: "begin", run: ++this.#run, world: this.#world(), runners, ...how });
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
      boxes: this.#own ? this.#own.length / (dimensions === "3" ? 6 : 4) : Math.round(numberWithin(boxes, 1, 100_000, Number(this.#defaults.boxes))),
      seed: Math.round(numberWithin(seed, 0, LARGEST_SEED, 1)),
      size: numberWithin(size, 0.01, 100, 1),
      spread: numberWithin(spread, 1, 1000, 1),
      ...(this.#own && { own: this.#own }),
    };
  }

  #snapshot(): Snapshot | undefined {
    const lanes = this.#frame?.lanes ?? [];
    // One that was stopped has no pairs.
    const at = lanes.findIndex((lane) => "report" in lane);
    const lane = lanes[at];
    if (!this.#frame || !lane || !("report" in lane)) return undefined;
    const { step, boxes } = this.#frame;
    return { world: this.#world(), method: this.#lanes.all[at]!, step, boxes, pairs: lane.report.pairs, address: this.#addressOf(step) };
  }

  /** The address that leads back to a step; none if that takes too many steps, or the boxes do not fit into it. */
  #addressOf(step: number): string {
    clearTimeout(this.#writing);
    this.#keep("own", this.#ownText());
    const address = new URL(location.href);
    address.searchParams.delete("step");
    if (step > 0) address.searchParams.set("step", String(step));
    return step > LAST_STEP || (this.#own && this.#state.own === "") ? "" : address.href;
  }

  #begin(steps = 0): void {
    this.#view = undefined;
    // Nothing of the boxes before stays, however long the first step takes.
    for (const part of ["message", "moment"]) this.write(part, "Working …");
    for (const part of ["alarm", "verdict"]) this.write(part, "");
    this.#lanes.show(undefined, []);
    const picture = this.named<HTMLCanvasElement>("picture");
    picture.getContext("2d")?.clearRect(0, 0, picture.width, picture.height);
    delete this.dataset["step"];
    const { scenes = [], motions = [] } = this.#lists ?? {};
    const about = [scenes.find(({ name }) => name === this.#state.scene), motions.find(({ name }) => name === this.#state.motion)];
    const brute = `Brute force would test ${formatCount(bruteForceTests(this.#world().boxes))} pairs in each step.`;
    this.write("about", [...about.flatMap((item) => item?.description ?? []), ...(this.#isFalling ? [brute] : [])].join(" "));
    this.#restart({ steps });
  }

  protected pace(): void {
    if (!this.#lists) return;
    this.#send({ type: "pace", running: this.wanted && this.awake && !this.#isHeld });
    this.showTransport();
    this.#describe();
    this.requestShow();
  }

  #send(message: ToExperiment): void {
    this.#worker?.postMessage(message);
  }

  // What comes from the thread

  #receive(message: FromExperiment): void {
    if ("run" in message && message.run !== this.#run) return;
    switch (message.type) {
      case "ready":
        this.#setUp(message.lists);
        break;
      case "loaded":
        void keep(message.files);
        break;
      case "refused":
        this.write("message", message.reason);
        this.write("moment", "Not begun");
        this.dataset["step"] = "refused";
        this.requestShow();
        break;
      case "frame":
        this.#add(message);
        if (this.#isWaiting) this.#place();
        else this.requestShow();
        break;
      case "paced":
        this.#whenPaced();
        break;
      case "failed":
        this.#fail(message.message);
        break;
    }
  }

  #fail(why: string): void {
    if (this.#lists) this.write("status", `That did not work: ${why}`);
    else showLoadFailure(this.named("message"), why);
  }

  #add(frame: ExperimentFrame): void {
    const wereOut = this.#frame?.lanes.map((lane) => "out" in lane);
    this.#frame = frame;
    this.#record.add(frame);
    const { disagreed } = this.#record;
    if (disagreed) {
      const lanes = disagreed.lanes.map((at) => `algorithm ${at + 1}`).join(" and ");
      this.write("alarm", `In step ${formatCount(disagreed.step)}, ${lanes} found other pairs than the first one. One of them is wrong.`);
    }
    if (frame.lanes.some((lane, at) => "out" in lane && wereOut?.[at] === false)) this.#describe();
  }

  protected show(): void {
    const frame = this.#frame;
    if (!frame) return;
    this.#draw(frame);
    const now = performance.now();
    if (!this.wanted || frame.step === 0 || now - this.#shownAt >= SHOW_MS) this.#showNumbers(frame, now);
    this.#send({ type: "seen", run: frame.run });
  }

  /** The numbers and the text to be copied, of the same step as the picture. */
  #showNumbers(frame: ExperimentFrame, now: number): void {
    this.#shownAt = now;
    this.#showCounters(frame);
    this.#drawPlot();
    this.#showPreview();
    if (!this.wanted) this.#describe();
  }

  /** Shows the last step completely, at once. */
  #showNow(): void {
    if (!this.#frame) return;
    this.#draw(this.#frame);
    this.#showNumbers(this.#frame, performance.now());
  }

  #draw({ boxes, pairs, balls }: ExperimentFrame): void {
    const canvas = this.named<HTMLCanvasElement>("picture");
    const { clientWidth: width, clientHeight: height } = canvas;
    const { dimensions } = this.#world();
    this.#balls.show(balls, dimensions, this.find<HTMLInputElement>("[data-part=links] input").checked ? pairs : undefined);
    this.named("surface").hidden = balls !== undefined;
    if (balls) return;
    this.#view ??= windowOf(boxes, dimensions, width, height);
    this.#colors ??= this.#readColors();
    drawBoxes(canvas, { width, height }, this.#view, boxes, dimensions, pairs, this.#colors.boxes, this.#hands.selected);
  }

  #readColors(): Colors {
    const lanes = [...this.querySelectorAll("legend")].map((legend) => getComputedStyle(legend).borderTopColor);
    const color = (name: string): string => colorOf(name, this);
    const boxes = { box: color("box"), highlighted: color("sap-overlap"), line: color("stage"), selected: color("sap-chosen") };
    return { boxes, lanes, ink: color("ink"), muted: color("muted"), grid: color("line") };
  }

  #drawPlot(): void {
    const canvas = this.named<HTMLCanvasElement>("lines");
    // A plot of one algorithm is not shown.
    if (canvas.clientWidth === 0) return;
    const { lanes, ink, muted, grid } = (this.#colors ??= this.#readColors());
    const measure = MEASURES.find(({ key }) => key === this.#state.plot) ?? MEASURES[0];
    const lines = this.#lanes.all.map(({ algorithm }, at) => ({ name: algorithm, color: lanes[at] ?? ink, values: this.#record.line(at, measure) }));
    drawLines(canvas, canvas.clientWidth, canvas.clientHeight, {
      lines, first: this.#record.first, steps: SHOWN, logarithmic: this.#state.log !== "no", label: measure.unit, ink, muted, grid,
    });
  }

  #showCounters(frame: ExperimentFrame): void {
    const { step, lanes } = frame;
    const names = this.#lanes.all.map(({ algorithm }) => algorithm);
    this.dataset["step"] = String(step);
    this.write("moment", `Step ${formatCount(step)}${frame.balls && step > 0 ? `, moved in ${frame.balls.ms.toFixed(1)} ms` : ""}`);
    this.write("message", frame.balls ? this.#noPicture : "");
    this.#lanes.show(lanes, names.map((_, at) => this.#record.level(at, MEASURES[0])));
    this.write("verdict", names.length > 1 ? verdict(frame, this.#record, names) : "");
  }

  #showPreview(): void {
    const snapshot = this.#snapshot();
    this.write("preview", snapshot ? preview(snapshot, this.#format()) : " ");
  }

  /** Tells what is going on: seldom enough to be read out. */
  #describe(): void {
    const { boxes, scene, motion, dimensions } = this.#world();
    const balls = `falling ${dimensions === 2 ? "disc" : "sphere"}${boxes === 1 ? "" : "s"}`;
    const what = `${formatCount(boxes)} ${this.#isFalling ? balls : this.#own ? `boxes of your own, ${motion}` : `boxes, ${scene}, ${motion}`}`;
    const names = this.#lanes.all.map(({ algorithm }) => algorithm);
    const where = `${what}, by ${names.join(", ")}.`;
    const lane = this.#frame?.lanes.find((lane) => "report" in lane);
    const found = lane && "report" in lane ? ` ${formatCount(lane.report.pairs)} pairs.` : "";
    this.write("status", this.wanted ? where : `Paused after step ${formatCount(this.#frame?.step ?? 0)}: ${where}${found}`);
  }
}
