import { css, type CSSResult, html, LitElement, nothing, type TemplateResult } from "lit";
import { clock } from "./clock.js";
import { workOf } from "./counters.js";
import { reducesMotion } from "./motion-query.js";
import { hasSeed, isOn, newSeed } from "./options.js";
import { styles } from "./styles.js";
import { controls, sharing } from "./templates.js";
import { type Member, Together } from "./together.js";
import { shareTogether } from "./share.js";
import { iframeOf } from "./snippet.js";
import type { SapDemo } from "./types.js";

/** An embedded comparison is at most this wide, in CSS pixels. */
const WIDEST = 900;
/** Numbers that change more often cannot be read. */
const SHOWN_MS = 100;

/** A demo and what its comparison does with it. */
interface Entry {
  readonly demo: SapDemo;
  readonly member: Member;
}

/** What a detection did in all. */
interface Total {
  readonly heading: string;
  readonly work: { readonly count: number; readonly name: string };
}

/**
 * `<sap-comparison>`: the `<sap-demo>`s inside it show one world, each by its own method, always at the same tick,
 * with one set of controls. The totals of the last finished detection stand below as bars. All of them need the same
 * `balls`, `seed`, `motion` and `skip-interval`. If an attribute of one changes more than looks, all start over.
 */
export class SapComparisonElement extends LitElement {
  static override styles: CSSResult[] = [
    styles,
    css`
      :host {
        max-width: none;
      }
      .totals {
        margin: 10px 0 0;
      }
      .totals p,
      .totals div {
        contain: strict;
      }
      .totals p {
        margin: 0 0 4px;
        height: 1.375rem;
        font-size: 0.875rem;
        color: var(--_muted);
        font-variant-numeric: tabular-nums;
      }
      .totals div {
        display: grid;
        grid-template-columns: minmax(0, 10rem) minmax(0, 1fr) 7rem;
        gap: 10px;
        align-items: center;
        height: 1.75rem;
        font-size: 0.875rem;
      }
      .totals div > * {
        overflow: hidden;
        white-space: nowrap;
        text-overflow: ellipsis;
      }
      .totals i {
        display: block;
        height: 0.875rem;
        min-width: 2px;
        background: var(--_check);
        border-radius: 2px;
        forced-color-adjust: none;
      }
      .totals b {
        font-variant-numeric: tabular-nums;
      }
    `,
  ];

  readonly #entries: Entry[] = [];
  readonly #together = new Together(() => this.#entries.map(({ member }) => member));
  #isPlaying = false;
  #speed = 1;
  #totals: { readonly tick: number; readonly of: readonly Total[] } | undefined;
  #shownAt = -Infinity;
  #shared: { url: string; code: string } | undefined;

  // What the demos inside it call

  /** Takes a demo in. It leaves by the function that is returned. */
  join(demo: SapDemo, member: Member): () => void {
    const entry = { demo, member };
    this.#entries.push(entry);
    this.#entries.sort((a, b) => (a.demo.compareDocumentPosition(b.demo) & Node.DOCUMENT_POSITION_FOLLOWING ? -1 : 1));
    return () => void this.#entries.splice(this.#entries.indexOf(entry), 1);
  }

