import { html, nothing, type TemplateResult } from "lit";
import type { SapDemo } from "./types.js";
import { counters } from "./counters.js";
import { canPlay } from "./detection.js";
import { ballAt } from "./draw-array.js";
import { keysOf } from "./keys.js";
import { hasSeed, type Options } from "./options.js";
import { heightOfArray } from "./paint.js";
import type { Guesses, Question } from "./predict.js";
import { NOTHING_COUNTED, type Run } from "./run.js";
import type { SwapLog } from "./swap-log.js";
import { controls, guessing, sharing, swapsSoFar } from "./templates.js";

/** What a demo shows, beside the picture itself. */
export interface View {
  /** Until it has begun there is none. */
  readonly run: Run | undefined;
  /** What its attributes say, where they can be read: it is as high before it has begun as after. */
  readonly options: Options | undefined;
  /** What keeps it from beginning, in words. */
  readonly wrong: string;
  /** Whether that is that its files did not load. */
  readonly hasFailed: boolean;
  readonly label: string;
  readonly hasControls: boolean;
  readonly hasCounters: boolean;
  /** Whether the sentence explains a pair. */
  readonly explains: boolean;
  readonly speed: number;
  readonly guesses: Guesses;
  readonly question: Question | undefined;
  readonly swapLog: SwapLog;
  /** What there is to copy, once it was asked for. */
  readonly shared: { readonly url: string; readonly code: string } | undefined;
}

/** What is done where a visitor presses, beside what anybody may call. */
export interface Acts {
  press(event: KeyboardEvent): void;
  point(ball: number | undefined): void;
  guess(choice: number): void;
  /** Tries once more to load what it needs. */
  load(): void;
  setSpeed(speed: number): void;
  newWorld(): void;
  openSharing(): void;
}

/** The inside of the element. */
export function inside(view: View, demo: SapDemo, acts: Acts): TemplateResult {
  const { run, options, hasControls } = view;
  return html`
    <slot name="heading">${options?.heading ? html`<p class="heading" part="heading">${options.heading}</p>` : nothing}</slot>
    <div class="frame">
    <div class="picture" part="picture" role="application" tabindex="0" aria-label=${view.label} aria-describedby="keys" @keydown=${acts.press}>
      <canvas></canvas>
      ${view.wrong ? html`<div class="wrong"><p role="alert">${view.wrong}</p>${view.hasFailed ? html`<button type="button" @click=${acts.load}>Try again</button>` : nothing}</div>` : nothing}
    </div>
    <p id="keys" class="hidden">${keysOf(options, canPlay(options))}</p>
    ${options?.decorations.array ? array(options, run, acts) : nothing}
    ${hasControls ? html`<p class="said" part="said" aria-hidden="true" ?data-explains=${view.explains}></p>` : nothing}
    ${options?.predicts ? guessing({ ...view, guess: acts.guess, next: options.isStatic ? undefined : () => demo.step() }) : nothing}
    ${options?.hasSwapLog ? swapsSoFar(view.swapLog) : nothing}
    <p class="live hidden" role="status" aria-live="polite"></p>
    ${view.hasCounters ? counters(run?.counts ?? NOTHING_COUNTED, run?.options.detecting) : nothing}
    ${hasControls ? html`${bar(view, demo, acts)} ${view.shared ? sharing(view.shared.url, view.shared.code) : nothing}` : nothing}
    </div>
    <slot name="caption"></slot>
  `;
}

function bar({ run, options, speed }: View, demo: SapDemo, acts: Acts): TemplateResult {
  const timeline = run?.timeline;
  return controls({
    isReady: timeline !== undefined,
    isPlaying: demo.isPlaying,
    canPlay: canPlay(options),
    canGoBack: timeline?.hasPast === true,
    progress: timeline?.progress ?? { at: 0, of: 0 },
    speed,
    playOrPause: () => (demo.isPlaying ? demo.pause() : demo.play()),
    back: () => demo.back(),
    step: () => demo.step(),
    seek: (place) => demo.seek(place),
    setSpeed: acts.setSpeed,
    reset: () => demo.reset(),
    newWorld: options && hasSeed(options) ? acts.newWorld : undefined,
    share: acts.openSharing,
  });
}

function array(options: Options, run: Run | undefined, acts: Acts): TemplateResult {
  const { balls } = options.world;
  const height = heightOfArray(options, typeof balls === "number" ? balls : balls.length);
  const point = ({ offsetX, offsetY, target }: PointerEvent): void =>
    acts.point(run && ballAt(run.timeline.state.arrays, (target as HTMLElement).clientWidth, offsetX, offsetY));
  return html`<canvas class="array" part="array" role="img" aria-label="The array of endpoints, in order" style="height:${height}px" @pointermove=${point} @pointerleave=${() => acts.point(undefined)}></canvas>`;
}
