import { type CSSResult, html, LitElement, nothing, type TemplateResult } from "lit";
import type { TraceEvent } from "../trace.js";
import type { DemoEvent, DemoEventMap, DemoState, Row } from "./api.js";
import { Canvases } from "./canvas.js";
import { clock } from "./clock.js";
import { hasFlags, shownKinds } from "./detection.js";
import { explain, type Explanation } from "./explain.js";
import { Grab } from "./grab.js";
import { type Keyboard, keysOf, press } from "./keys.js";
import { loadDemos } from "./load.js";
import { namesOf } from "./names.js";
import { describeEvent, summary } from "./narrate.js";
import { attributes, isWorldKept, OptionError, type Options, readOptions, readStart } from "./options.js";
import { heightOfArray, paint } from "./paint.js";
import { Playback } from "./playback.js";
import { Guesses, type Question, questionAt } from "./predict.js";
import { addProperties } from "./properties.js";
import { Selection } from "./selection.js";
import { iframeOf, shareUrl } from "./share.js";
import { Speech } from "./speech.js";
import { styles } from "./styles.js";
import { controls, counters, guessing, sharing } from "./templates.js";
import { type Theme, ThemeProbe } from "./theme.js";
import { Timeline } from "./timeline.js";
import { toldAs, toldOfSort } from "./told.js";
import { rowsOf } from "./world.js";

/** Numbers that change more often cannot be read. */
const COUNTERS_MS = 100;

/** The class of `<sap-demo>`: api.ts says what others may count on. */
export class SapDemoElement extends LitElement {
  static override styles: CSSResult = styles;
  static override shadowRootOptions: ShadowRootInit = { ...LitElement.shadowRootOptions, delegatesFocus: true };

  static override get observedAttributes(): string[] {
    return [...super.observedAttributes, ...attributes];
  }

  #options: Options | undefined;
  #timeline: Timeline | undefined;
  #playback: Playback | undefined;
  /** What keeps it from beginning, to be said in its place. */
  #wrong = "";
  #isPlaying = false;
  #speed: number | undefined;
  #hasChanged = false;
  #wasDragged = false;
  #names: string[] = [];
  readonly #selection = new Selection();
  #explanation: Explanation | undefined;
  #guesses = new Guesses();
  #grab: Grab | undefined;
  #theme: Theme | undefined;
  readonly #probe: ThemeProbe;
  readonly #canvases = new Canvases(() => this.#paint());
  #countersAt = -Infinity;
  #shared: { url: string; code: string } | undefined;
  readonly #speech = new Speech(() => this.renderRoot.querySelector(".live"), () => this.#sentence);
  #setReady: () => void = () => undefined;
  readonly ready: Promise<void> = new Promise((resolve) => (this.#setReady = resolve));

  constructor() {
    super();
    this.#probe = new ThemeProbe(() => {
      this.#theme = undefined;
      this.#paint();
    });
  }

  // What others call

