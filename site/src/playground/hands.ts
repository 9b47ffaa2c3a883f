// Boxes that are drawn, dragged, added and deleted by hand: by pointer, by keys and by buttons.

import type { Window2 } from "../experiment/box-picture.ts";
import { arrowOf } from "../panel/arrows.ts";
import { bindView, type Grip, type Point } from "./view.ts";

/** Rows of min corner and max corner, and how long a row is. */
export interface Shown {
  readonly dimensions: 2 | 3;
  readonly boxes: Float32Array;
}

/** What the hands reach into. */
export interface Playground {
  readonly surface: HTMLElement;
  readonly buttons: Readonly<Record<"draw" | "add" | "delete" | "undo" | "clear", HTMLButtonElement>>;
  /** The boxes that the picture shows now. */
  shown(): Shown | undefined;
  view(): Window2 | undefined;
  setView(view: Window2 | undefined): void;
  /** A box is held or let go: time stands still meanwhile. */
  setHeld(isHeld: boolean): void;
  /** These boxes take the place of those shown. */
  setBoxes(shown: Shown): void;
  /** Another box is selected, or none. */
  select(text: string): void;
}

/** How many changes can be undone. */
const MOST_UNDONE = 100;
/** A key moves a box by this share of what is shown. */
const KEY_STEP = 0.01;
/** A box that is drawn by a click, or added by a button, is this wide, in CSS pixels. */
const ADDED = 48;
/** What is drawn smaller than this, in CSS pixels, was a click. */
const CLICK = 4;

export class Hands {
  #selected: number | undefined;
  #draws = false;
  #past: Shown[] = [];

  constructor(private readonly playground: Playground) {
    const { surface, buttons } = playground;
    // Before the view's own keys: an arrow moves the box that is selected.
    surface.addEventListener("keydown", (event) => this.#press(event));
    bindView(surface, () => playground.view(), (view) => playground.setView(view), (point, scale) => this.#grab(point, scale));
    buttons.draw.addEventListener("click", () => this.#setDraws(!this.#draws));
    buttons.add.addEventListener("click", () => this.#add());
    buttons.delete.addEventListener("click", () => this.#delete());
    buttons.undo.addEventListener("click", () => this.#undo());
    buttons.clear.addEventListener("click", () => this.replace((shown) => ({ ...shown, boxes: new Float32Array(0) })));
    this.#offer();
  }

  /** The box that is selected. */
  get selected(): number | undefined {
    return this.#selected;
  }

  /** Another world: nothing is selected, and there is nothing to undo. */
  forget(): void {
    this.#past = [];
    this.#select(undefined);
  }

  /** Changes the boxes in a way that can be undone. */
  replace(change: (shown: Shown) => Shown, selected?: number): void {
    const shown = this.playground.shown();
    if (shown) this.replaceAll(change(shown), selected);
  }

  /** Puts other boxes in the place of those that are shown, if there are any, in a way that can be undone. */
  replaceAll(boxes: Shown, selected?: number): void {
    const shown = this.playground.shown();
    if (shown) this.#keep(shown);
    this.playground.setBoxes(boxes);
    this.#select(selected);
  }

  // By pointer

  /** What a pointer that goes down here holds: a box, or one that is being drawn. */
  #grab(at: Point, scale: number): Grip | undefined {
    const shown = this.playground.shown();
    if (!shown) return undefined;
    const hit = this.#draws ? undefined : boxAt(shown, at, scale);
    if (hit === undefined && !this.#draws) {
      this.#select(undefined);
      return undefined;
    }
    this.#keep(shown);
    this.playground.setHeld(true);
    const box = hit ?? shown.boxes.length / (2 * shown.dimensions);
    if (hit === undefined) this.playground.setBoxes(withBox(shown, at, at));
    this.#select(box);
    let last = at;
    let hasMoved = false;
    return {
      move: (to) => {
        hasMoved = true;
        last = to;
        this.playground.setBoxes(hit === undefined ? withBox(shown, at, to) : moved(shown, box, to.x - at.x, to.y - at.y));
      },
      end: () => {
        const isClick = Math.max(Math.abs(last.x - at.x), Math.abs(last.y - at.y)) * scale < CLICK;
        if (hit === undefined && isClick) this.playground.setBoxes(withBox(shown, corner(at, -0.5 * ADDED / scale), corner(at, 0.5 * ADDED / scale)));
        else if (hit !== undefined && !hasMoved) this.#past.pop();
        this.playground.setHeld(false);
        this.#select(box);
      },
    };
  }

  // By keys and buttons

  #press(event: KeyboardEvent): void {
    const shown = this.playground.shown();
    const view = this.playground.view();
    if (!shown || !view) return;
    const { clientWidth, clientHeight } = this.playground.surface;
    const boxes = shown.boxes.length / (2 * shown.dimensions);
    const [stepX, stepY] = [(KEY_STEP * clientWidth) / view.scale, (KEY_STEP * clientHeight) / view.scale];
    const [right, down] = arrowOf(event) ?? [];
    const arrow = right !== undefined && down !== undefined ? { x: right * stepX, y: -down * stepY } : undefined;
    const box = this.#selected;
    if (event.key === "z" && (event.ctrlKey || event.metaKey)) this.#undo();
    else if (event.ctrlKey || event.metaKey || event.altKey) return;
    else if (event.key === "b" && boxes > 0) this.#select(box === undefined ? 0 : (box + 1) % boxes);
    else if (event.key === "B" && boxes > 0) this.#select(((box ?? 0) + boxes - 1) % boxes);
    else if (event.key === "n") this.#add();
    else if (box === undefined) return;
    else if (event.key === "Escape") this.#select(undefined);
    else if (event.key === "Delete" || event.key === "Backspace") this.#delete();
    else if (arrow && event.shiftKey) this.replace((shown) => grown(shown, box, arrow), box);
    else if (arrow) this.replace((shown) => moved(shown, box, arrow.x, arrow.y), box);
    else return;
    event.preventDefault();
    // Otherwise the same key would move the view.
    event.stopImmediatePropagation();
  }

  /** A box in the middle of the view. */
  #add(): void {
    const view = this.playground.view() ?? { x: 0.5, y: 0.5, scale: 400 };
    const shown = this.playground.shown();
    if (!shown) return;
    const half = (0.5 * ADDED) / view.scale;
    this.replace((shown) => withBox(shown, corner(view, -half), corner(view, half)), shown.boxes.length / (2 * shown.dimensions));
  }

  #delete(): void {
    const box = this.#selected;
    if (box !== undefined) this.replace((shown) => without(shown, box));
  }

  #undo(): void {
    const before = this.#past.pop();
    if (!before) return;
    this.playground.setBoxes(before);
    this.#select(undefined);
  }

  #setDraws(draws: boolean): void {
    this.#draws = draws;
    const { surface, buttons } = this.playground;
    buttons.draw.setAttribute("aria-pressed", String(draws));
    surface.classList.toggle("draws", draws);
  }

