import { Runner } from "sweep-and-prune-classroom";
import { startAlgorithms } from "../classroom/start.ts";
import { showLoadFailure } from "../load-failed.ts";
import { bruteForceTests, formatCount } from "../panel/counters.ts";
import { PanelElement } from "../panel/panel-element.ts";
import { onThemeChange } from "../shell/theme.ts";
import { drawBoxes, type HeroColors } from "./draw-boxes.ts";
import { MovingBoxes, WORLD_HEIGHT } from "./moving-boxes.ts";

/** The numbers of boxes that the slider offers. */
const COUNTS = [50, 100, 200, 400, 700, 1_000, 2_000, 5_000, 10_000];
/** A frame that comes later than this counts as no longer: a tab that was hidden does not rush. */
const LONGEST_FRAME_MS = 50;
/** Numbers that change more often than this cannot be read. */
const COUNTER_MS = 150;
/** Until a visitor takes it, the line crosses the world in this many seconds. */
const CROSSING_S = 12;
/** A pointer takes a box from this many CSS pixels away, and the line from twice as far. */
const REACH = 6;
/** Of more boxes, a frame of every pair takes a slow phone a tenth of a second. */
const MOST_OF_EVERY_PAIR = 1_000;
/** How many boxes are tested to learn how long one test takes. */
const SAMPLE = 300;
/** A thrown box keeps its mean speed over this many milliseconds. */
const THROW_MS = 80;

type Method = "global pairwise" | "sorted pairwise";

/** What the last detection did. */
interface Work {
  readonly tests: number;
  readonly comparisons: number;
  readonly pairs: number;
  readonly ms: number;
}

/**
 * `<hero-boxes>`: moving boxes, the pairs of them that the compiled library finds in each frame, and
 * how many tests that took. Its inside stands in index.html.
 */
export class HeroBoxes extends PanelElement {
  readonly #runners = new Map<Method, Runner>();
  /** The milliseconds of one test of every pair. */
  #testMs: number | undefined;
  #boxes!: MovingBoxes;
  #seed = 1;
  #pairs: Uint32Array = new Uint32Array();
  #work: Work = { tests: 0, comparisons: 0, pairs: 0, ms: 0 };
  /** Where the line stands, from 0 to 1. */
  #line = 0.12;
  #isLineTaken = false;
  #last: number | undefined;
  #request: number | undefined;
  #countersAt = -Infinity;
  #colors: HeroColors | undefined;
  #size = { width: 0, height: 0 };

