// `<space-time>`: endpoints as lines over time. Where two lines cross, insertion sort swaps, and each swap is one of four cases.
// Its first picture is written when the site is built; afterwards a moment of it is chosen by hand.

import type { Box } from "../box.ts";
import { endpointsOf, precedes, refresh } from "../listings/endpoints.js";
import { letter, line, path, svg, text } from "../svg.ts";

const WIDTH = 560;
const HEIGHT = 300;
const TOP = 8;
/** Frames from the first to the last. */
const FRAMES = 150;

/** Where the left edge of each box is, from time 0 to 1, and how wide it is. */
type World = readonly { readonly wide: number; readonly at: (time: number) => number }[];

const swing = (from: number, far: number, times: number) => (time: number): number => from + far * Math.sin(2 * Math.PI * times * time);
const slide = (from: number, to: number) => (time: number): number => from + (to - from) * time;

/** What each world shows. The names stand in the choice. */
export const WORLDS: Readonly<Record<string, World>> = {
  "A moves through the others": [
    { wide: 70, at: slide(15, 470) },
    { wide: 90, at: slide(130, 150) },
    { wide: 140, at: slide(290, 250) },
    { wide: 40, at: slide(450, 330) },
  ],
  "everything moves a little": [
    { wide: 90, at: swing(40, 12, 2) },
    { wide: 80, at: swing(140, 14, 1.5) },
    { wide: 110, at: swing(260, 10, 2.5) },
    { wide: 90, at: swing(390, 16, 1) },
  ],
  "A jumps": [
    { wide: 50, at: (time) => (time < 0.5 ? 20 : 490) },
    { wide: 80, at: swing(100, 6, 1) },
    { wide: 90, at: swing(220, 6, 1.5) },
    { wide: 70, at: swing(360, 6, 1) },
  ],
};

type Kind = "begins" | "ends" | "nothing";

/** A swap: in which frame, where, and what it means. */
interface Crossing {
  readonly frame: number;
  readonly x: number;
  readonly kind: Kind;
}

/** The order of the endpoints in each frame, and the swaps that lead from one to the next, as insertion sort makes them. */
export function history(world: World): { orders: string[]; crossings: Crossing[]; boxes: Box[][] } {
  const boxes = world.map(({ wide, at }, id): Box => ({ id, left: at(0), right: at(0) + wide, top: 0, bottom: 0 }));
  const endpoints = (endpointsOf(boxes) as { box: Box; isLeft: boolean; at: number }[]).sort((p, q) => (precedes(p, q) ? -1 : 1));
  const crossings: Crossing[] = [];
  const orders: string[] = [];
  const shown: Box[][] = [];
  for (let frame = 0; frame <= FRAMES; frame++) {
    world.forEach(({ wide, at }, id) => Object.assign(boxes[id]!, { left: at(frame / FRAMES), right: at(frame / FRAMES) + wide }));
    refresh(endpoints);
    for (let i = 1; i < endpoints.length; i++) {
      for (let j = i; j > 0 && precedes(endpoints[j], endpoints[j - 1]); j--) {
        const [west, east] = [endpoints[j - 1]!, endpoints[j]!];
        [endpoints[j - 1], endpoints[j]] = [east, west];
        crossings.push({ frame, x: (west.at + east.at) / 2, kind: west.isLeft === east.isLeft ? "nothing" : east.isLeft ? "begins" : "ends" });
      }
    }
    orders.push(endpoints.map(({ box, isLeft }) => (isLeft ? `(${letter(box.id)}` : `${letter(box.id)})`)).join(" "));
    shown.push(boxes.map((box) => ({ ...box })));
  }
  return { orders, crossings, boxes: shown };
}

const y = (frame: number): number => TOP + (HEIGHT * frame) / FRAMES;

/** What stands below the picture at a frame. */
function caption({ orders, crossings }: ReturnType<typeof history>, frame: number): string {
  const past = crossings.filter((crossing) => crossing.frame <= frame);
  const count = (kind: Kind): number => past.filter((crossing) => crossing.kind === kind).length;
  return `${orders[frame]}: ${past.length} swaps so far, ${count("begins")} overlaps begun, ${count("ends")} ended.`;
}

function picture(name: string, frame: number): string {
  const all = history(WORLDS[name]!);
  const edges = WORLDS[name]!.map((_, id) =>
    (["left", "right"] as const).map((side) => path(all.boxes.map((boxes, at) => [boxes[id]![side], y(at)] as const), `world-line ${side}`, id)).join("") +
    text((all.boxes[0]![id]!.left + all.boxes[0]![id]!.right) / 2, TOP + 14, letter(id), "name"));
  const now = all.boxes[frame]!.map((box) => line(box.left, y(frame), box.right, y(frame), "bar", box.id)).join("");
  const dots = all.crossings.map(({ frame: at, x, kind }) => `<circle cx="${x.toFixed(1)}" cy="${y(at).toFixed(1)}" r="5" class="swap-${kind}${at > frame ? " later" : ""}"/>`);
  return `${svg("space-time", WIDTH, HEIGHT + 2 * TOP, `Endpoints of four boxes, each a line from top to bottom through time: left ones solid, right ones dashed. The lines cross ${all.crossings.length} times.`,
    edges.join("") + line(0, y(frame), WIDTH, y(frame), "sweep") + now + dots.join(""))}
    <p class="space-time-said" data-part="said">${caption(all, frame)}</p>`;
}

/** The inside of the element as the page has it. */
export const spaceTime = (): string => `<div data-part="picture">${picture(Object.keys(WORLDS)[0]!, 60)}</div>
    <div class="choices">
      <label>Time <input type="range" min="0" max="${FRAMES}" value="60" autocomplete="off" /></label>
      <label>World <select autocomplete="off">${Object.keys(WORLDS).map((name) => `<option>${name}</option>`).join("")}</select></label>
    </div>`;

/** The element in the page. */
export function startSpaceTime(element: HTMLElement): void {
  const [range, select] = [element.querySelector("input")!, element.querySelector("select")!];
  const show = (): void => {
    element.querySelector("[data-part=picture]")!.innerHTML = picture(select.value, range.valueAsNumber);
    range.setAttribute("aria-valuetext", element.querySelector("[data-part=said]")!.textContent!);
  };
  range.addEventListener("input", show);
  select.addEventListener("change", show);
}
