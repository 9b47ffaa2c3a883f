import { type CSSResult, html, LitElement, nothing, svg, type TemplateResult } from "lit";
import type { TraceEvent } from "../trace.js";
import { clock } from "./clock.js";
import { shownKinds } from "./detection.js";
import { drawScene } from "./draw.js";
import { arrayHeight, drawArray } from "./draw-array.js";
import { loadDemos } from "./load.js";
import { namesOf } from "./names.js";
import { describeEvent } from "./narrate.js";
import { type Attribute, attributes, OptionError, type Options, readOptions, readStart, type Row, WIDTH } from "./options.js";
import { styles } from "./styles.js";
import { type Theme, ThemeProbe } from "./theme.js";
import { Timeline } from "./timeline.js";
import { rowsOf } from "./world.js";

/** What a demo shows at one moment, in numbers. */
export interface DemoState {
  /** Ticks of 1/60 s since the beginning. */
  tick: number;
  /** How many events of the detection have been played. */
  events: number;
  /** Pairs of boxes handed to the box test. */
  tests: number;
  /** Pairs that overlap on the swept axes, as far as is known. */
  axisOverlaps: number;
  /** Pairs found to overlap. */
  pairs: number;
  /** Comparisons of the sort. */
  comparisons: number;
  /** Swaps of the sort. */
  swaps: number;
  /** Positions and velocities, bit for bit, in 16 hexadecimal digits. */
  hash: string;
}

/** One event, as listeners of `sap-event` are told it. */
export interface DemoEvent {
  kind: "compare" | "swap" | "test" | "enter" | "leave" | "overlap" | "skip";
  /** The balls; of `enter` and `leave` both are the one. */
  a: number;
  b: number;
  /** Which event of the detection. */
  index: number;
}

const MS_PER_TICK = 1000 / 60;
/** How long each event of a sort stays lit. */
const SORT_MS = 90;
/** How fast the sweep line goes, in pixels of the world a millisecond. */
const LINE_SPEED = 0.35;
/** Numbers that change more often cannot be read. */
const COUNTERS_MS = 100;
/** The live region speaks no more often. */
const SPEECH_MS = 700;
/** Events in one frame, at most: fast-forward is no reason to stall. */
const MOST_STOPS = 400;

/** Which class of event `sap-event` tells a trace event as. */
const told: Partial<Record<TraceEvent["kind"], DemoEvent["kind"]>> = {
  compare: "compare",
  swap: "swap",
  test: "test",
  enter: "enter",
  leave: "leave",
  overlap: "overlap",
  prune: "skip",
};

/**
 * `<sap-demo>`: balls, and an algorithm at work on them, step by step. What it does stands in its
 * attributes, which may change at any time; see the package's documentation of the element.
 */
export class SapDemo extends LitElement {
  static override styles: CSSResult = styles;

  static override get observedAttributes(): string[] {
    return [...super.observedAttributes, ...attributes];
  }

  #options: Options | undefined;
  #wrong = "";
  #timeline: Timeline | undefined;
  #isLoaded = false;
  #isPlaying = false;
  /** Milliseconds spent at the stop, or since the last tick. */
  #spent = 0;
  #theme: Theme | undefined;
  readonly #probe: ThemeProbe;
  #resized: ResizeObserver | undefined;
  #names: string[] = [];
  #chosen: number[] = [];
  #countersAt = -Infinity;
  #spokenAt = -Infinity;
  #speech: ReturnType<typeof setTimeout> | undefined;

