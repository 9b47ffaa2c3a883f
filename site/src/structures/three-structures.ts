// `<three-structures>`: the same boxes in a sweep, a grid and a tree. In the article its first picture stands in the page already.

import { startAlgorithms } from "../classroom/start.ts";
import { showLoadFailure } from "../load-failed.ts";
import { arrowOf } from "../panel/arrows.ts";
import { countPairs, inside, panels, structures } from "./panels.ts";
import { type Box, moved, type Pair, WIDTH, world, type WorldName } from "./structures.ts";

/** How far an arrow key moves a box, and with shift. */
const ARROW = 5;
const FAR_ARROW = 25;
/** A pointer takes a box from this many units away. */
const REACH = 10;

export class ThreeStructures extends HTMLElement {
  #boxes: Box[] = world("even");
  #chosen = 0;

  connectedCallback(): void {
    startAlgorithms().then(() => this.#start(), (error: unknown) => showLoadFailure(this.querySelector<HTMLElement>(".caption") ?? this, error));
  }

  #start(): void {
    if (this.children.length === 0) this.innerHTML = inside();
    const choice = this.querySelector("select")!;
    choice.disabled = false;
    choice.addEventListener("change", () => {
      this.#boxes = world(choice.value as WorldName);
      this.#chosen = 0;
      this.#show();
    });
    const place = this.#place;
    place.tabIndex = 0;
    place.addEventListener("keydown", (event) => this.#press(event));
    let held: { id: number; dx: number; dy: number; svg: Element } | undefined;
    const at = (event: PointerEvent, svg: Element): { x: number; y: number } => {
      const { left, top, width } = svg.getBoundingClientRect();
      return { x: ((event.clientX - left) * WIDTH) / width, y: ((event.clientY - top) * WIDTH) / width };
    };
    place.addEventListener("pointerdown", (event) => {
      const svg = (event.target as Element).closest("svg");
      if (!svg || event.button !== 0) return;
      const { x, y } = at(event, svg);
      const id = this.#boxAt(x, y);
      if (id === undefined) return;
      const { left, top, right, bottom } = this.#boxes[id]!;
      // The picture is drawn again while the box is moved; its frame stays.
      held = { id, dx: (left + right) / 2 - x, dy: (top + bottom) / 2 - y, svg: svg.parentElement! };
      place.setPointerCapture(event.pointerId);
      this.#chosen = id;
      this.#show();
    });
    place.addEventListener("pointermove", (event) => {
      if (!held) return;
      const name = (held.svg as HTMLElement).dataset["structure"];
      const { x, y } = at(event, this.querySelector(`[data-structure=${name}] svg`)!);
      this.place(held.id, x + held.dx, y + held.dy);
    });
    for (const end of ["pointerup", "pointercancel"]) place.addEventListener(end, () => (held = undefined));
    // A finger on a box moves the box; elsewhere it scrolls the page.
    place.addEventListener(
      "touchstart",
      (event) => {
        const svg = (event.target as Element).closest("svg");
        const touch = event.touches[0];
        if (!svg || !touch) return;
        const { x, y } = at(touch as unknown as PointerEvent, svg);
        if (this.#boxAt(x, y) !== undefined) event.preventDefault();
      },
      { passive: false },
    );
    this.dataset["ready"] = "";
  }

  /** The boxes, rows of min corner and max corner. */
  get rows(): number[][] {
    return this.#boxes.map(({ left, top, right, bottom }) => [left, top, right, bottom]);
  }

  /** The box in question. */
  set chosen(id: number) {
    this.#chosen = id;
    this.#show();
  }

  /** The pairs that each structure finds. */
  get found(): Pair[][] {
    return structures.map(({ run }) => [...run(this.#boxes).pairs]);
  }

  /** Puts the center of a box elsewhere, inside the world. */
  place(id: number, x: number, y: number): void {
    this.#boxes[id] = moved(this.#boxes[id]!, x, y);
    this.#show();
  }

  get #place(): HTMLElement {
    return this.querySelector(".structures")!;
  }

  #press(event: KeyboardEvent): void {
    const by = event.shiftKey ? FAR_ARROW : ARROW;
    const arrow = arrowOf(event);
    const count = this.#boxes.length;
    if (arrow) {
      const { left, top, right, bottom } = this.#boxes[this.#chosen]!;
      this.place(this.#chosen, (left + right) / 2 + by * arrow[0], (top + bottom) / 2 + by * arrow[1]);
    } else if (event.key.toLowerCase() === "b") {
      this.#chosen = (this.#chosen + (event.shiftKey ? count - 1 : 1)) % count;
      this.#show();
    } else return;
    event.preventDefault();
  }

  /** The smallest box at a point, or near it. */
  #boxAt(x: number, y: number): number | undefined {
    const area = ({ left, top, right, bottom }: Box): number => (right - left) * (bottom - top);
    const near = [...this.#boxes.entries()].filter(([, { left, top, right, bottom }]) => x >= left - REACH && x <= right + REACH && y >= top - REACH && y <= bottom + REACH);
    return near.sort(([, a], [, b]) => area(a) - area(b))[0]?.[0];
  }

  #show(): void {
    this.#place.innerHTML = panels(this.#boxes, this.#chosen);
    this.querySelector("[data-part=pairs]")!.textContent = String(countPairs(this.#boxes));
  }
}