  /** A demo has begun, at its attributes' world. */
  begun(): void {
    this.#totals = undefined;
    if (!this.#isReady) return;
    const isStill = this.#entries.some(({ demo }) => isOn(demo.getAttribute("paused"))) || reducesMotion();
    this.#setPlaying(!isStill);
  }

  get together(): Together {
    return this.#together;
  }

  get isPlaying(): boolean {
    return this.#isPlaying;
  }

  play(): void {
    this.#setPlaying(true);
  }

  pause(): void {
    this.#setPlaying(false);
  }

  step(): void {
    this.#still(() => this.#together.step());
  }

  back(): void {
    this.#still(() => this.#together.back());
  }

  seek(place: number): void {
    if (!Number.isNaN(place)) this.#still(() => this.#together.seek(place));
  }

  reset(): void {
    const isPlaying = this.#isPlaying;
    for (const { member } of this.#entries) member.begin(isPlaying);
    this.#setPlaying(isPlaying);
  }

  /** Something was moved by hand. */
  moved(): void {
    for (const { member } of this.#entries) member.show();
    this.#show(performance.now());
  }

  // Its life

  override connectedCallback(): void {
    super.connectedCallback();
    clock.add(this, { frame: (ms) => this.#frame(ms) });
    // One that was moved within the page goes on.
    if (this.#isPlaying) clock.wake(this);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    clock.remove(this);
  }

  get #isReady(): boolean {
    return this.#entries.length === this.querySelectorAll("sap-demo").length && this.#entries.every(({ member }) => member.run);
  }

  #frame(ms: number): boolean {
    if (!this.#isReady) return false;
    if (this.#isPlaying) this.#together.advance(ms * this.#speed);
    this.#keepTotals();
    const now = performance.now();
    const isDue = !this.#isPlaying || now - this.#shownAt >= SHOWN_MS;
    for (const { member } of this.#entries) member.show();
    if (isDue) this.#show(now);
    return this.#isPlaying;
  }

  #setPlaying(isPlaying: boolean): void {
    this.#isPlaying = isPlaying;
    for (const { member } of this.#entries) member.setPlaying(isPlaying);
    clock.wake(this);
    this.#show(performance.now());
  }

  /** Does something to a world that stands still. */
  #still(act: () => void): void {
    if (!this.#isReady) return;
    this.#setPlaying(false);
    act();
    for (const { member } of this.#entries) member.show();
    this.#show(performance.now());
  }

  #newWorld(): void {
    const seed = newSeed();
    const isPlaying = this.#isPlaying;
    for (const { demo } of this.#entries) demo.setAttribute("seed", seed);
    // The demos read their attributes in a microtask.
    queueMicrotask(() => this.#setPlaying(isPlaying));
  }

  // Showing

  #show(now: number): void {
    this.#shownAt = now;
    this.#keepTotals();
    this.requestUpdate();
  }

  /** The totals of a detection, once all methods are done with it. */
  #keepTotals(): void {
    if (!this.#isReady || !this.#together.isDetected || this.#totals?.tick === this.#together.tick) return;
    if (!this.#entries[0]!.member.run!.timeline.hasDetection) return;
    this.#totals = { tick: this.#together.tick, of: this.#soFar() };
  }

  /** What each method has done in this detection. */
  #soFar(): Total[] {
    return this.#entries.map(({ demo, member: { run } }) => {
      const { counts, options } = run!;
      return { heading: options.heading || demo.getAttribute("strategy") || "", work: workOf(options.detecting, counts) };
    });
  }

  override render(): TemplateResult {
    const { progress, hasPast } = this.#together;
    const options = this.#entries[0]?.member.run?.options;
    return html`<slot></slot>
      <div class="frame">
        ${this.#bars()}
        ${controls({
          isReady: this.#isReady,
          isPlaying: this.#isPlaying,
          canPlay: true,
          canGoBack: hasPast,
          progress,
          speed: this.#speed,
          playOrPause: () => this.#setPlaying(!this.#isPlaying),
          back: () => this.back(),
          step: () => this.step(),
          seek: (place) => this.seek(place),
          setSpeed: (speed) => {
            this.#speed = speed;
            this.#show(performance.now());
          },
          reset: () => this.reset(),
          newWorld: options && hasSeed(options) ? () => this.#newWorld() : undefined,
          share: () => this.#openSharing(),
        })}
        ${this.#shared ? sharing(this.#shared.url, this.#shared.code) : nothing}
      </div>`;
  }

  #bars(): TemplateResult {
    const { tick, of } = this.#totals ?? { tick: undefined, of: this.#isReady ? this.#soFar() : [] };
    const most = Math.max(1, ...of.map(({ work }) => work.count));
    const says = tick === undefined ? "The first detection, so far:" : `The last finished detection, at tick ${tick}:`;
    const headings = of.length > 0 ? of : this.#entries.map(() => undefined);
    return html`<div class="totals" part="totals">
      <p>${says}</p>
      ${headings.map((total) => {
        if (!total) return html`<div></div>`;
        const { count, name } = total.work;
        return html`<div data-total=${tick === undefined ? nothing : count}><span>${total.heading}</span><i style="width:${(100 * count) / most}%"></i><b>${count.toLocaleString("en")} ${count === 1 ? name.slice(0, -1) : name}</b></div>`;
      })}
    </div>`;
  }

  #openSharing(): void {
    const url = shareTogether(this.#entries.map(({ demo }) => demo.share()));
    const title = this.#entries.map(({ member }) => member.run?.options.heading).join(", ");
    this.#shared = { url, code: iframeOf(url, title, this.getBoundingClientRect().height, WIDEST) };
    this.requestUpdate();
    void this.updateComplete.then(() => this.renderRoot.querySelector<HTMLElement>(".share")?.togglePopover());
  }
}

/** The comparison that a demo stands in, if it stands in one. */
export function comparisonOf(demo: Element): SapComparisonElement | undefined {
  return demo.closest<SapComparisonElement>("sap-comparison") ?? undefined;
}