  #keep(shown: Shown): void {
    this.#past.push({ ...shown, boxes: shown.boxes.slice() });
    if (this.#past.length > MOST_UNDONE) this.#past.shift();
  }

  #select(box: number | undefined): void {
    this.#selected = box;
    const shown = this.playground.shown();
    this.playground.select(box === undefined || !shown ? "" : describe(shown, box));
    this.#offer();
  }

  #offer(): void {
    const { buttons } = this.playground;
    buttons.delete.disabled = this.#selected === undefined;
    buttons.undo.disabled = this.#past.length === 0;
  }
}

const corner = ({ x, y }: Point, by: number): Point => ({ x: x + by, y: y + by });

/** The smallest box at a point, with a little around it for the finger. */
export function boxAt({ dimensions, boxes }: Shown, { x, y }: Point, scale: number): number | undefined {
  const slack = 4 / scale;
  let [found, least]: [number | undefined, number] = [undefined, Infinity];
  for (let at = 0, box = 0; at < boxes.length; at += 2 * dimensions, box++) {
    const [left, bottom, right, top] = [boxes[at]!, boxes[at + 1]!, boxes[at + dimensions]!, boxes[at + dimensions + 1]!];
    if (x < left - slack || x > right + slack || y < bottom - slack || y > top + slack) continue;
    const area = (right - left) * (top - bottom);
    if (area <= least) [found, least] = [box, area];
  }
  return found;
}

/** One more box between two corners; in 3D as deep as the world, which is seen along that axis. */
function withBox({ dimensions, boxes }: Shown, a: Point, b: Point): Shown {
  const row = [Math.min(a.x, b.x), Math.min(a.y, b.y), Math.max(a.x, b.x), Math.max(a.y, b.y)];
  if (dimensions === 3) {
    let [near, far] = [Infinity, -Infinity];
    for (let at = 0; at < boxes.length; at += 6) [near, far] = [Math.min(near, boxes[at + 2]!), Math.max(far, boxes[at + 5]!)];
    row.splice(2, 0, near > far ? 0 : near);
    row.push(near > far ? 1 : far);
  }
  return { dimensions, boxes: Float32Array.from([...boxes, ...row]) };
}

/** A box elsewhere. Its corners move by the same amount in double precision, so it keeps its size up to rounding. */
function moved({ dimensions, boxes }: Shown, box: number, dx: number, dy: number): Shown {
  const [changed, at] = [boxes.slice(), 2 * dimensions * box];
  for (const end of [at, at + dimensions]) {
    changed[end]! += dx;
    changed[end + 1]! += dy;
  }
  return { dimensions, boxes: changed };
}

/** A box whose upper right corner is moved; it does not turn inside out. */
function grown({ dimensions, boxes }: Shown, box: number, { x, y }: Point): Shown {
  const [changed, at] = [boxes.slice(), 2 * dimensions * box];
  changed[at + dimensions] = Math.max(changed[at]!, changed[at + dimensions]! + x);
  changed[at + dimensions + 1] = Math.max(changed[at + 1]!, changed[at + dimensions + 1]! + y);
  return { dimensions, boxes: changed };
}

function without({ dimensions, boxes }: Shown, box: number): Shown {
  const row = 2 * dimensions;
  return { dimensions, boxes: Float32Array.from([...boxes.subarray(0, row * box), ...boxes.subarray(row * (box + 1))]) };
}

function describe({ dimensions, boxes }: Shown, box: number): string {
  const row = boxes.subarray(2 * dimensions * box, 2 * dimensions * (box + 1));
  const on = (axis: number): string => `${"xyz"[axis]} ${Number(row[axis]!.toPrecision(3))} to ${Number(row[axis + dimensions]!.toPrecision(3))}`;
  return `Box ${box}: ${Array.from({ length: dimensions }, (_, axis) => on(axis)).join(", ")}.`;
}
