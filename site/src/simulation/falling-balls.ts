import { drawStages } from "../plot/stage-plot.ts";
import { whenNear } from "../panel/awake.ts";
import { bruteForceTests, formatCount, showCounters } from "../panel/counters.ts";
import { PanelElement } from "../panel/panel-element.ts";
import { showLoadFailure } from "../load-failed.ts";
import { onThemeChange, readTheme } from "../view/theme.ts";
import { DiscView } from "../view/disc-view.ts";
import { SimulationClient } from "./client.ts";
import { type Shown, TIME_COUNTERS, WORK_COUNTERS } from "./counters.ts";
import { AXIS_NAMES, type Begun, type Choices, type Frame, type Laws, type Method } from "./messages.ts";
import { RANGES, readSettings, type Settings, setupOf, writeSettings } from "./settings.ts";

/** Numbers that change more often than this cannot be read. */
const COUNTER_MS = 120;
const NOT_COUNTED = "not counted by this algorithm";
/** The time of drawing is the mean of this many pictures. */
const WINDOW = 30;
/** The plot of the stages shows this many moments, one for each change of the counters. */
const MOMENTS = 80;
const COUNTERS = [...WORK_COUNTERS, ...TIME_COUNTERS];
/** The stages of a picture in their order: the names of their custom properties too. */
const STAGES = ["broad-phase", "narrow-phase", "solving", "drawing"] as const;

type NumberKey = "bodies" | "size" | "spread" | keyof Laws;

/**
 * `<falling-balls bodies="200" most="10000">`: discs that fall, the algorithm that
 * finds which of them may touch, and what that costs. Its inside is written by `markup.ts`. While
 * it cannot be seen it sleeps; where the visitor wants less motion it begins paused.
 */
export class FallingBalls extends PanelElement {
  readonly #mostBodies = Number(this.getAttribute("most"));
  #defaults!: Settings;
  #settings!: Settings;
  #client: SimulationClient | undefined;
  #view: DiscView | undefined;
  #begun: Begun | undefined;
  #frame: Frame | undefined;
  #ready = false;
  #countersAt = -Infinity;
  #drawingTimes: number[] = [];
  /** Milliseconds by stage, at the last moments. */
  #stages: number[][] = [];

