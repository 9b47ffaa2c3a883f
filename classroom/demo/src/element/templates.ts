import { html, nothing, svg, type TemplateResult } from "lit";
import type { Guesses, Question } from "./predict.js";
import type { SwapLog } from "./swap-log.js";
import type { Progress } from "./timeline.js";

/** What the controls under the picture show and do. */
export interface Controls {
  readonly isReady: boolean;
  readonly isPlaying: boolean;
  /** Whether there is anything to play; if not, nothing that moves through time is shown. */
  readonly canPlay: boolean;
  readonly canGoBack: boolean;
  readonly progress: Progress;
  readonly speed: number;
  playOrPause(): void;
  back(): void;
  step(): void;
  seek(place: number): void;
  setSpeed(speed: number): void;
  reset(): void;
  /** Begins another world; undefined where there is only one. */
  readonly newWorld: (() => void) | undefined;
  share(): void;
}

const speeds = [0.1, 0.25, 0.5, 1, 2, 4];

export function controls(demo: Controls): TemplateResult {
  const { isReady, isPlaying, progress } = demo;
  const of = Math.max(progress.of, 1);
  return html`<div class="controls" part="controls" role="group" aria-label="Controls">
    ${demo.canPlay
      ? html`${button(isPlaying ? "Pause" : "Play", isPlaying ? icons.pause : icons.play, isReady, () => demo.playOrPause())}
          ${button("Step back", icons.back, isReady && demo.canGoBack, () => demo.back())}
          ${button("Step", icons.step, isReady, () => demo.step())}
          <input
            type="range"
            aria-label="Moment"
            aria-valuetext="${progress.at} of ${progress.of}"
            min="0"
            .max=${String(of)}
            .value=${String(progress.at)}
            ?disabled=${!isReady}
            @input=${(event: Event) => demo.seek(Number((event.target as HTMLInputElement).value))}
          />
          <select aria-label="Speed" ?disabled=${!isReady} @change=${(event: Event) => demo.setSpeed(Number((event.target as HTMLSelectElement).value))}>
            ${[...new Set([...speeds, demo.speed])].sort((a, b) => a - b).map((speed) => html`<option value=${speed} ?selected=${speed === demo.speed}>${speed}×</option>`)}
          </select>`
      : html`<span class="filler"></span>`}
    ${button("Reset", icons.reset, isReady, () => demo.reset())}
    ${demo.newWorld ? button("New world", icons.dice, isReady, demo.newWorld) : nothing}
    ${button("Share or embed", icons.share, isReady, () => demo.share(), "secondary")}
  </div>`;
}

function button(label: string, icon: TemplateResult, enabled: boolean, click: () => void, kind = ""): TemplateResult {
  return html`<button type="button" class=${kind} aria-label=${label} title=${label} ?disabled=${!enabled} @click=${click}>${icon}</button>`;
}

/** The guess that is asked for, and how the guesses so far turned out. */
export interface Guessing {
  readonly question: Question | undefined;
  readonly guesses: Guesses;
  guess(choice: number): void;
  /** Goes on where nothing is left to guess; undefined where that is all. */
  readonly next: (() => void) | undefined;
}

export function guessing({ question, guesses, guess, next }: Guessing): TemplateResult {
  const { outcome, right, made } = guesses;
  return html`<div class="guess" part="guess" role="group" aria-label="What happens next?">
    <p>${outcome} ${question?.text ?? (next ? "That was all of this detection." : "That was all.")}</p>
    <div>
      ${question?.choices.map((text, index) => html`<button type="button" @click=${() => guess(index)}>${text}</button>`)}
      ${question || !next ? nothing : html`<button type="button" @click=${next}>Next detection</button>`}
      <span class="score">${made === 0 ? nothing : html`${right} of ${made} right`}</span>
    </div>
  </div>`;
}

/** What the swaps have shown since a ball was taken. */
export function swapsSoFar({ swaps, begun, ended, lines }: SwapLog): TemplateResult {
  const count = (number: number, what: string): string => `${number} ${what}${number === 1 ? "" : "s"}`;
  return html`<div class="swap-log" part="swap-log">
    <p>Since the drag began: ${count(swaps, "swap")}, ${count(begun, "overlap")} on one axis begun, ${ended} ended.</p>
    <ol>${lines.map((line) => html`<li>${line}</li>`)}</ol>
  </div>`;
}

/** The address and the iframe, to copy. Shown by its `showPopover()`. */
export function sharing(url: string, code: string): TemplateResult {
  const row = (label: string, text: string, lines: number): TemplateResult =>
    html`<label>${label}<textarea readonly rows=${lines} .value=${text} @focus=${select}></textarea></label>
      <button type="button" @click=${(event: Event) => copy(event.target as HTMLElement, text)}>Copy</button>`;
  return html`<div class="share" part="share" popover aria-label="Share or embed">
    ${row("Link to this demo", url, 2)} ${row("Code to embed it in a page", code, 5)}
  </div>`;
}

function select(event: Event): void {
  (event.target as HTMLTextAreaElement).select();
}

function copy(button: HTMLElement, text: string): void {
  navigator.clipboard?.writeText(text).then(
    () => (button.textContent = "Copied"),
    () => (button.textContent = "Select and copy"),
  );
}

function icon(path: string): TemplateResult {
  return html`<svg viewBox="0 0 16 16" aria-hidden="true">${svg`<path d=${path} />`}</svg>`;
}

const icons = {
  play: icon("M3 1.500v13l11-6.500z"),
  pause: icon("M3 2h3.500v12H3zM9.500 2H13v12H9.500z"),
  step: icon("M2 1.500v13l9-6.500zM11.500 2H14v12h-2.500z"),
  back: icon("M14 1.500v13L5 8zM2 2h2.500v12H2z"),
  reset: icon("M8 2a6 6 0 1 1-5.700 4.100l1.900.6A4 4 0 1 0 8 4v2.500L3.800 3 8-.5z"),
  dice: icon("M3.500 1h9A2.500 2.500 0 0 1 15 3.500v9a2.500 2.500 0 0 1-2.500 2.500h-9A2.500 2.500 0 0 1 1 12.500v-9A2.500 2.500 0 0 1 3.500 1zm0 1.600a.9.9 0 0 0-.9.9v9c0 .5.4.9.9.9h9c.5 0 .9-.4.9-.9v-9a.9.9 0 0 0-.9-.9zM5.200 4a1.200 1.200 0 1 1 0 2.400 1.200 1.200 0 0 1 0-2.400zM8 6.800a1.200 1.200 0 1 1 0 2.400 1.200 1.200 0 0 1 0-2.400zm2.800 2.800a1.200 1.200 0 1 1 0 2.400 1.200 1.200 0 0 1 0-2.400z"),
  share: icon("M12.500 1a2.500 2.500 0 1 1-2 4L6 7.500v1L10.500 11a2.500 2.500 0 1 1-.8 1.800L5 10.200a2.500 2.500 0 1 1 0-4.400l4.700-2.600A2.500 2.500 0 0 1 12.500 1z"),
};
