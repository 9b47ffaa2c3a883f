import { type CSSResult, LitElement, type TemplateResult } from "lit";
import type { TraceEvent } from "../algorithms/trace.js";
import type { DemoEvent, DemoMark, DemoProgram, DemoState, Row } from "./types.js";
import { Canvases } from "./canvas.js";
import { clock } from "./clock.js";
import { comparisonOf, type SapComparisonElement } from "./comparison.js";
import type { Explanation } from "./explain.js";
import { Hands } from "./hands.js";
import { press } from "./keys.js";
import { loadDemos } from "./load.js";
import { messageOf } from "./option-error.js";
import { motionQuery } from "./motion-query.js";
import { asksOfScan, attributes, HEIGHT, hasSeed, isOn, MOST_TICKS, newSeed, type Options, readOptions, readStart, readStop, WIDTH } from "./options.js";
import { paint } from "./paint.js";
import { Guesses, type Question } from "./predict.js";
import { addProperties } from "./properties.js";
import { NOTHING_COUNTED, Run } from "./run.js";
import { shareUrl } from "./share.js";
import { iframeOf } from "./snippet.js";
import { Speech } from "./speech.js";
import { styles } from "./styles.js";
import { FLASH_MS, SwapLog } from "./swap-log.js";
import { type Theme, ThemeProbe } from "./theme.js";
import type { Member } from "./together.js";
import { emit, report } from "./report.js";
import { turnOf } from "./turns.js";
import { type Acts, inside } from "./view.js";

/** Numbers that change more often cannot be read. */
const COUNTERS_MS = 100;
/** How high the controls are where they need two rows, in CSS pixels: --sap-two-rows in demo.css. */
const CONTROLS_HEIGHT = 98;
/** Steps without a question between two with one, at most. */
const MOST_SKIPPED = 2000;

/** The class of `<sap-demo>`: api.ts says what others may count on. */
export class SapDemoElement extends LitElement {
  static override styles: CSSResult = styles;
  static override shadowRootOptions: ShadowRootInit = { ...LitElement.shadowRootOptions, delegatesFocus: true };

  static override get observedAttributes(): string[] {
    return [...super.observedAttributes, ...attributes];
  }

