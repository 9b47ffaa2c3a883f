import { css, type CSSResult, unsafeCSS } from "lit";
import { declarations } from "./theme.js";

export const styles: CSSResult = css`
  :host {
    ${unsafeCSS(declarations)}
    display: block;
    position: relative;
    max-width: var(--sap-width, 600px);
  }
  /* What changes several times a second has a fixed size, so that the browser lays out nothing else then. */
  .said,
  .counters,
  .swap-log,
  .controls input {
    contain: strict;
  }
  /* Not of the host: what a page puts into it looks as the page says. */
  [part],
  .heading {
    color: var(--_ink);
    font: 0.9375rem/1.4 var(--sap-font, system-ui, sans-serif);
  }
  :host([hidden]) {
    display: none;
  }
  * {
    box-sizing: border-box;
  }
  .heading {
    margin: 0 0 6px;
    height: 1.375rem;
    overflow: hidden;
    font-weight: 600;
    line-height: 1.375rem;
    white-space: nowrap;
    text-overflow: ellipsis;
  }
  .picture {
    position: relative;
    aspect-ratio: 600 / 400;
    background: var(--_stage);
    border-radius: 6px;
    overflow: hidden;
    user-select: none;
    -webkit-user-select: none;
  }
  :host([strip]) .picture {
    aspect-ratio: 600 / 160;
  }
  /* A canvas is not recolored where the visitor forces colors, so neither is what is behind it. */
  .picture,
  .array {
    forced-color-adjust: none;
    background: var(--_stage);
  }
  :host(:not([draggable="false"], [predict]:not([static]))) .picture {
    cursor: grab;
  }
  :host(:not([draggable="false"], [predict]:not([static]))) .picture:active {
    cursor: grabbing;
  }
  .picture canvas,
  .array {
    display: block;
    width: 100%;
    height: 100%;
  }
  .array {
    margin-top: 6px;
  }
  :focus-visible {
    outline: 3px solid var(--_chosen);
    outline-offset: 2px;
  }
  .wrong {
    position: absolute;
    inset: 0;
    display: grid;
    place-content: center;
    margin: 0;
    padding: 1rem;
    gap: 0.75rem;
    text-align: center;
    background: var(--_stage);
  }
  .wrong p {
    margin: 0;
  }
  .wrong button {
    justify-self: center;
    height: 44px;
    padding-inline: 1rem;
    border: 1px solid var(--_line);
    border-radius: 6px;
    background: transparent;
    color: inherit;
    font: inherit;
    cursor: pointer;
  }
  .said {
    margin: 6px 0 0;
    height: 2.5rem;
    overflow: hidden;
    font-size: 0.875rem;
    line-height: 1.25rem;
    color: var(--_muted);
    font-variant-numeric: tabular-nums;
  }
  .said[data-explains] {
    color: var(--_ink);
  }
  .hidden {
    position: absolute;
    width: 1px;
    height: 1px;
    margin: -1px;
    overflow: hidden;
    clip-path: inset(50%);
    white-space: nowrap;
  }
  .counters {
    display: grid;
    grid-auto-flow: column;
    grid-auto-columns: minmax(min-content, 1fr);
    gap: 4px 10px;
    margin: 6px 0 0;
    height: 3.375rem;
    overflow: hidden;
  }
  .counters div {
    display: flex;
    flex-direction: column-reverse;
    justify-content: flex-end;
    min-width: 0;
  }
  .counters dt {
    font-size: 0.75rem;
    line-height: 1.2;
    white-space: nowrap;
    color: var(--_muted);
  }
  .counters dd {
    margin: 0;
    font-size: 1.0625rem;
    line-height: 1.3;
    font-weight: 600;
    font-variant-numeric: tabular-nums;
  }
  .controls {
    display: flex;
    flex-wrap: wrap;
    align-items: center;
    gap: 4px;
    margin-top: 6px;
    min-height: 36px;
  }
  .controls .filler {
    flex: 1;
  }
  .controls button,
  .controls select,
  .guess button {
    flex: 0 1 36px;
    height: 36px;
    min-width: 28px;
    padding: 0;
    border: 1px solid var(--_line);
    border-radius: 6px;
    background: transparent;
    color: inherit;
    font: inherit;
    cursor: pointer;
  }
  .controls button:hover:enabled,
  .guess button:hover {
    background: var(--_stage);
  }
  .controls button:disabled {
    opacity: 0.4;
    cursor: default;
  }
  .controls svg {
    display: block;
    width: 16px;
    height: 16px;
    margin: auto;
    fill: currentColor;
  }
  .controls input {
    flex: 1;
    min-width: 60px;
    height: 36px;
    margin: 0 2px;
    accent-color: var(--_ink);
  }
  .controls select {
    flex: none;
    width: 70px;
    padding: 0 2px;
  }
  .guess {
    margin-top: 6px;
    height: calc(3.75rem + 42px);
  }
  .guess p {
    margin: 0 0 6px;
    height: 3.75rem;
    overflow: hidden;
    line-height: 1.25rem;
  }
  .guess div {
    display: flex;
    align-items: center;
    gap: 6px;
  }
  .guess button {
    flex: none;
    min-width: 6rem;
    padding-inline: 0.6rem;
  }
  .swap-log {
    margin-top: 6px;
    height: 5rem;
    overflow: hidden;
    font-size: 0.875rem;
    line-height: 1.25rem;
    font-variant-numeric: tabular-nums;
  }
  .swap-log :is(p, ol) {
    margin: 0;
    padding: 0;
    list-style: none;
  }
  .swap-log p {
    font-weight: 600;
  }
  /* The latest stands first, and is marked by more than its place. */
  .swap-log li:first-child {
    color: var(--_swap);
    font-weight: 600;
  }
  .score {
    margin-left: auto;
    color: var(--_muted);
    font-variant-numeric: tabular-nums;
  }
  .share {
    width: min(34rem, 92vw);
    padding: 1rem;
    border: 1px solid var(--_line);
    border-radius: 8px;
    background: var(--_stage);
    color: var(--_ink);
  }
  .share label {
    display: block;
    font-weight: 600;
  }
  .share textarea {
    display: block;
    width: 100%;
    margin: 4px 0;
    padding: 6px;
    border: 1px solid var(--_line);
    border-radius: 4px;
    background: light-dark(#fff, #0f1214);
    color: inherit;
    font: 0.8125rem/1.4 ui-monospace, monospace;
    font-weight: 400;
    resize: none;
  }
  .share button {
    margin-bottom: 0.75rem;
    padding: 6px 12px;
    border: 1px solid var(--_line);
    border-radius: 6px;
    background: transparent;
    color: inherit;
    font: inherit;
    cursor: pointer;
  }
  .frame {
    container-type: inline-size;
  }
  /* On a phone: two rows, and everything is large enough for a finger. */
  @container (max-width: 27rem) {
    .controls button,
    .controls select {
      flex: 1 0 44px;
      height: 44px;
    }
    .controls input {
      flex: 1 0 100px;
      height: 44px;
    }
    .controls select {
      flex: 2 0 70px;
    }
    /* Each counter is as wide as its name, with the rest between them: equal columns would let names collide. */
    .counters {
      grid-auto-columns: minmax(min-content, max-content);
      justify-content: space-between;
      gap: 4px 8px;
    }
    .guess {
      height: calc(6.25rem + 76px);
    }
    .guess p {
      height: 6.25rem;
    }
    .guess div {
      flex-wrap: wrap;
    }
    .guess button {
      flex: 1 1 auto;
      height: 44px;
      min-width: 5rem;
    }
    .score {
      flex: 1 0 100%;
      height: 20px;
      text-align: end;
    }
  }
  @container (max-width: 19rem) {
    .counters dt {
      white-space: normal;
      letter-spacing: -0.03em;
    }
  }
`;