  protected start(): void {
    void startAlgorithms()
      .then(() => this.#start(), (error: unknown) => showLoadFailure(this.named("message"), error))
      .finally(() => this.dispatchEvent(new Event("settled")));
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    if (this.#request !== undefined) cancelAnimationFrame(this.#request);
    for (const runner of this.#runners.values()) runner.free();
    this.#runners.clear();
  }

  #start(): void {
    const { signal } = this;
    if (signal.aborted) return;
    this.#fit();
    this.onResize(["canvas"], () => this.#fit());
    onThemeChange(() => {
      this.#colors = undefined;
      this.#draw();
    }, signal);
    matchMedia("(forced-colors: active)").addEventListener("change", () => (this.#colors = undefined), { signal });
    this.followAwake();
    this.#bindControls();
    this.#bindPointer();
    for (const control of this.querySelectorAll<HTMLInputElement>(":disabled")) control.disabled = false;
    this.#detect();
    this.show();
    this.dataset["ready"] = "";
  }

  /** The boxes as they are: rows of min corner and max corner. */
  get rows(): Float64Array {
    return this.#boxes.rows.slice();
  }

  get #method(): Method {
    return this.querySelector<HTMLInputElement>("[name=hero-method]:checked")?.value as Method;
  }

  get #count(): number {
    return COUNTS[this.named<HTMLInputElement>("boxes").valueAsNumber] ?? 400;
  }

  /** Whether every pair would take longer than a frame may: then the picture stands still, with the pairs that the sweep finds. */
  get #isTooMuch(): boolean {
    return this.#method === "global pairwise" && this.#count > MOST_OF_EVERY_PAIR;
  }

  get #canvas(): HTMLCanvasElement {
    return this.named("canvas");
  }

  // Controls

  #bindControls(): void {
    const slider = this.named<HTMLInputElement>("boxes");
    slider.max = String(COUNTS.length - 1);
    slider.addEventListener("input", () => this.#begin());
    for (const choice of this.querySelectorAll("[name=hero-method]")) {
      choice.addEventListener("change", () => {
        // Nothing has moved: of too many boxes, the pairs are those that the sweep has found.
        if (this.#isTooMuch) this.#estimate();
        else this.#detect();
        this.#draw();
        this.show();
        this.pace();
      });
    }
    this.onClick("play", () => {
      this.setWanted(!this.wanted);
      this.#changed();
    });
    this.onClick("new-world", () => {
      this.#seed = 1 + Math.floor(Math.random() * 999_999);
      this.#begin();
    });
    const line = this.named<HTMLInputElement>("line");
    line.addEventListener("input", () => this.#takeLine(line.valueAsNumber / 1000));
  }

  #bindPointer(): void {
    const canvas = this.#canvas;
    let path: { x: number; y: number; at: number }[] = [];
    let holdsLine = false;
    const inWorld = ({ clientX, clientY }: PointerEvent): { x: number; y: number } => {
      const { left, top, height } = canvas.getBoundingClientRect();
      return { x: ((clientX - left) * WORLD_HEIGHT) / height, y: ((clientY - top) * WORLD_HEIGHT) / height };
    };
    const reach = (): number => (REACH * WORLD_HEIGHT) / Math.max(this.#size.height, 1);
    canvas.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      const { x, y } = inWorld(event);
      const isNearLine = Math.abs(x - this.#line * this.#boxes.width) <= 2 * reach();
      const box = isNearLine ? undefined : this.#boxes.boxAt(x, y, reach());
      canvas.setPointerCapture(event.pointerId);
      path = [{ x, y, at: event.timeStamp }];
      if (box === undefined) {
        holdsLine = true;
        this.#takeLine(x / this.#boxes.width);
      } else this.#boxes.held = box;
    });
    canvas.addEventListener("pointermove", (event) => {
      const { x, y } = inWorld(event);
      if (holdsLine) return this.#takeLine(x / this.#boxes.width);
      if (this.#boxes.held === undefined) return;
      path.push({ x, y, at: event.timeStamp });
      this.#boxes.moveTo(this.#boxes.held, x, y);
      if (!this.wanted) this.#changed();
    });
    const letGo = (event: PointerEvent): void => {
      holdsLine = false;
      const last = path.at(-1);
      const from = path.find(({ at }) => event.timeStamp - at <= THROW_MS) ?? last;
      if (!last || !from) return;
      const seconds = Math.max(event.timeStamp - from.at, 16) / 1000;
      this.#boxes.throw((last.x - from.x) / seconds, (last.y - from.y) / seconds);
      path = [];
    };
    canvas.addEventListener("pointerup", letGo);
    canvas.addEventListener("pointercancel", letGo);
  }

  #takeLine(at: number): void {
    this.#isLineTaken = true;
    this.#line = Math.min(Math.max(at, 0), 1);
    this.#draw();
    this.show();
  }

  /** Other boxes: as many as the slider says, from the seed. */
  #begin(): void {
    this.#boxes = new MovingBoxes(this.#count, this.#seed, this.#width);
    for (const runner of this.#runners.values()) runner.free();
    this.#runners.clear();
    this.#changed();
    this.pace();
  }

  /** The width of the world: as high as ever, and as wide as the picture. */
  get #width(): number {
    return (WORLD_HEIGHT * this.#size.width) / Math.max(this.#size.height, 1);
  }

  #fit(): void {
    const { clientWidth: width, clientHeight: height } = this.#canvas;
    if (width === 0 || (width === this.#size.width && height === this.#size.height)) return;
    this.#size = { width, height };
    if (!this.#boxes) return this.#begin();
    this.#boxes.resize(this.#width);
    this.#changed();
  }

  // Time

  protected pace(): void {
    const isRunning = this.wanted && this.awake && !this.#isTooMuch;
    if (isRunning && this.#request === undefined) this.#request = requestAnimationFrame(this.#frame);
    if (!isRunning && this.#request !== undefined) {
      cancelAnimationFrame(this.#request);
      this.#request = undefined;
      this.#last = undefined;
    }
  }

  readonly #frame = (now: number): void => {
    const seconds = Math.min(now - (this.#last ?? now), LONGEST_FRAME_MS) / 1000;
    this.#last = now;
    this.#request = requestAnimationFrame(this.#frame);
    this.#boxes.advance(seconds);
    if (!this.#isLineTaken) this.#line = (this.#line + seconds / CROSSING_S) % 1;
    this.#detect();
    this.#draw();
    if (now - this.#countersAt >= COUNTER_MS) this.show();
  };

  #changed(): void {
    this.#detect();
    this.#draw();
    this.show();
  }

  /** Lets the chosen algorithm of the library find the pairs. */
  #detect(): void {
    const isTooMuch = this.#isTooMuch;
    const method = isTooMuch ? "sorted pairwise" : this.#method;
    let runner = this.#runners.get(method);
    if (!runner) this.#runners.set(method, (runner = new Runner({ dimensions: 2, method, axis: 0, persistent: true })));
    const began = performance.now();
    const { pairs, counts } = runner.step(this.#boxes.rows);
    const ms = performance.now() - began;
    this.#pairs = pairs;
    this.#work = { tests: counts.tests, comparisons: counts.comparisons, pairs: counts.pairs, ms };
    if (isTooMuch) this.#estimate();
  }

  /** What a frame of every pair would cost. */
  #estimate(): void {
    const tests = bruteForceTests(this.#boxes.count);
    this.#testMs ??= measureTest(this.#boxes.rows);
    this.#work = { tests, comparisons: 0, pairs: this.#work.pairs, ms: tests * this.#testMs };
  }

  // Showing

  #draw(): void {
    this.#colors ??= this.#readColors();
    const boxes = this.#boxes;
    const line = this.#line * boxes.width;
    const touched = boxes.touchedBy(line);
    const partners = this.#partnersOf(touched.at(-1));
    drawBoxes(this.#canvas, this.#size.width, this.#size.height, { boxes, pairs: this.#pairs, line, touched, partners }, this.#colors);
  }

  /** What a box is tested against: every other box, or those that the line still touches when it enters this one. */
  #partnersOf(box: number | undefined): number[] {
    if (box === undefined) return [];
    const boxes = this.#boxes;
    const all = this.#method === "global pairwise" ? [...Array(boxes.count).keys()] : boxes.touchedBy(boxes.rows[4 * box]!);
    return all.filter((other) => other !== box);
  }

  /** Each in the color of the word that names it. */
  #readColors(): HeroColors {
    const word = (name: string): string => getComputedStyle(this.querySelector(`.is-${name}`) as HTMLElement).color;
    const stage = getComputedStyle(this.#canvas);
    return { overlap: word("overlap"), test: word("test"), line: word("sweep"), outline: stage.borderTopColor, stage: stage.backgroundColor };
  }

  protected show(): void {
    this.#countersAt = performance.now();
    const { tests, comparisons, pairs, ms } = this.#work;
    const { count } = this.#boxes;
    const all = bruteForceTests(count);
    const isEvery = this.#method === "global pairwise";
    const touched = this.#boxes.touchedBy(this.#line * this.#boxes.width);
    const partners = this.#partnersOf(touched.at(-1)).length;
    this.write("boxes-value", formatCount(count));
    this.write("count", formatCount(tests));
    this.write("sort", isEvery ? "no sort" : `and ${formatCount(comparisons)} comparisons to sort`);
    this.write("ms", this.#isTooMuch ? `about ${Math.max(1, Math.round(ms)).toLocaleString("en")} ms a frame here, so the picture stands still` : `${ms.toFixed(ms < 10 ? 1 : 0)} ms`);
    this.write("pairs", formatCount(pairs));
    this.write("at-line", isEvery ? `tested against all ${formatCount(partners)} others` : `tested against ${formatCount(partners)} others that the line still touches`);
    this.write("fewer", isEvery ? `${formatCount(count)} boxes make ${formatCount(all)} pairs` : `${formatCount(Math.floor(all / Math.max(tests, 1)))} times fewer than the ${formatCount(all)} pairs`);
    this.named("bar").style.inlineSize = `${Math.max((100 * tests) / all, 0.3)}%`;
    this.showTransport();
    const line = this.named<HTMLInputElement>("line");
    line.valueAsNumber = Math.round(1000 * this.#line);
    line.setAttribute("aria-valuetext", `${Math.round(100 * this.#line)} %, touching ${touched.length} of ${count} boxes`);
    this.named("boxes").setAttribute("aria-valuetext", formatCount(count));
    this.dataset["tests"] = String(tests);
    this.dataset["pairs"] = String(pairs);
  }
}

/** How long one test of every pair takes here, from the pairs of some of the boxes. */
function measureTest(rows: Float64Array): number {
  const runner = new Runner({ dimensions: 2, method: "global pairwise" });
  const sample = rows.slice(0, 4 * SAMPLE);
  runner.step(sample);
  const began = performance.now();
  runner.step(sample);
  const ms = Math.max(performance.now() - began, 0.1);
  runner.free();
  return ms / bruteForceTests(SAMPLE);
}