  #run: Run | undefined;
  /** What keeps it from beginning, to be said in its place. */
  #wrong = "";
  /** Whether its files did not load. */
  #hasFailed = false;
  #program: DemoProgram | undefined;
  #marked: DemoMark | undefined;
  /** The ball that the pointer is on. */
  #pointed: number | undefined;
  /** The moment that was last reported. */
  #reported = "";
  #isPlaying = false;
  #speed: number | undefined;
  #hasChanged = false;
  #explanation: Explanation | undefined;
  #guesses = new Guesses();
  #swapLog = new SwapLog();
  #theme: Theme | undefined;
  readonly #probe: ThemeProbe;
  readonly #canvases = new Canvases(() => this.#paint());
  #countersAt = -Infinity;
  #saidAt = -Infinity;
  #shared: { url: string; code: string } | undefined;
  /** What it stands in with others that show the same world. */
  #comparison: SapComparisonElement | undefined;
  #leave: () => void = () => undefined;
  readonly #speech = new Speech(() => this.renderRoot.querySelector(".live"), () => this.#sentence);
  readonly #hands: Hands = new Hands(this, {
    run: () => this.#run,
    guess: (choice) => this.#guess(choice),
    took: () => this.#swapLog.restart(),
    moved: (drag, isDetected) => {
      if (isDetected) {
        this.#logSwaps();
        emit(this, "simulate", this.state);
      }
      emit(this, "sap-drag", drag);
      this.#changed();
      this.#comparison?.moved();
    },
    chose: () => this.#changed(),
    pointed: (ball) => {
      if (ball === this.#pointed) return;
      this.#pointed = ball;
      this.#paint();
      emit(this, "sap-point", ball);
    },
    place: (...where) => (this.#comparison?.together ?? this.#run!.timeline).placeBall(...where),
    detectAgain: () => (this.#comparison?.together ?? this.#run!.timeline).detectAgain(),
    say: (text) => this.#speech.now(text),
    saySoon: (first) => this.#speech.soon(first),
  });
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
    if (this.#comparison) return this.#comparison.play();
    const run = this.#run;
    if (!run || this.#isPlaying) return;
    if (run.options.isStatic && run.timeline.isDetected) run.timeline.rewind();
    this.#isPlaying = true;
    run.playback.restart();
    this.#changed();
  }

  pause(): void {
    if (this.#comparison) return this.#together((all) => all.pause());
    if (!this.#isPlaying) return;
    this.#isPlaying = false;
    this.#changed();
    this.#speech.soon();
  }

  step(): void {
    if (this.#comparison) return this.#together((all) => all.step());
    const run = this.#run;
    if (!run) return;
    const { timeline, options } = run;
    this.#isPlaying = false;
    if (timeline.isWaiting) return;
    const isNew = timeline.isDetected;
    if (isNew && options.isStatic) timeline.rewind();
    else if (isNew) run.nextDetection(this.#listener);
    if (timeline.isOver) return;
    this.#guesses.outcome = "";
    // The first event of a detection is to be guessed too.
    if (isNew && options.predicts) this.#skipToQuestion();
    else if (!timeline.isDetected) this.#report(timeline.nextStop());
    this.#changed();
    this.#speech.soon();
  }

  back(): void {
    if (this.#comparison) return this.#together((all) => all.back());
    if (!this.#run) return;
    this.#isPlaying = false;
    this.#run.timeline.back();
    this.#arrived(this.#run);
  }

  seek(k: number): void {
    if (this.#comparison) return this.#together((all) => all.seek(k));
    if (!this.#run || Number.isNaN(k)) return;
    this.#isPlaying = false;
    this.#run.timeline.seek(k);
    this.#arrived(this.#run);
  }

  reset(): void {
    if (this.#comparison) return this.#together((all) => all.reset());
    if (!this.#run && this.#wrong === "") return;
    this.#begin(!this.#isPlaying);
    this.#speech.soon();
  }

  share(): string {
    const tick = this.#run?.timeline.tick ?? 0;
    // What a world that starts over would not become, or not soon, is shared as it is now.
    const asIs = this.#run !== undefined && (this.#run.timeline.hasMoved || tick > MOST_TICKS);
    const start = asIs ? 0 : tick;
    const balls = asIs ? JSON.stringify(this.#run!.rows()) : this.getAttribute("balls");
    const page = new URL(this.getAttribute("embed-url") ?? "embed.html", document.baseURI);
    const options = this.#run?.options;
    const seed = options && hasSeed(options) ? options.world.seed : undefined;
    return shareUrl(page, (name) => this.getAttribute(name), { balls, start, seed, ...this.#still });
  }

  /** Whether it is paused, and at which stop. */
  get #still(): { isPaused: boolean; stop: number | undefined } {
    const { timeline, options } = this.#run ?? {};
    if (!timeline || this.#isPlaying || options!.predicts) return { isPaused: false, stop: undefined };
    // A detection that is over has no stop to come back to, and a world that does not move begins with it over.
    const isAtStop = timeline.hasDetection && !(options!.isStatic && timeline.isDetected);
    return { isPaused: !options!.isStatic, stop: isAtStop ? timeline.stop : undefined };
  }

  embedCode(): string {
    const picture = this.renderRoot.querySelector(".picture")?.clientHeight ?? HEIGHT;
    // Alone it has controls of its own.
    const controls = this.#comparison ? CONTROLS_HEIGHT : 0;
    // As high as where it is widest: a narrower one is lower.
    const height = this.#run?.options.world.height ?? HEIGHT;
    return iframeOf(this.share(), this.#label, this.getBoundingClientRect().height - picture + height + controls, WIDTH);
  }

  get isPlaying(): boolean {
    return this.#isPlaying;
  }

  get state(): DemoState {
    return this.#run?.state ?? { tick: 0, events: 0, ...NOTHING_COUNTED, hash: "" };
  }

  get event(): DemoEvent | undefined {
    return this.#run?.event;
  }

  get balls(): Row[] {
    return this.#run?.balls ?? [];
  }

  set balls(value: number | readonly Row[]) {
    this.setAttribute("balls", typeof value === "number" ? String(value) : JSON.stringify(value));
  }

  get pairs(): [number, number][] {
    return this.#run?.pairs ?? [];
  }

  get program(): DemoProgram | undefined {
    return this.#program;
  }

  set program(program: DemoProgram | undefined) {
    if (this.#program === program) return;
    this.#program = program;
    if (this.#run || this.#wrong !== "") this.#understand();
  }

  get settled(): Promise<void> {
    return this.#run?.timeline.settled ?? Promise.resolve();
  }

  get names(): readonly string[] {
    return this.#run?.names ?? [];
  }

  get marked(): DemoMark | undefined {
    return this.#marked;
  }

  set marked(mark: DemoMark | undefined) {
    this.#marked = mark;
    this.#paint();
  }

  get chosen(): number[] {
    return [...this.#hands.selection.chosen];
  }

  // Its life

  override connectedCallback(): void {
    super.connectedCallback();
    this.#comparison = comparisonOf(this);
    if (this.#comparison) this.#leave = this.#comparison.join(this, this.#member);
    else clock.add(this, { frame: (ms) => this.#frame(ms) });
    // One that was moved within the page goes on.
    if (!this.#comparison && this.#isPlaying) clock.wake(this);
    motionQuery.addEventListener("change", this.#onMotionChange);
    this.#load();
  }

  #load(): void {
    loadDemos().then(() => turnOf(this.#comparison ?? this)).then(
      () => this.isConnected && !this.#run && this.#begin(),
      (error: unknown) => {
        // For the makers of the page. Readers are told what they can do.
        console.error(error);
        this.#hasFailed = true;
        this.#refuse(typeof WebAssembly === "undefined" ? "This demo needs WebAssembly." : "This demo did not load. Is there a connection?");
      },
    );
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    clock.remove(this);
    this.#leave();
    this.#leave = () => undefined;
    this.#canvases.close();
    motionQuery.removeEventListener("change", this.#onMotionChange);
    this.#speech.stop();
    // One that is only moved within the page goes on where it was.
    setTimeout(() => {
      if (this.isConnected) return;
      this.#run?.free();
      this.#run = undefined;
    });
  }

  override attributeChangedCallback(name: string, old: string | null, value: string | null): void {
    super.attributeChangedCallback(name, old, value);
    if (old === value || !(attributes as readonly string[]).includes(name)) return;
    if (!this.#run && this.#wrong === "") return this.requestUpdate();
    if (name === "paused") return isOn(value) ? this.pause() : this.play();
    // Several that change at once are read at once.
    if (!this.#hasChanged) queueMicrotask(() => this.#hasChanged && this.#understand());
    this.#hasChanged = true;
  }

  /** Lets all demos of the comparison do something; this one, which was asked, says what it shows. */
  #together(act: (comparison: SapComparisonElement) => void): void {
    act(this.#comparison!);
    this.#speech.soon();
  }

  /** Reads the attributes again, and keeps the world if they do not change it. */
  #understand(): void {
    this.#hasChanged = false;
    const options = this.#readOptions();
    if (!options) return;
    const before = this.#run;
    const same = before?.shownUnder(options);
    if (same) {
      this.#open(same);
      return this.#changed();
    }
    // The ticks that demos keep are the same ones only if all begin together.
    if (this.#comparison) return this.#comparison.reset();
    let run: Run | undefined;
    try {
      run = before?.goOn(options);
    } catch (error) {
      // Out of memory, at most.
      return this.#refuse(messageOf(error));
    }
    if (!run) return this.#begin();
    this.#open(run);
    if (options.predicts && !before?.options.predicts) this.#isPlaying = false;
    if (options.predicts) this.#skipToQuestion();
    else if (!this.#isPlaying) run.timeline.finish();
    this.#changed();
  }

  #begin(isPaused = false): void {
    this.#hasChanged = false;
    const options = this.#readOptions();
    if (!options) return;
    let run: Run;
    let stop: number | undefined;
    try {
      stop = readStop(this.getAttribute("stop"));
      run = Run.begin(options, readStart(this.getAttribute("start")));
    } catch (error) {
      return this.#refuse(messageOf(error));
    }
    this.#run?.free();
    this.#open(run);
    this.#hands.selection.clear();
    this.#guesses = new Guesses();
    this.#swapLog = new SwapLog();
    const isStill = isPaused || isOn(this.getAttribute("paused")) || options.isStatic || options.predicts || motionQuery.matches;
    if (options.isStatic && (!options.predicts || asksOfScan(options))) run.timeline.finish();
    if (stop !== undefined) run.timeline.showStop(stop);
    this.#isPlaying = !isStill;
    this.#skipToQuestion();
    this.#comparison?.begun();
    this.#changed();
    emit(this, "simulate", this.state);
    void this.updateComplete.then(this.#setReady);
  }

  #open(run: Run): void {
    this.#wrong = "";
    this.#hasFailed = false;
    this.#run = run;
    run.timeline.waiter = {
      answered: (events) => {
        this.#report(events);
        this.#changed();
      },
      failed: (error) => this.#refuse(messageOf(error)),
    };
    this.#speed = undefined;
  }

  #readOptions(refuse = (message: string): void => this.#refuse(message)): Options | undefined {
    try {
      return readOptions((name) => this.getAttribute(name), this.#program);
    } catch (error) {
      refuse(messageOf(error));
      return undefined;
    }
  }

  /** Shows the error in the picture, because no reader of a page sees an exception. */
  #refuse(message: string): void {
    this.#run?.free();
    this.#run = undefined;
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
    const run = this.#run;
    if (!run) return false;
    try {
      if (this.#isPlaying) {
        const goesOn = run.playback.advance(ms * (this.#speed ?? run.options.speed), this.#listener);
        // A listener may have paused it.
        this.#isPlaying &&= goesOn;
      }
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
    isPlaying: (): boolean => this.#isPlaying,
    isHeld: (): boolean => this.#hands.isHolding,
    stopped: (events: readonly TraceEvent[]): void => this.#report(events),
    ticking: (): void => this.#hands.hold(),
    ticked: (): void => emit(this, "simulate", this.state),
  };

  /** Requests a new drawing. */
  #changed(): void {
    if (this.#isPlaying && !this.#comparison) clock.wake(this);
    this.#update(performance.now());
  }

  #update(now: number): void {
    this.#countersAt = now;
    const { pair } = this.#hands.selection;
    this.#explanation = pair && this.#run?.explain(pair);
    this.requestUpdate();
  }

  /** What a comparison does with it. */
  get #member(): Member {
    const demo = this;
    return {
      get run() {
        return demo.#run;
      },
      get isPlaying() {
        return demo.#isPlaying;
      },
      get isHeld() {
        return demo.#hands.isHolding;
      },
      advance: (ms) => void this.#run?.playback.advance(ms, this.#listener, false),
      hold: () => this.#hands.hold(),
      tick: () => this.#run?.playback.tickFreely(this.#listener),
      stopped: (events) => this.#report(events),
      setPlaying: (isPlaying) => {
        this.#isPlaying = isPlaying;
        if (isPlaying) this.#run?.playback.restart();
        this.#update(performance.now());
      },
      begin: (isPlaying) => this.#begin(!isPlaying),
      show: () => {
        this.#paint();
        const now = performance.now();
        if (!this.#isPlaying || now - this.#countersAt >= COUNTERS_MS) this.#update(now);
      },
    };
  }

  // Telling

  #report(events: readonly TraceEvent[]): void {
    const first = this.#run!.timeline.position - events.length;
    events.forEach((event, index) => report(this, event, first + index));
  }

  /** Counts, lists and flashes what was swapped while a ball was moved. */
  #logSwaps(): void {
    const run = this.#run!;
    if (!run.options.hasSwapLog) return;
    const hasSwapped = this.#swapLog.add(run.timeline.detection, run.names, run.options.focus, performance.now());
    if (hasSwapped) setTimeout(() => this.#paint(), FLASH_MS + 20);
  }

  /** After a jump: what is at work here, and in words. */
  #arrived({ timeline }: Run): void {
    const { event, position } = timeline;
    if (event) report(this, event, position - 1);
    this.#guesses.outcome = "";
    this.#changed();
    this.#speech.soon();
  }

  get #sentence(): string {
    return this.#explanation?.text ?? this.#run?.sentence ?? "";
  }

  // Guessing

  get #question(): Question | undefined {
    return this.#isPlaying ? undefined : this.#run?.question;
  }

  get #asked(): TraceEvent | undefined {
    return this.#isPlaying ? undefined : this.#run?.asked;
  }

  #guess(choice: number): void {
    const question = this.#question;
    if (!question || choice >= question.choices.length) return;
    this.#report(this.#run!.answer());
    this.#skipToQuestion(true);
    this.#guesses.count(question, choice);
    this.#changed();
    this.#speech.soon();
  }

  /**
   * Goes on to where there is something to guess: the rest is not worth a press of a button. After a guess it stays
   * in this detection, so that its end can be seen.
   */
  #skipToQuestion(hasGuessed = false): void {
    const run = this.#run;
    if (!run?.options.predicts) return;
    const { timeline } = run;
    for (let steps = 0; steps < MOST_SKIPPED && !timeline.isOver && !this.#question; steps++) {
      if (!timeline.isDetected) this.#report(timeline.nextStop());
      else if (hasGuessed || run.options.isStatic) return;
      else run.nextDetection(this.#listener);
    }
  }

  // Showing

  get #label(): string {
    return this.getAttribute("aria-label") ?? (this.#run?.options.heading || "Balls, and an algorithm that finds which of them overlap");
  }

  #paint(): void {
    const run = this.#run;
    if (!run || !this.hasUpdated) return;
    this.#say(run);
    this.#theme ??= this.#probe.read();
    paint(this.renderRoot, this.#canvases, {
      timeline: run.timeline,
      options: run.options,
      names: run.names,
      marked: [...this.#hands.selection.marked, ...[this.#pointed, this.#marked?.ball].filter((ball) => ball !== undefined)],
      asked: this.#asked,
      emphasis: this.#marked?.color,
      explanation: this.#explanation,
      lineAt: run.playback.lineAt(this.#isPlaying),
      theme: this.#theme,
      isScanHidden: run.isScanHidden,
      flashing: this.#swapLog.flashing(performance.now()),
    });
    const { tick, position } = run.timeline;
    const shown = `${tick} ${position}`;
    if (shown !== this.#reported) emit(this, "sap-show", run.event);
    this.#reported = shown;
  }

  /** Says in words what the picture shows, with each picture of an event. Ticks pass too fast to be read. */
  #say(run: Run): void {
    const said = this.renderRoot.querySelector(".said");
    const now = performance.now();
    if (!said || (this.#isPlaying && !run.timeline.event && now - this.#saidAt < COUNTERS_MS)) return;
    this.#saidAt = now;
    // What was there before the question is not what it is about.
    const sentence = this.#asked ? "" : this.#sentence;
    if (said.textContent !== sentence) said.textContent = sentence;
  }

  override firstUpdated(): void {
    this.renderRoot.append(this.#probe.element);
    this.#hands.reachInto(this.renderRoot.querySelector(".picture")!);
  }

  override updated(): void {
    this.#paint();
  }

  override render(): TemplateResult {
    const run = this.#run;
    const options = run?.options ?? this.#readOptions(() => undefined);
    return inside(
      {
        run,
        options,
        wrong: this.#wrong,
        hasFailed: this.#hasFailed,
        label: this.#label,
        hasControls: !this.#comparison && options?.hasControls !== false,
        hasCounters: options?.hasCounters !== false,
        explains: this.#explanation !== undefined,
        speed: this.#speed ?? options?.speed ?? 1,
        guesses: this.#guesses,
        swapLog: this.#swapLog,
        question: this.#question,
        shared: this.#shared,
      },
      this,
      this.#acts,
    );
  }

  readonly #acts: Acts = {
    point: (ball) => this.#hands.point(ball),
    press: (event) => this.#run && press(event, this.#run.options, this.#hands.keyboard),
    guess: (choice) => this.#guess(choice),
    load: () => this.#load(),
    setSpeed: (speed) => {
      this.#speed = speed;
      this.#changed();
    },
    newWorld: () => {
      const isPaused = !this.#isPlaying;
      this.setAttribute("seed", newSeed());
      // The attribute is read in a microtask.
      if (isPaused) queueMicrotask(() => this.pause());
    },
    openSharing: () => {
      // As it is now: what is shown to be copied does not change meanwhile.
      this.#shared = { url: this.share(), code: this.embedCode() };
      this.requestUpdate();
      void this.updateComplete.then(() => this.renderRoot.querySelector<HTMLElement>(".share")?.togglePopover());
    },
  };
}

addProperties(SapDemoElement.prototype);
