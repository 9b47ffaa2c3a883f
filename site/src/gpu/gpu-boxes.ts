import { GpuError, type GpuErrorCode, type Stage } from "sweep-and-prune-gpu";
import { median } from "../median.ts";
import { type Counter, counterRows, formatCount, showCounters } from "../panel/counters.ts";
import { PanelElement } from "../panel/panel-element.ts";
import { choice, transport } from "../panel/parts.ts";
import { onThemeChange } from "../shell/theme.ts";
import { colorOf } from "../view/theme.ts";
import { pixelRatio } from "../plot/line-plot.ts";
import "./gpu-boxes.css";
import { type Found, type Look, World } from "./world.ts";

const COUNTS = [100_000, 250_000, 500_000, 1_000_000];

/** A time is the median of this many. */
const KEPT = 15;

/** What a counter shows: the last search that was read, and the times of the last ones. */
interface Shown {
  readonly found: Found;
  readonly times: ReadonlyMap<Stage, readonly number[]>;
}

const STAGES: readonly (readonly [stage: Stage, label: string, meaning: string])[] = [
  ["read boxes", "Read boxes", "as whole numbers in the order of the coordinates"],
  ["order boxes", "Order boxes", "by size, shape and place"],
  ["build the tree", "Build the tree", "eight neighbors have one parent"],
  ["count the pairs", "Count the pairs", "for each box, those that follow it in the order"],
  ["sum the numbers up", "Sum the numbers up", "so that each pair has its place"],
  ["write the pairs", "Write the pairs", "each to its place"],
];

const COUNTERS: readonly Counter<Shown>[] = [
  { key: "boxes", label: "Boxes", meaning: "that move", read: ({ found }) => formatCount(found.boxes) },
  { key: "pairs", label: "Pairs", meaning: "pairs of boxes that overlap", read: ({ found }) => formatCount(found.pairs) },
  { key: "overlapping", label: "Boxes in a pair", meaning: "highlighted", read: ({ found }) => `${((100 * found.overlapping) / found.boxes).toFixed(1)} %` },
];
const TIMES: readonly Counter<Shown>[] = STAGES.map(([key, label, meaning]) => ({ key, label, meaning, read: ({ times }) => shown(times.get(key)) }));

const SENTENCES: Partial<Record<GpuErrorCode, string>> = {
  NO_WEBGPU: "This needs WebGPU, which this browser does not have, or has only on secure pages (https or localhost).",
  NO_ADAPTER: "This browser has WebGPU, but found no GPU that it may use.",
  NO_DEVICE: "The browser could not open the GPU.",
  DEVICE_LOST: "The GPU was lost. A driver that restarts or a search that takes too long may be the reason.",
  TOO_MANY_BOXES: "This GPU cannot hold this many boxes in one buffer. Choose fewer.",
  OUT_OF_MEMORY: "The memory of this GPU is not enough for this many boxes. Choose fewer.",
};

/** `<gpu-boxes count="100000">`: moving boxes on the GPU; those that overlap another are highlighted. */
export class GpuBoxes extends PanelElement {
  #world: World | undefined;
  /** The world that was asked for last. */
  #opening: Promise<World> | undefined;
  #times = new Map<Stage, number[]>();
  #steps = 0;
  /** Whether the next picture is a step later, also while it is paused; and whether there has to be one. */
  #isStep = false;
  #isDue = false;
  #isBusy = false;