  protected start(): void {
    void whenNear(this, this.signal).then(() => this.#open());
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.#client?.close();
  }

  #open(): void {
    this.#client = new SimulationClient({
      ready: (choices) => this.#setUp(choices),
      begun: (world) => (this.#begun = world),
      frame: (frame) => this.#receive(frame),
      failed: (message) => {
        if (this.#ready) this.say(message);
        else showLoadFailure(this.named("message"), message);
      },
    });
    this.#view = new DiscView(this.named<HTMLCanvasElement>("canvas"), readTheme());
    onThemeChange(() => {
      this.#view?.setTheme(readTheme());
      this.requestShow();
    }, this.signal);
    this.onResize(["canvas"], () => this.#fit());
    this.followAwake();
  }

  // Controls

  #setUp(choices: Choices): void {
    const preferred = (names: readonly string[], attribute: string): string => {
      const name = this.getAttribute(attribute) ?? "";
      return names.includes(name) ? name : (names[0] ?? "");
    };
    this.#defaults = {
      algorithm: preferred(choices.algorithms, "algorithm"),
      sort: preferred(choices.sorts, "sort"),
      axis: preferred(choices.axes, "axis"),
      bodies: Number(this.getAttribute("bodies")),
      size: 100,
      spread: Number(this.getAttribute("spread") ?? 1),
      seed: 1,
      gravity: 9.81,
      substeps: 8,
    };
    this.#settings = readSettings(this.id, this.#defaults, this.#mostBodies);
    this.#bindChoice("algorithm", choices.algorithms);
    this.#bindChoice("sort", choices.sorts);
    this.#bindChoice("axis", [...choices.axes, ...AXIS_NAMES]);
    this.#bindSize("bodies", RANGES.bodies.filter((n) => n <= this.#mostBodies), formatCount);
    this.#bindSize("size", RANGES.size, (size) => `${size}%`);
    this.#bindSize("spread", RANGES.spread, (spread) => `${spread} : 1`);
    const setLaws = (): void => this.#client?.setLaws(this.#laws());
    this.#bindSetting("gravity", RANGES.gravity, (gravity) => `${gravity} m/s²`, setLaws);
    this.#bindSetting("substeps", RANGES.substeps, String, setLaws);
    this.bindSeed(this.#settings.seed, (seed) => {
      this.#change({ seed });
      this.#begin();
    });
    this.bindTransport(() => this.#client?.step(), () => this.#begin());
    const lines = this.named<HTMLInputElement>("lines");
    lines.addEventListener("change", () => this.#client?.listPairs(lines.checked));
    for (const control of this.querySelectorAll<HTMLInputElement>(":disabled")) control.disabled = false;
    this.#ready = true;
    this.#begin();
    this.pace();
  }

  #bindChoice(key: keyof Method, names: readonly string[]): void {
    const select = this.named<HTMLSelectElement>(key);
    select.replaceChildren(...names.map((name) => new Option(name)));
    if (!names.includes(this.#settings[key])) this.#settings = { ...this.#settings, [key]: this.#defaults[key] };
    select.value = this.#settings[key];
    select.addEventListener("change", () => {
      this.#change({ [key]: select.value });
      this.#client?.setMethod(this.#settings);
      this.#clearCounters();
      this.#describe();
    });
  }

  /** A slider that begins a new world. */
  #bindSize(key: "bodies" | "size" | "spread", values: readonly number[], format: (value: number) => string): void {
    this.#bindSetting(key, values, format, () => this.#begin());
  }

  #bindSetting(key: NumberKey, values: readonly number[], format: (value: number) => string, changed: () => void): void {
    this.bindSlider(key, values, this.#settings[key], format, (value) => {
      this.#change({ [key]: value });
      changed();
    });
  }

  #change(settings: Partial<Settings>): void {
    this.#settings = { ...this.#settings, ...settings };
    writeSettings(this.id, this.#settings, this.#defaults);
  }

  #begin(): void {
    this.#client?.begin(setupOf(this.#settings), this.#laws(), this.#settings);
    this.#clearCounters();
    this.#counter("brute-force").textContent = formatCount(bruteForceTests(this.#settings.bodies));
    this.#describe();
  }

  #laws(): Laws {
    const { gravity, substeps } = this.#settings;
    return { gravity, substeps };
  }

  protected pace(): void {
    if (!this.#ready) return;
    this.#client?.setRunning(this.wanted && this.awake);
    this.showTransport();
    this.#describe();
    this.requestShow();
  }

  // What comes from the simulation

  #receive(frame: Frame): void {
    const first = this.#frame?.run !== frame.run;
    this.#frame = frame;
    if (first) this.#showBegun();
    if (!this.#client?.isCurrent(frame)) return this.requestShow();
    const { bodies, pairs, comparisons } = frame.measurement;
    // With one body there is nothing to compare, whatever the algorithm.
    if (pairs !== null && bodies > 1) this.#setSorts(Boolean(comparisons));
    this.requestShow();
  }

  /** A choice of sort means something only where the algorithm sorts and tells so. */
  #setSorts(sorts: boolean): void {
    const select = this.named<HTMLSelectElement>("sort");
    if (select.disabled !== sorts) return;
    select.disabled = !sorts;
    this.#describe();
  }

  /** Gives a new world to the view, once there are both, and paints its bodies by their height. */
  #showBegun(): void {
    if (!this.#view || !this.#begun || this.#frame?.run !== this.#begun.run) return;
    const { min, max, radii } = this.#begun;
    const { positions } = this.#frame;
    const [floor = 0, ceiling = 1] = [min[1], max[1]];
    const tints = radii.map((_, body) => ((positions[2 * body + 1] ?? 0) - floor) / (ceiling - floor));
    this.#view.begin({ min, max }, radii, tints);
    this.#fit();
    this.message("");
  }

  #fit(): void {
    const { clientWidth, clientHeight } = this.named("canvas");
    this.#view?.resize(clientWidth, clientHeight);
    this.show();
  }

  protected override requestShow(): void {
    if (this.awake) super.requestShow();
  }

  protected show(): void {
    if (!this.#frame) return;
    const started = performance.now();
    this.#view?.draw(this.#frame);
    const ended = performance.now();
    this.#drawingTimes.push(ended - started);
    if (this.#drawingTimes.length > WINDOW) this.#drawingTimes.shift();
    if (this.#client?.isCurrent(this.#frame) && (!this.wanted || ended - this.#countersAt >= COUNTER_MS)) {
      this.#countersAt = ended;
      this.#showCounters(this.#frame);
    }
    if (!this.wanted) this.#describe();
  }

  // What the visitor reads

  /** No number of one method or world stands under the name of another. */
  #clearCounters(): void {
    this.#stages = [];
    for (const { key } of COUNTERS) if (key !== "brute-force") this.#counter(key).textContent = "…";
  }

  #showCounters({ step, pace, hash, measurement }: Frame): void {
    this.dataset["step"] = String(step);
    if (hash) this.dataset["hash"] = hash;
    const often = this.wanted && pace > 0 ? `, ${pace.toFixed(pace < 10 ? 1 : 0)} a second` : "";
    this.named("moment").textContent = `Step ${formatCount(step)}${often}`;
    const drawing = this.#drawingTimes.reduce((sum, time) => sum + time, 0) / this.#drawingTimes.length;
    showCounters(this, COUNTERS, { ...measurement, drawing }, measurement.pairs === null ? "no step yet" : NOT_COUNTED);
    this.#showStages({ ...measurement, drawing });
  }

  /** The stages upon each other, moment by moment. */
  #showStages({ broadPhase, narrowPhase, solving, drawing }: Shown): void {
    if (broadPhase !== null) this.#stages.push([broadPhase, narrowPhase ?? 0, solving ?? 0, drawing]);
    if (this.#stages.length > MOMENTS) this.#stages.shift();
    drawStages(this.named<HTMLCanvasElement>("stages"), {
      moments: this.#stages,
      room: MOMENTS,
      colors: STAGES.map((stage) => getComputedStyle(this.find(`[data-counter="${stage}"] dt`), "::before").backgroundColor),
      ink: this.color("ink"),
      muted: this.color("muted"),
    });
  }

  /** Tells in words what is going on: seldom enough to be read out. */
  #describe(): void {
    const { bodies, algorithm, sort } = this.#settings;
    const who = `${formatCount(bodies)} disc${bodies === 1 ? "" : "s"}`;
    const by = this.named<HTMLSelectElement>("sort").disabled ? algorithm : `${algorithm}, ${sort}`;
    const frame = this.#frame?.run === this.#begun?.run ? this.#frame : undefined;
    if (this.wanted) {
      this.say(`${who}, ${by}.`);
    } else if (frame?.running) {
      this.say("Finishing this step.");
    } else if (frame && frame.measurement.pairs !== null) {
      const { tests, pairs } = frame.measurement;
      const found = `${tests === null ? "" : `${formatCount(tests)} tests found `}${formatCount(pairs)} pairs`;
      this.say(`Paused after step ${formatCount(frame.step)}: ${found}. State ${frame.hash}.`);
    } else {
      this.say(`Paused: ${who}, ${by}.`);
    }
  }

  #counter(key: string): HTMLElement {
    return this.find(`[data-counter="${key}"] dd`);
  }
}
