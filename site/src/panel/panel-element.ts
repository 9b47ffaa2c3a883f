import { LARGEST_SEED } from "./parts.ts";

/** A slider that is being dragged is heard at most this often. */
const DRAG_MS = 100;

/**
 * What all elements that play share: parts that the built page holds, Play, Step and Reset, and a picture that
 * is drawn at most once a frame. Where the visitor wants less motion it begins paused.
 */
export abstract class PanelElement extends HTMLElement {
  /** Whether the visitor wants it to run. */
  protected wanted = !matchMedia("(prefers-reduced-motion: reduce)").matches;
  /** Whether it can be seen. */
  protected awake = false;
  #left = new AbortController();
  #asked = false;

  /** Aborted when the element leaves the page. */
  protected get signal(): AbortSignal {
    return this.#left.signal;
  }

  connectedCallback(): void {
    this.#left = new AbortController();
    this.start();
  }

  disconnectedCallback(): void {
    this.#left.abort();
  }

  protected abstract start(): void;
  /** Tells the thread whether to run. */
  protected abstract pace(): void;
  /** Draws what is known now. */
  protected abstract show(): void;

  // Controls

  /** From now on, paces it by whether it can be seen: on the screen, in a tab that is not hidden. */
  protected followAwake(): void {
    let isOnScreen = false;
    const update = (): void => {
      this.awake = isOnScreen && document.visibilityState === "visible";
      this.pace();
    };
    const observer = new IntersectionObserver((entries) => {
      isOnScreen = entries.at(-1)?.isIntersecting ?? false;
      update();
    });
    observer.observe(this);
    document.addEventListener("visibilitychange", update, { signal: this.signal });
    this.signal.addEventListener("abort", () => observer.disconnect());
  }

  protected onResize(parts: readonly string[], resized: () => void): void {
    const observer = new ResizeObserver(resized);
    for (const part of parts) observer.observe(this.named(part));
    this.signal.addEventListener("abort", () => observer.disconnect());
  }

  protected onClick(part: string, act: () => void): void {
    this.named(part).addEventListener("click", act);
  }

  protected bindTransport(step: () => void, reset: () => void): void {
    this.onClick("play", () => this.setWanted(!this.wanted));
    this.onClick("step", () => {
      this.setWanted(false);
      step();
    });
    this.onClick("reset", reset);
  }

  protected setWanted(wanted: boolean): void {
    this.wanted = wanted;
    this.pace();
  }

  protected showTransport(): void {
    this.named("play").textContent = this.wanted ? "Pause" : "Play";
  }

  /** A slider over a list of values that need not be evenly spaced; begins at the one nearest to `value`. */
  protected bindSlider(part: string, values: readonly number[], value: number, format: (value: number) => string, changed: (value: number) => void): void {
    const slider = this.named<HTMLInputElement>(part);
    const distance = (at: number): number => Math.abs(values[at]! - value);
    slider.min = "0";
    slider.max = String(values.length - 1);
    slider.valueAsNumber = [...values.keys()].reduce((best, at) => (distance(at) < distance(best) ? at : best), 0);
    const show = (value: number): void => {
      this.write(`${part}-value`, format(value));
      slider.setAttribute("aria-valuetext", format(value));
    };
    show(value);
    let timer: ReturnType<typeof setTimeout> | undefined;
    slider.addEventListener("input", () => {
      show(values[slider.valueAsNumber] ?? value);
      timer ??= setTimeout(() => {
        timer = undefined;
        changed(values[slider.valueAsNumber] ?? value);
      }, DRAG_MS);
    });
  }

  protected bindSeed(seed: number, changed: (seed: number) => void): void {
    const input = this.named<HTMLInputElement>("seed");
    input.value = String(seed);
    input.addEventListener("change", () => {
      const seed = Math.min(Math.max(Math.round(input.valueAsNumber || 0), 0), LARGEST_SEED);
      input.value = String(seed);
      changed(seed);
    });
  }

  // What the visitor sees and reads

  protected requestShow(): void {
    if (this.#asked) return;
    this.#asked = true;
    requestAnimationFrame(() => {
      this.#asked = false;
      this.show();
    });
  }

  /** Writes the text of a part. What is the same is not written: it would be read out again. */
  protected write(part: string, text: string): void {
    const place = this.named(part);
    if (place.textContent !== text) place.textContent = text;
  }

  protected named<E extends HTMLElement = HTMLElement>(name: string): E {
    return this.find<E>(`[data-part="${name}"]`);
  }

  protected find<E extends HTMLElement = HTMLElement>(selector: string): E {
    const found = this.querySelector<E>(selector);
    if (!found) throw new Error(`<${this.localName}> has no ${selector}`);
    return found;
  }
}
