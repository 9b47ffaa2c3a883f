// Draws the scene of falling balls: discs or spheres in the place of their boxes.

import type { Balls } from "../experiment/messages.ts";
import { onThemeChange } from "../shell/theme.ts";
import { readTheme } from "../view/theme.ts";
import type { View } from "../view/view.ts";

export class BallsPicture {
  #view: View | undefined;
  #dimensions = 0;
  #last: Balls | undefined;
  #end = new AbortController();

  /** `place` holds the canvas: it turns the view of spheres. */
  constructor(
    private readonly place: HTMLElement,
    signal: AbortSignal,
    private readonly changed: () => void,
    private readonly failed: (error: unknown) => void,
  ) {
    signal.addEventListener("abort", () => this.#end.abort());
  }

  /** Shows balls and, of discs, lines for pairs; without balls, hides the picture. */
  show(balls: Balls | undefined, dimensions: 2 | 3, pairs?: Uint32Array): void {
    this.place.hidden = balls === undefined;
    if (!balls) return;
    const world = balls.world ?? this.#last?.world;
    const isNew = balls.world !== undefined && balls.world !== this.#last?.world;
    this.#last = { ...balls, world };
    if (dimensions !== this.#dimensions) return this.#open(dimensions);
    if (isNew) this.#begin();
    this.#view?.draw({ ...balls, pairs });
  }

  resize(): void {
    const { clientWidth, clientHeight } = this.place;
    if (clientWidth > 0) this.#view?.resize(clientWidth, clientHeight);
  }

  #begin(): void {
    const { world } = this.#last ?? {};
    if (!world || !this.#view) return;
    const [floor = 0, ceiling = 1] = [world.min[1], world.max[1]];
    this.#view.begin(world, world.radii, world.heights.map((height) => (height - floor) / (ceiling - floor)));
    this.resize();
  }

  #open(dimensions: 2 | 3): void {
    this.#dimensions = dimensions;
    this.#view = undefined;
    this.#end.abort();
    const { signal } = (this.#end = new AbortController());
    const canvas = document.createElement("canvas");
    const isTurned = dimensions === 3;
    this.place.replaceChildren(canvas);
    this.place.tabIndex = isTurned ? 0 : -1;
    this.place.setAttribute("role", isTurned ? "application" : "img");
    this.place.setAttribute("aria-label", isTurned ? "Spheres falling into a box. Arrow keys turn the view, plus and minus zoom." : "Discs falling into a box");
    const opened = isTurned
      ? import("../view/sphere-view.ts").then(({ SphereView }): View | undefined => (signal.aborted ? undefined : new SphereView(canvas, this.place, readTheme(), this.changed, signal)))
      : import("../view/disc-view.ts").then(({ DiscView }): View => new DiscView(canvas, readTheme()));
    opened.then(
      (view) => {
        if (!view || signal.aborted) return;
        this.#view = view;
        onThemeChange(() => {
          view.setTheme(readTheme());
          this.changed();
        }, signal);
        this.#begin();
        this.changed();
      },
      (error: unknown) => signal.aborted || this.failed(error),
    );
  }
}
