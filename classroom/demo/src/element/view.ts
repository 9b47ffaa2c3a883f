import { html, nothing, type TemplateResult } from "lit";
import type { SapDemo } from "./types.js";
import { counters } from "./counters.js";
import { ballAt } from "./draw-array.js";
import { keysOf } from "./keys.js";
import { hasSeed } from "./options.js";
import { heightOfArray } from "./paint.js";
import type { Guesses, Question } from "./predict.js";
import { NOTHING_COUNTED, type Run } from "./run.js";
import type { SwapLog } from "./swap-log.js";
import { controls, guessing, sharing, swapsSoFar } from "./templates.js";

/** What a demo shows, beside the picture itself. */
export interface View {
  /** Until it has begun there is none. */
  readonly run: Run | undefined;
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
  const { run, hasControls } = view;
  const options = run?.options;
  return html`
    <slot name="heading">${options?.heading ? html`<p class="heading" part="heading">${options.heading}</p>` : nothing}</slot>
    <div class="frame">
    <div class="picture" part="picture" role="application" tabindex="0" aria-label=${view.label} aria-describedby="keys" @keydown=${acts.press}>
      <canvas></canvas>
      ${view.wrong ? html`<div class="wrong"><p role="alert">${view.wrong}</p>${view.hasFailed ? html`<button type="button" @click=${acts.load}>Try again</button>` : nothing}</div>` : nothing}
    </div>
    <p id="keys" class="hidden">${keysOf(options, canPlay(run, demo))}</p>
    ${run && options?.decorations.array ? array(run, acts) : nothing}
    ${hasControls ? html`<p class="said" part="said" aria-hidden="true" ?data-explains=${view.explains}></p>` : nothing}
    ${options?.predicts ? guessing({ ...view, guess: acts.guess, next: options.isStatic ? undefined : () => demo.step() }) : nothing}
    ${options?.hasSwapLog ? swapsSoFar(view.swapLog) : nothing}
    <p class="live hidden" role="status" aria-live="polite"></p>
    ${view.hasCounters ? counters(run?.counts ?? NOTHING_COUNTED, options?.detecting) : nothing}
    ${hasControls ? html`${bar(view, demo, acts)} ${view.shared ? sharing(view.shared.url, view.shared.code) : nothing}` : nothing}
    </div>
    <slot name="caption"></slot>
  `;
}

function bar({ run, speed }: View, demo: SapDemo, acts: Acts): TemplateResult {
  const { timeline, options } = run ?? {};
  return controls({
    isReady: timeline !== undefined,
    isPlaying: demo.isPlaying,
    canPlay: canPlay(run, demo),
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

/** Whether anything moves, or can be stepped through; before it has loaded, as it will be, so that its height stays. */
function canPlay(run: Run | undefined, demo: SapDemo): boolean {
  if (!run) return !demo.hasAttribute("static") || demo.hasAttribute("decorations");
  return !(run.options.isStatic && run.timeline.isStopless);
}

function array({ options, timeline }: Run, acts: Acts): TemplateResult {
  const height = heightOfArray(options, timeline.radii.length);
  const point = ({ offsetX, offsetY, target }: PointerEvent): void => acts.point(ballAt(timeline.state.arrays, (target as HTMLElement).clientWidth, offsetX, offsetY));
  return html`<canvas class="array" part="array" role="img" aria-label="The array of endpoints, in order" style="height:${height}px" @pointermove=${point} @pointerleave=${() => acts.point(undefined)}></canvas>`;
}