  play(): void {
    if (!this.#timeline || this.#isPlaying) return;
    if (this.#options!.isStatic && this.#timeline.isDetected) this.#timeline.rewind();
    this.#isPlaying = true;
    this.#playback!.restart();
    this.#changed();
  }

  pause(): void {
    if (!this.#isPlaying) return;
    this.#isPlaying = false;
    this.#changed();
    this.#speech.soon();
  }

  step(): void {
    const timeline = this.#timeline;
    if (!timeline) return;
    this.#isPlaying = false;
    if (timeline.isDetected && this.#options!.isStatic) timeline.rewind();
    else if (timeline.isDetected) this.#nextDetection();
    if (!timeline.isDetected) this.#tell(timeline.nextStop());
    this.#guesses.outcome = "";
    this.#changed();
    this.#speech.soon();
  }

  back(): void {
    if (!this.#timeline) return;
    this.#isPlaying = false;
    this.#timeline.back();
    this.#arrived();
  }

  seek(k: number): void {
    if (!this.#timeline || Number.isNaN(k)) return;
    this.#isPlaying = false;
    this.#timeline.seek(k);
    this.#arrived();
  }

  reset(): void {
    this.#begin();
    this.#speech.soon();
  }

  share(): string {
    const start = this.#wasDragged ? 0 : (this.#timeline?.tick ?? 0);
    const balls = this.#wasDragged ? JSON.stringify(this.#rows()) : this.getAttribute("balls");
    const page = new URL(this.getAttribute("embed-url") ?? "embed.html", document.baseURI);
    return shareUrl(page, (name) => this.getAttribute(name), { balls, start });
  }

  embedCode(): string {
    return iframeOf(this.share(), this.#label, this.getBoundingClientRect().height + 32);
  }

  get isPlaying(): boolean {
    return this.#isPlaying;
  }

  get state(): DemoState {
    const { tick = 0, position = 0 } = this.#timeline ?? {};
    return { tick, events: position, ...this.#counts, hash: this.#timeline?.hash() ?? "" };
  }

  get event(): DemoEvent | undefined {
    const { event, position = 0 } = this.#timeline ?? {};
    return event && toldAs(event, position - 1);
  }

  get balls(): Row[] {
    return this.#timeline ? rowsOf(this.#timeline.positions, this.#timeline.radii) : [];
  }

  set balls(value: number | readonly Row[]) {
    this.setAttribute("balls", typeof value === "number" ? String(value) : JSON.stringify(value));
  }

  get pairs(): [number, number][] {
    const { overlaps = [] } = this.#timeline?.state ?? {};
    return Array.from({ length: overlaps.length / 2 }, (_, i) => [overlaps[2 * i]!, overlaps[2 * i + 1]!]);
  }

  get chosen(): number[] {
    return [...this.#selection.chosen];
  }

  // Its life

  override connectedCallback(): void {
    super.connectedCallback();
    clock.add(this, { frame: (ms) => this.#frame(ms) });
    motionQuery.addEventListener("change", this.#onMotionChange);
    loadDemos().then(
      () => this.isConnected && !this.#timeline && this.#begin(),
      (error: unknown) => this.#refuse(`This demo could not be loaded. ${error instanceof Error ? error.message : String(error)}`),
    );
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    clock.remove(this);
    this.#canvases.close();
    motionQuery.removeEventListener("change", this.#onMotionChange);
    this.#speech.stop();
    // One that is only moved within the page goes on where it was.
    setTimeout(() => {
      if (this.isConnected) return;
      this.#timeline?.free();
      this.#timeline = undefined;
    });
  }

  override attributeChangedCallback(name: string, old: string | null, value: string | null): void {
    super.attributeChangedCallback(name, old, value);
    if (old === value || !(attributes as readonly string[]).includes(name)) return;
    if (!this.#timeline && this.#wrong === "") return;
    if (name === "paused") return value === null ? this.play() : this.pause();
    // Several that change at once are read at once.
    if (!this.#hasChanged) queueMicrotask(() => this.#understand());
    this.#hasChanged = true;
  }

  /** Reads the attributes anew, and goes on in the same world if they leave it as it was. */
  #understand(): void {
    this.#hasChanged = false;
    const before = this.#options;
    const options = this.#readOptions();
    if (!options) return;
    if (!this.#timeline || !before || !isWorldKept(before, options)) return this.#begin();
    const { tick } = this.#timeline;
    this.#open(options, new Timeline(options, shownKinds(options.decorations, options.detecting), this.#timeline.release(), tick));
    if (!this.#isPlaying) this.#timeline.finish();
    this.#changed();
  }

  #begin(): void {
    const options = this.#readOptions();
    if (!options) return;
    let timeline: Timeline;
    try {
      timeline = Timeline.at(options, shownKinds(options.decorations, options.detecting), readStart(this.getAttribute("start")));
    } catch (error) {
      return this.#refuse(messageOf(error));
    }
    this.#timeline?.free();
    this.#open(options, timeline);
    this.#wasDragged = false;
    this.#selection.clear();
    this.#guesses = new Guesses();
    const isStill = this.hasAttribute("paused") || options.isStatic || options.predicts || motionQuery.matches;
    if (options.isStatic && !options.predicts) timeline.finish();
    this.#isPlaying = !isStill;
    this.#changed();
    this.#emit("simulate", this.state);
    void this.updateComplete.then(this.#setReady);
  }

  #open(options: Options, timeline: Timeline): void {
    this.#wrong = "";
    this.#options = options;
    this.#timeline = timeline;
    this.#playback = new Playback(timeline, options);
    this.#names = namesOf(options.labels, timeline.radii.length);
    this.#speed = undefined;
  }

  #readOptions(): Options | undefined {
    try {
      return readOptions((name) => this.getAttribute(name));
    } catch (error) {
      this.#refuse(messageOf(error));
      return undefined;
    }
  }

  /** Says what is wrong in the picture: an exception would tell nobody. */
  #refuse(message: string): void {
    this.#timeline?.free();
    this.#timeline = undefined;
    this.#options = undefined;
    this.#isPlaying = false;
    this.#wrong = message;
    this.requestUpdate();
    void this.updateComplete.then(this.#setReady);
  }

  readonly #onMotionChange = (): void => {
    if (motionQuery.matches) this.pause();
  };

  // Time

  #frame(ms: number): boolean {
    if (!this.#timeline) return false;
    try {
      if (this.#isPlaying) this.#isPlaying = this.#playback!.advance(ms * (this.#speed ?? this.#options!.speed), this.#listener);
      this.#paint();
    } catch (error) {
      // Out of memory, at most. The other demos of the page go on.
      this.#refuse(messageOf(error));
      return false;
    }
    const now = performance.now();
    if (!this.#isPlaying || now - this.#countersAt >= COUNTERS_MS) this.#update(now);
    return this.#isPlaying;
  }

  readonly #listener = {
    stopped: (events: readonly TraceEvent[]): void => this.#tell(events),
    ticking: (): void => {
      const { held, target } = this.#grab ?? {};
      if (held !== undefined && target) this.#place(held, target.x, target.y, 0, 0);
    },
    ticked: (): void => {
      this.#emit("simulate", this.state);
    },
  };

  #nextDetection(): void {
    do this.#playback!.tick(this.#listener);
    while (!this.#timeline!.hasDetection);
  }

  /** Something is to be shown anew. */
  #changed(): void {
    if (this.#isPlaying) clock.wake(this);
    this.#update(performance.now());
  }

  #update(now: number): void {
    this.#countersAt = now;
    this.#explanation = this.#explainChosen();
    this.requestUpdate();
  }

  // Telling

  #emit<K extends keyof DemoEventMap>(type: K, detail: DemoEventMap[K]["detail"]): void {
    this.dispatchEvent(new CustomEvent(type, { detail, bubbles: true, composed: true }));
  }

  #tell(events: readonly TraceEvent[]): void {
    const first = this.#timeline!.position - events.length;
    events.forEach((event, index) => this.#tellEvent(event, first + index));
  }

  #tellEvent(event: TraceEvent | undefined, index: number): void {
    const detail = event && toldAs(event, index);
    if (!event || !detail) return;
    const ofSort = toldOfSort(event);
    if (ofSort) this.#emit("sap-sort", ofSort);
    this.#emit("sap-event", detail);
  }

  /** After a jump: what is at work here, and in words. */
  #arrived(): void {
    const { event, position } = this.#timeline!;
    this.#tellEvent(event, position - 1);
    this.#guesses.outcome = "";
    this.#changed();
    this.#speech.soon();
  }

  get #sentence(): string {
    const timeline = this.#timeline;
    if (!timeline) return "";
    if (this.#explanation) return this.#explanation.text;
    const { event, detection, tick } = timeline;
    if (event) return describeEvent(event, { boxes: detection.boxes, names: this.#names });
    return summary(timeline.isDetected, this.#options!.isStatic ? undefined : tick, timeline.radii.length, detection, this.#names, this.#flagChecks);
  }

  // Hands

  #rows(): number[][] {
    const velocities = this.#timeline!.velocities();
    const rounded = (value: number): number => Math.round(value * 100) / 100;
    return this.balls.map((row, ball) => [...row.map(Number), velocities[2 * ball]!, velocities[2 * ball + 1]!].map(rounded));
  }

  #place(ball: number, x: number, y: number, vx: number, vy: number): void {
    this.#timeline!.placeBall(ball, x, y, vx, vy);
    this.#wasDragged = true;
  }

  /** A ball is moved by hand. Where the world stands still, the algorithm runs again at once. */
  #moveBall(ball: number, x: number, y: number): void {
    const timeline = this.#timeline!;
    if (!this.#isPlaying) {
      this.#place(ball, x, y, 0, 0);
      timeline.detectAgain();
      this.#emit("simulate", this.state);
    }
    this.#emit("sap-drag", { ball, x: timeline.positions[2 * ball]!, y: timeline.positions[2 * ball + 1]! });
    this.#changed();
  }

  #choose(ball: number | undefined): void {
    const selection = this.#selection;
    selection.cursor = ball;
    if (this.#options!.explains) {
      selection.take(ball);
      if (selection.pair) this.pause();
    }
    this.#changed();
    if (selection.pair) this.#speech.soon();
  }

  #explainChosen(): Explanation | undefined {
    const { pair } = this.#selection;
    return this.#timeline && pair && explain(this.#timeline.detection, this.#names, ...pair);
  }

  readonly #keyboard: Keyboard = {
    stepOrPause: () => (this.#isPlaying ? this.pause() : this.step()),
    step: () => this.step(),
    back: () => this.back(),
    moveCursor: (by) => {
      const balls = this.#timeline!.radii.length;
      if (balls === 0) return;
      this.#selection.moveCursor(by, balls);
      this.#changed();
      this.#speech.now(`Ball ${this.#names[this.#selection.cursor!]}`);
    },
    take: () => this.#selection.cursor !== undefined && this.#choose(this.#selection.cursor),
    takeNone: () => this.#choose(undefined),
    push: (dx, dy) => {
      const { positions, radii } = this.#timeline!;
      const ball = (this.#selection.cursor ??= 0);
      if (ball >= radii.length) return;
      this.pause();
      this.#moveBall(ball, positions[2 * ball]! + dx, positions[2 * ball + 1]! + dy);
      this.#speech.soon();
    },
    guess: (choice) => this.#guess(choice),
  };

  get #question(): Question | undefined {
    const timeline = this.#timeline;
    return timeline && this.#options?.predicts && !this.#isPlaying ? questionAt(timeline, this.#names) : undefined;
  }

  #guess(choice: 0 | 1): void {
    const question = this.#question;
    if (!question) return;
    this.step();
    this.#guesses.count(question, choice);
  }

  // Showing

  get #counts(): Omit<DemoState, "tick" | "events" | "hash"> {
    const state = this.#timeline?.state;
    const { tests = 0, pairs = 0, comparisons = 0, swaps = 0 } = state?.counts ?? {};
    // Those that there are: also where the algorithm keeps them and tells only of changes.
    return { tests, flagChecks: this.#flagChecks ?? 0, axisOverlaps: state?.axisOverlaps.length ?? 0, pairs, comparisons, swaps };
  }

  /** Undefined where there are tests. */
  get #flagChecks(): number | undefined {
    if (!this.#timeline || !hasFlags(this.#options!.detecting)) return undefined;
    return this.#timeline.detection.flagChecksAt(this.#timeline.position);
  }

  get #label(): string {
    return this.getAttribute("aria-label") ?? (this.#options?.heading || "Balls, and an algorithm that finds which of them overlap");
  }

  #paint(): void {
    const [timeline, options] = [this.#timeline, this.#options];
    if (!timeline || !options || !this.hasUpdated) return;
    this.#theme ??= this.#probe.read();
    paint(this.renderRoot, this.#canvases, {
      timeline,
      options,
      names: this.#names,
      marked: this.#selection.marked,
      explanation: this.#explanation,
      lineAt: this.#playback!.lineAt(this.#isPlaying),
      theme: this.#theme,
    });
  }

  override firstUpdated(): void {
    this.renderRoot.append(this.#probe.element);
    this.#grab = new Grab(this.renderRoot.querySelector(".picture")!, {
      balls: () => this.#timeline,
      isDraggable: () => this.#options?.isDraggable === true,
      move: (ball, x, y) => this.#moveBall(ball, x, y),
      release: (ball, vx, vy) => {
        if (this.#isPlaying) this.#place(ball, this.#timeline!.positions[2 * ball]!, this.#timeline!.positions[2 * ball + 1]!, vx, vy);
      },
      choose: (ball) => this.#options && this.#choose(ball),
    });
  }

  override updated(): void {
    this.#paint();
  }

  override render(): TemplateResult {
    const options = this.#options;
    const hasControls = options?.hasControls ?? !this.hasAttribute("no-controls");
    const hasCounters = options?.hasCounters ?? !this.hasAttribute("no-counters");
    return html`
      <slot name="heading">${options?.heading ? html`<p class="heading">${options.heading}</p>` : nothing}</slot>
      <div class="frame">
      <div class="picture" part="picture" role="application" tabindex="0" aria-label=${this.#label} aria-describedby="keys" @keydown=${(event: KeyboardEvent) => this.#timeline && press(event, this.#options!, this.#keyboard)}>
        <canvas></canvas>
        ${this.#wrong ? html`<p class="wrong" role="alert">${this.#wrong}</p>` : nothing}
      </div>
      <p id="keys" class="hidden">${keysOf(options)}</p>
      ${options?.decorations.array ? this.#array() : nothing}
      ${hasControls ? html`<p class="said" part="said" aria-hidden="true" ?data-explains=${this.#explanation !== undefined}>${this.#sentence}</p>` : nothing}
      ${options?.predicts ? guessing({ guesses: this.#guesses, question: this.#question, guess: (choice) => this.#guess(choice) }) : nothing}
      <p class="live hidden" role="status" aria-live="polite"></p>
      ${hasCounters ? counters(this.#counts, options !== undefined && hasFlags(options.detecting)) : nothing}
      ${hasControls ? this.#controls() : nothing}
      </div>
      <slot name="caption"></slot>
    `;
  }

  #array(): TemplateResult {
    const height = heightOfArray(this.#options!, this.#timeline!.radii.length);
    return html`<canvas class="array" part="array" role="img" aria-label="The array of endpoints, in order" style="height:${height}px"></canvas>`;
  }

  #controls(): TemplateResult {
    const timeline = this.#timeline;
    const bar = controls({
      isReady: timeline !== undefined,
      isPlaying: this.#isPlaying,
      canPlay: !(this.#options?.isStatic && timeline?.isStopless),
      canGoBack: timeline?.hasPast === true,
      progress: timeline?.progress ?? { at: 0, of: 0 },
      speed: this.#speed ?? this.#options?.speed ?? 1,
      playOrPause: () => (this.#isPlaying ? this.pause() : this.play()),
      back: () => this.back(),
      step: () => this.step(),
      seek: (place) => this.seek(place),
      setSpeed: (speed) => {
        this.#speed = speed;
        this.#changed();
      },
      reset: () => this.reset(),
      share: () => {
        // As it is now: what is shown to be copied does not change meanwhile.
        this.#shared = { url: this.share(), code: this.embedCode() };
        this.requestUpdate();
        void this.updateComplete.then(() => this.renderRoot.querySelector<HTMLElement>(".share")?.togglePopover());
      },
    });
    return html`${bar} ${this.#shared ? sharing(this.#shared.url, this.#shared.code) : nothing}`;
  }
}

const motionQuery: MediaQueryList = matchMedia("(prefers-reduced-motion: reduce)");

function messageOf(error: unknown): string {
  return error instanceof OptionError ? error.message : `This demo cannot begin. ${String(error)}`;
}

addProperties(SapDemoElement.prototype);