  protected start(): void {
    const first = Number(this.getAttribute("count")) || COUNTS[0]!;
    const counts = [...new Set([first, ...COUNTS])].map((count) => [String(count), formatCount(count)] as const);
    this.innerHTML = `
      <div class="panel" role="group" aria-label="Boxes on the GPU">
        <div class="panel-stage">
          <canvas data-part="picture" role="img" aria-label="Moving boxes; those that overlap another are highlighted. In 3D, what is farther is dimmer."></canvas>
          <p class="stage-message quiet" role="status" data-part="message"></p>
        </div>
        ${transport(`<button type="button" data-part="check">Check against the processor</button>`)}
        <div class="panel-world">
          ${choice("gpu", "count", "Boxes", counts)}
          ${choice("gpu", "dimensions", "Dimensions", [["2", "2D"], ["3", "3D"]])}
        </div>
        <div class="gpu-numbers">
          <dl>${counterRows(COUNTERS)}</dl>
          <h3 data-part="times">Stages of a search, median of the last 15</h3>
          <dl>${counterRows(TIMES)}</dl>
        </div>
      </div>`;
    for (const control of this.querySelectorAll<HTMLButtonElement | HTMLSelectElement>("button, select")) control.disabled = false;
    for (const part of ["count", "dimensions"]) this.named(part).addEventListener("change", () => void this.#open());
    this.bindTransport(() => this.#due(true), () => void this.#open());
    this.onClick("check", () => void this.#check());
    this.onResize(["picture"], () => this.#due());
    onThemeChange(() => this.#due(), this.signal);
    this.signal.addEventListener("abort", () => this.#close());
    this.followAwake();
    void this.#open();
  }

  protected pace(): void {
    this.showTransport();
    this.#next();
  }

  protected show(): void {
    if (this.#world && !this.#isBusy) void this.#frame(this.#world);
  }

  /** Asks for a picture, a step later if `isStep`. */
  #due(isStep = false): void {
    this.#isDue = true;
    this.#isStep ||= isStep;
    this.#next();
  }

  #next(): void {
    if (this.#isDue || (this.wanted && this.awake)) this.requestShow();
  }

  /** Opens a world of what is chosen. */
  async #open(): Promise<void> {
    this.#close();
    this.write("message", "Opening the GPU");
    this.named("message").classList.remove("load-failure");
    this.write("status", "");
    const [count, dimensions] = ["count", "dimensions"].map((part) => Number(this.named<HTMLSelectElement>(part).value)) as [number, 2 | 3];
    const opening = (this.#opening = World.open(this.named<HTMLCanvasElement>("picture"), count, dimensions));
    try {
      const world = await opening;
      if (opening !== this.#opening) return world.destroy();
      this.#world = world;
      void world.failed.then((code) => this.#fail(code, world));
      this.write("message", "");
      this.#due();
    } catch (error) {
      if (opening === this.#opening) this.#fail(codeOf(error, "DEVICE"));
    }
  }

  #close(): void {
    this.#world?.destroy();
    this.#world = this.#opening = undefined;
    this.#times.clear();
    this.#steps = 0;
    showCounters(this, [...COUNTERS, ...TIMES], undefined);
    this.named("moment").textContent = "Step 0";
  }

  /** Says why there is no picture any more, unless it is about a world that is closed. */
  #fail(code: GpuErrorCode, world?: World): void {
    if (world !== this.#world) return;
    this.#close();
    this.write("message", SENTENCES[code] ?? "The GPU stopped with an error. It may manage fewer boxes.");
    this.named("message").classList.add("load-failure");
    if (code === "NO_WEBGPU") return;
    const retry = Object.assign(document.createElement("button"), { type: "button", textContent: "Try again" });
    retry.addEventListener("click", () => {
      this.named("play").focus();
      void this.#open();
    });
    this.named("message").append(" ", retry);
  }

  /** Draws the next picture. The one after it waits for this one, so that no work piles up on the device. */
  async #frame(world: World): Promise<void> {
    const isStep = this.#isStep || (this.wanted && this.awake);
    [this.#isBusy, this.#isDue, this.#isStep] = [true, false, false];
    try {
      const found = await world.frame(isStep, this.#look());
      if (world === this.#world) this.#report(found, isStep);
    } catch (error) {
      this.#fail(codeOf(error), world);
    } finally {
      this.#isBusy = false;
      this.#next();
    }
  }

  #report(found: Found, isStep: boolean): void {
    if (isStep) this.#steps++;
    this.named("moment").textContent = `Step ${formatCount(this.#steps)}`;
    for (const { stage, milliseconds } of found.times) this.#times.set(stage, [...(this.#times.get(stage) ?? []).slice(1 - KEPT), milliseconds]);
    showCounters(this, [...COUNTERS, ...TIMES], { found, times: this.#times });
    if (found.times.length === 0) this.named("times").textContent = "Your browser gives no times";
  }

  async #check(): Promise<void> {
    const world = this.#world;
    if (!world) return this.write("status", "There are no boxes yet.");
    this.write("status", "Checking ...");
    const worker = new Worker(new URL("./check.ts", import.meta.url), { type: "module" });
    try {
      const found = await world.copy();
      const answer = new Promise<string>((resolve, reject) => {
        worker.addEventListener("message", ({ data }: MessageEvent<string>) => resolve(data));
        worker.addEventListener("error", reject);
      });
      worker.postMessage(found);
      this.write("status", await answer);
    } catch {
      this.write("status", "The check did not finish. Try again.");
    } finally {
      worker.terminate();
    }
  }

  /** The colors of the page now, and the size of the picture. */
  #look(): Look {
    const canvas = this.named<HTMLCanvasElement>("picture");
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((size) => Math.max(1, Math.round(size * pixelRatio()))) as [number, number];
    const [box, highlighted, ground] = ["box", "sap-overlap", "stage"].map((name) => rgba(colorOf(name, this))) as [number[], number[], number[]];
    return { width, height, box, highlighted, ground };
  }
}

/** The median of times, if there are any. */
const shown = (times: readonly number[] = []): string | null => (times.length > 0 ? `${median(times).toFixed(1)} ms` : null);

/** The code of an error. The browser's own errors, of a copy that it could not read, are of a device that is lost. */
const codeOf = (error: unknown, other: GpuErrorCode = "DEVICE_LOST"): GpuErrorCode => (error instanceof GpuError ? error.code : other);

/** Red, green, blue and opacity of a color, from 0 to 1. */
function rgba(color: string): number[] {
  const context = new OffscreenCanvas(1, 1).getContext("2d")!;
  context.fillStyle = color;
  context.fillRect(0, 0, 1, 1);
  return Array.from(context.getImageData(0, 0, 1, 1).data, (value) => value / 255);
}
