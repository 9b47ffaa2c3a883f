/** A demo that the clock calls while it is visible. */
interface Ticking {
  /** Called once a frame with the milliseconds since the last. Returns whether it wants another. */
  frame(ms: number): boolean;
}

/** A frame that comes later than this counts as no longer: a tab that was hidden does not rush. */
const LONGEST_FRAME_MS = 50;

/**
 * One clock for all demos of a page. It runs only while there is one that wants frames, is on the
 * screen, and is in a tab that can be seen.
 */
class Clock {
  readonly #elements = new Map<Element, Ticking>();
  readonly #visible = new Set<Element>();
  readonly #wanting = new Set<Element>();
  #request: number | undefined;
  #last: number | undefined;
  #observer: IntersectionObserver | undefined;

  add(element: Element, ticking: Ticking): void {
    if (this.#elements.size === 0) document.addEventListener("visibilitychange", this.#update);
    this.#elements.set(element, ticking);
    this.#observer ??= new IntersectionObserver((entries) => this.#see(entries), { rootMargin: "50px" });
    this.#observer.observe(element);
  }

  remove(element: Element): void {
    this.#elements.delete(element);
    this.#visible.delete(element);
    this.#wanting.delete(element);
    this.#observer?.unobserve(element);
    if (this.#elements.size === 0) document.removeEventListener("visibilitychange", this.#update);
    this.#update();
  }

  /** Asks for frames until one is answered with no. */
  wake(element: Element): void {
    if (!this.#elements.has(element)) return;
    this.#wanting.add(element);
    this.#update();
  }

  #see(entries: IntersectionObserverEntry[]): void {
    for (const { target, isIntersecting } of entries) {
      if (isIntersecting) this.#visible.add(target);
      else this.#visible.delete(target);
    }
    this.#update();
  }

  readonly #update = (): void => {
    const isRunning = !document.hidden && [...this.#wanting].some((element) => this.#visible.has(element));
    if (isRunning && this.#request === undefined) {
      this.#last = undefined;
      this.#request = requestAnimationFrame(this.#frame);
    } else if (!isRunning && this.#request !== undefined) {
      cancelAnimationFrame(this.#request);
      this.#request = undefined;
    }
  };

  readonly #frame = (now: number): void => {
    const ms = Math.min(now - (this.#last ?? now), LONGEST_FRAME_MS);
    this.#last = now;
    this.#request = requestAnimationFrame(this.#frame);
    for (const element of [...this.#wanting]) {
      if (!this.#visible.has(element)) continue;
      if (this.#elements.get(element)?.frame(ms) !== true) this.#wanting.delete(element);
    }
    this.#update();
  };
}

export const clock: Clock = new Clock();