  constructor() {
    super();
    this.#probe = new ThemeProbe(() => {
      this.#theme = undefined;
      this.#draw();
    });
  }

  // What others call

  /** Plays on, from wherever it is. */
  play(): void {
    if (!this.#timeline || this.#isPlaying) return;
    if (this.#options?.isStatic && this.#timeline.isDetected) this.#timeline.seek(0);
    this.#isPlaying = true;
    this.#spent = 0;
    this.#wake();
  }

  pause(): void {
    this.#isPlaying = false;
    this.#wake();
  }

  /** Goes on to the next event that is shown, or to the next detection. */
  step(): void {
    if (!this.#timeline) return;
    this.pause();
    if (this.#timeline.isDetected) this.#nextDetection();
    if (!this.#timeline.isDetected) this.#tell(this.#timeline.nextStop());
    this.#speak();
  }

  /** Goes back to the event before, or the detection before. */
  back(): void {
    if (!this.#timeline) return;
    this.pause();
    if (this.#timeline.back()) this.#tellEvent(this.#timeline.event, this.#timeline.position - 1);
    this.#speak();
  }

  /** Goes to one of the moments that are kept, counted from the oldest. */
  seek(k: number): void {
    if (!this.#timeline || !Number.isFinite(k)) return;
    this.pause();
    this.#timeline.seek(k);
    this.#tellEvent(this.#timeline.event, this.#timeline.position - 1);
    this.#speak();
  }

  /** Begins anew, as the attributes say. */
  reset(): void {
    this.#begin();
  }

  get isPlaying(): boolean {
    return this.#isPlaying;
  }

  get state(): DemoState {
    const { tick = 0, position = 0 } = this.#timeline ?? {};
    return { tick, events: position, ...this.#counts, hash: this.#timeline?.hash() ?? "" };
  }

  get #counts(): Pick<DemoState, "tests" | "axisOverlaps" | "pairs" | "comparisons" | "swaps"> {
    const state = this.#timeline?.state;
    const { tests = 0, pairs = 0, comparisons = 0, swaps = 0 } = state?.counts ?? {};
    // Those that there are: also where the algorithm keeps them and tells only of changes.
    return { tests, axisOverlaps: state?.axisOverlaps.length ?? 0, pairs, comparisons, swaps };
  }

  /** The event at work, if there is one. */
  get event(): DemoEvent | undefined {
    const { event, position = 0 } = this.#timeline ?? {};
    return event && toldAs(event, position - 1);
  }

  /** The balls where they are: rows of x, y, radius. */
  get balls(): Row[] {
    return this.#timeline ? rowsOf(this.#timeline.positions, this.#timeline.radii) : [];
  }

  /** The pairs found so far in this detection. */
  get pairs(): [number, number][] {
    const { overlaps = [] } = this.#timeline?.state ?? {};
    return Array.from({ length: overlaps.length / 2 }, (_, i) => [overlaps[2 * i]!, overlaps[2 * i + 1]!]);
  }

  // Its life

  override connectedCallback(): void {
    super.connectedCallback();
    clock.add(this, { frame: (ms) => this.#frame(ms) });
    this.#resized = new ResizeObserver(() => this.#draw());
    void loadDemos().then(
      () => {
        if (!this.isConnected || this.#timeline) return;
        this.#isLoaded = true;
        this.#begin();
      },
      (error: unknown) => {
        this.#wrong = `This demo could not be loaded: ${error instanceof Error ? error.message : String(error)}`;
        this.requestUpdate();
      },
    );
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    clock.remove(this);
    this.#resized?.disconnect();
    clearTimeout(this.#speech);
  }

  override attributeChangedCallback(name: string, old: string | null, value: string | null): void {
    if (!(attributes as readonly string[]).includes(name)) super.attributeChangedCallback(name, old, value);
    if (old === value || !this.#isLoaded) return;
    queueMicrotask(() => this.#understand());
  }

  /** Reads the attributes anew, and keeps what they leave as it is. */
  #understand(): void {
    this.#begin();
  }

  #begin(): void {
    this.#timeline?.free();
    this.#timeline = undefined;
    this.#wrong = "";
    try {
      const options = readOptions((name) => this.getAttribute(name));
      const start = readStart(this.getAttribute("start"));
      this.#options = options;
      const hasTests = !options.detecting.method.endsWith("on every axis");
      this.#timeline = new Timeline(options, shownKinds(options.decorations, hasTests));
      for (let tick = 0; tick < start; tick++) this.#timeline.nextTick();
      this.#names = namesOf(options.labels, this.#timeline.radii.length);
      this.#chosen = [];
      if (options.isStatic) this.#timeline.finish();
    } catch (error) {
      // What is wrong is said in the picture: an exception here would tell nobody.
      this.#wrong = error instanceof OptionError ? error.message : `This demo cannot begin: ${String(error)}`;
    }
    this.#isPlaying = false;
    const isStill = this.hasAttribute("paused") || this.#options?.isStatic || prefersReducedMotion();
    if (!isStill) this.play();
    this.#countersAt = -Infinity;
    this.requestUpdate();
    this.#wake();
  }

  // Time

  #wake(): void {
    this.requestUpdate();
    clock.wake(this);
    if (!this.#isPlaying) this.#draw();
  }

  #frame(ms: number): boolean {
    if (!this.#timeline) return false;
    if (this.#isPlaying) this.#advance(ms * (this.#options?.speed ?? 1));
    this.#draw();
    return this.#isPlaying;
  }

  #advance(ms: number): void {
    const timeline = this.#timeline!;
    this.#spent += ms;
    for (let stops = 0; stops < MOST_STOPS; stops++) {
      const needed = timeline.isDetected ? MS_PER_TICK : this.#duration();
      if (this.#spent < needed) return;
      if (timeline.isDetected && this.#options!.isStatic) return this.pause();
      this.#spent -= needed;
      if (timeline.isDetected) this.#nextTick();
      else this.#tell(timeline.nextStop());
    }
    this.#spent = 0;
  }

  /** How long the stop at work lasts. */
  #duration(): number {
    const { event } = this.#timeline!;
    const { checks } = this.#options!.decorations;
    switch (event?.kind) {
      case "test":
      case "overlap":
        return checks?.ms ?? 0;
      case "compare":
      case "swap":
        return SORT_MS;
      case "enter":
      case "leave":
        return this.#lineTravel().ms;
      default:
        return 0;
    }
  }

  /** Where the sweep line is, where it goes to, and how long it takes. */
  #lineTravel(): { from: number; to: number; ms: number } {
    const { state, detection, position } = this.#timeline!;
    const array = state.arrays[state.arrayAxis] ?? [];
    const at = state.line ? (array[state.line.position]?.at ?? 0) : 0;
    const next = detection.events.slice(position).find(({ kind }) => kind === "visit");
    const to = next ? (array[Number(next["position"])]?.at ?? at) : at;
    return { from: at, to, ms: Math.abs(to - at) / LINE_SPEED };
  }

  #nextTick(): void {
    const timeline = this.#timeline!;
    timeline.nextTick();
    this.#skipStopless();
    this.dispatchEvent(new CustomEvent("simulate", { detail: this.state, bubbles: true, composed: true }));
  }

  /** A detection of which no event is shown is done at once. */
  #skipStopless(): void {
    const timeline = this.#timeline!;
    if (!timeline.isDetected && timeline.isStopless) timeline.finish();
  }

  #nextDetection(): void {
    if (this.#options!.isStatic) return;
    do this.#nextTick();
    while (!this.#timeline!.hasDetection);
  }

  // Telling

  #tell(events: readonly TraceEvent[]): void {
    const { position } = this.#timeline!;
    events.forEach((event, index) => this.#tellEvent(event, position - events.length + index));
  }

  #tellEvent(event: TraceEvent | undefined, index: number): void {
    const detail = event && toldAs(event, index);
    if (!event || !detail) return;
    const isSort = detail.kind === "compare" || detail.kind === "swap";
    if (isSort) {
      const i = Number(event["i"] ?? event["a"]);
      const j = Number(event["j"] ?? event["b"]);
      this.dispatchEvent(new CustomEvent("sap-sort", { detail: { kind: detail.kind, i, j }, bubbles: true, composed: true }));
    }
    this.dispatchEvent(new CustomEvent("sap-event", { detail, bubbles: true, composed: true }));
  }

  get #sentence(): string {
    const timeline = this.#timeline;
    if (!timeline) return "";
    const { event, detection, tick } = timeline;
    if (event) return describeEvent(event, { boxes: detection.boxes, names: this.#names });
    const { pairs, counts } = detection.step;
    if (!timeline.isDetected) return `Tick ${tick}: the boxes are as drawn. Nothing has been tested yet.`;
    const found = pairs.length / 2;
    return `Tick ${tick}: ${counts.tests} ${counts.tests === 1 ? "test" : "tests"}, ${found} overlapping ${found === 1 ? "pair" : "pairs"}.`;
  }

  /** Lets the live region say where we are, soon and not too often. */
  #speak(): void {
    const now = performance.now();
    clearTimeout(this.#speech);
    this.#speech = setTimeout(() => {
      this.#spokenAt = performance.now();
      const region = this.renderRoot.querySelector(".live");
      if (region) region.textContent = this.#sentence;
    }, Math.max(100, this.#spokenAt + SPEECH_MS - now));
  }

  // Drawing

  #draw(): void {
    this.#paint();
    const now = performance.now();
    if (this.#isPlaying && now - this.#countersAt < COUNTERS_MS) return;
    this.#countersAt = now;
    this.requestUpdate();
  }

  /** The canvases alone. */
  #paint(): void {
    const timeline = this.#timeline;
    const options = this.#options;
    if (!timeline || !options || !this.hasUpdated) return;
    this.#theme ??= this.#probe.read();
    const { state, event, position, detection } = timeline;
    const { decorations, focus } = options;
    const isRainbow = this.hasAttribute("rainbow");
    let lineAt: number | undefined;
    if (decorations.sweep && position > 0 && !timeline.isDetected) {
      const { from, to, ms } = this.#lineTravel();
      const isMoving = this.#isPlaying && ms > 0 && (event?.kind === "enter" || event?.kind === "leave");
      const share = isMoving ? Math.min(1, this.#spent / ms) : 0;
      lineAt = from + (to - from) * share;
    }
    const common = { state, event, decorations, isRainbow, focus, chosen: this.#chosen };
    const labels = options.labels === undefined ? [] : this.#names;
    const { positions, radii } = timeline;
    const context = contextOf(this.renderRoot.querySelector<HTMLCanvasElement>(".picture canvas"), WIDTH);
    if (context) {
      drawScene(context, { ...common, positions, radii, labels, lineAt, hasBoxes: this.hasAttribute("boxes"), axis: detection.step.axis }, this.#theme);
    }
    if (decorations.array) {
      const canvas = this.renderRoot.querySelector<HTMLCanvasElement>("canvas.array");
      const array = contextOf(canvas);
      if (array && canvas) drawArray(array, canvas.clientWidth, { ...common, labels: this.#names }, this.#theme);
    }
  }

  override firstUpdated(): void {
    this.renderRoot.append(this.#probe.element);
    this.#resized?.observe(this.renderRoot.querySelector(".picture")!);
  }

  override updated(): void {
    if (!this.#isPlaying) this.#paint();
  }

  override render(): TemplateResult {
    const { decorations } = this.#options ?? {};
    const label = this.getAttribute("aria-label") ?? this.getAttribute("heading") ?? "Demo of an algorithm that finds overlapping boxes";
    const balls = this.#timeline?.radii.length ?? 0;
    const axes = this.#options?.detecting.method.endsWith("every axis") ? 2 : 1;
    return html`
      <slot name="heading">${this.getAttribute("heading") ? html`<p class="heading">${this.getAttribute("heading")}</p>` : nothing}</slot>
      <div class="picture" part="picture" role="application" tabindex="0" aria-label=${label} aria-describedby="keys" @keydown=${this.#onKey}>
        <canvas></canvas>
        ${this.#wrong ? html`<p class="wrong" role="alert">${this.#wrong}</p>` : nothing}
      </div>
      <p id="keys" class="hidden">Space: step, or pause. Brackets: step back and forward.</p>
      ${decorations?.array
        ? html`<canvas class="array" part="array" role="img" aria-label="The endpoints in the order of the array" style="height:${arrayHeight(2 * balls, axes)}px"></canvas>`
        : nothing}
      ${this.hasAttribute("no-controls") ? nothing : html`<p class="said" part="said" aria-hidden="true">${this.#sentence}</p>`}
      <p class="live hidden" role="status" aria-live="polite"></p>
      ${this.hasAttribute("no-counters") ? nothing : this.#counters()}
      ${this.hasAttribute("no-controls") ? nothing : this.#controls()}
      <slot name="caption"></slot>
    `;
  }

  #counters(): TemplateResult {
    const { tests, axisOverlaps, pairs, comparisons, swaps } = this.#counts;
    const rows = { tests, "axis overlaps": axisOverlaps, pairs, comparisons, swaps };
    return html`<dl class="counters" part="counters">
      ${Object.entries(rows).map(([name, value]) => html`<div><dt>${name}</dt><dd data-counter=${name.replace(" ", "-")}>${value.toLocaleString("en")}</dd></div>`)}
    </dl>`;
  }

  #controls(): TemplateResult {
    const { at, of } = this.#timeline?.progress ?? { at: 0, of: 0 };
    const none = this.#timeline === undefined;
    return html`<div class="controls" part="controls" role="group" aria-label="Controls">
      ${this.#button(this.#isPlaying ? "Pause" : "Play", this.#isPlaying ? icons.pause : icons.play, none, () => (this.#isPlaying ? this.pause() : this.play()))}
      ${this.#button("Step back", icons.back, none || !this.#timeline!.hasPast, () => this.back())}
      ${this.#button("Step", icons.step, none, () => this.step())}
      <input type="range" aria-label="History" min="0" .max=${String(of)} .value=${String(at)} ?disabled=${none}
        aria-valuetext="moment ${at} of ${of}" @input=${(event: Event) => this.seek(Number((event.target as HTMLInputElement).value))} />
      ${this.#button("Reset", icons.reset, none, () => this.reset())}
    </div>`;
  }

  #button(label: string, icon: TemplateResult, disabled: boolean, click: () => void): TemplateResult {
    return html`<button type="button" aria-label=${label} title=${label} ?disabled=${disabled} @click=${click}>${icon}</button>`;
  }

  readonly #onKey = (event: KeyboardEvent): void => {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    const actions: Record<string, () => void> = {
      " ": () => (this.#isPlaying ? this.pause() : this.step()),
      "[": () => this.back(),
      ",": () => this.back(),
      "]": () => this.step(),
      ".": () => this.step(),
    };
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  };
}

const icon = (path: string): TemplateResult => html`<svg viewBox="0 0 16 16" aria-hidden="true">${svg`<path d=${path} />`}</svg>`;
const icons = {
  play: icon("M3 1.5v13l11-6.5z"),
  pause: icon("M3 2h3.5v12H3zM9.500 2H13v12H9.500z"),
  step: icon("M2 1.500v13l9-6.500zM11.500 2H14v12h-2.500z"),
  back: icon("M14 1.500v13L5 8zM2 2h2.500v12H2z"),
  reset: icon("M8 2a6 6 0 1 1-5.700 4.100l1.900.6A4 4 0 1 0 8 4v2.500L3.800 3 8-.5z"),
};

function toldAs(event: TraceEvent, index: number): DemoEvent | undefined {
  const kind = told[event.kind];
  if (!kind) return undefined;
  const a = Number(event["a"] ?? event["left"] ?? event["id"]);
  const b = Number(event["b"] ?? event["right"] ?? event["id"]);
  const isEdges = kind === "compare" || kind === "swap";
  return { kind, a: isEdges ? a >> 1 : a, b: isEdges ? b >> 1 : b, index };
}

function prefersReducedMotion(): boolean {
  return matchMedia("(prefers-reduced-motion: reduce)").matches;
}

/** The context of a canvas as large as it is shown, scaled to so many units across; or to CSS pixels. */
function contextOf(canvas: HTMLCanvasElement | null, units?: number): CanvasRenderingContext2D | undefined {
  const context = canvas?.getContext("2d");
  if (!canvas || !context || canvas.clientWidth === 0) return undefined;
  const ratio = Math.min(devicePixelRatio, 3);
  const [width, height] = [Math.round(canvas.clientWidth * ratio), Math.round(canvas.clientHeight * ratio)];
  if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
  const scale = units === undefined ? ratio : width / units;
  context.setTransform(scale, 0, 0, scale, 0, 0);
  return context;
}

export type { Attribute };
