// Moving about in a picture, or what is in it: by pointer, wheel and keys.

import type { Window2 } from "../experiment/box-picture.ts";
import { arrowOf } from "../panel/arrows.ts";

/** A place in the world. */
export interface Point {
  readonly x: number;
  readonly y: number;
}

/** What a pointer holds, until it lets go. */
export interface Grip {
  move(to: Point): void;
  end(): void;
}

/** A key moves the view by this share of what is shown. */
const KEY_STEP = 0.1;
const KEY_ZOOM = 1.25;

/**
 * Lets a surface be dragged, pinched and zoomed. `changed` gets the new window, nothing for all
 * there is. The wheel scrolls the page until the surface has been chosen by a click or a key.
 * Where `grab` gives something to hold, the pointer moves that; `scale` is in CSS pixels a unit.
 */
export function bindView(
  surface: HTMLElement,
  view: () => Window2 | undefined,
  changed: (view: Window2 | undefined) => void,
  grab: (at: Point, scale: number) => Grip | undefined,
): void {
  let held: { readonly pointer: number; readonly grip: Grip } | undefined;
  const fingers = new Map<number, Point>();
  const move = (dx: number, dy: number): void => {
    const now = view();
    if (now) changed({ ...now, x: now.x - dx / now.scale, y: now.y + dy / now.scale });
  };
  /** Zooms about a point of the surface, in CSS pixels from its middle. */
  const zoom = (factor: number, x = 0, y = 0): void => {
    const now = view();
    if (!now) return;
    const scale = now.scale * factor;
    if (!(scale > 0 && Number.isFinite(scale))) return;
    changed({ x: now.x + x / now.scale - x / scale, y: now.y - y / now.scale + y / scale, scale });
  };
  const fromMiddle = ({ x, y }: Point): [number, number] => {
    const { left, top, width, height } = surface.getBoundingClientRect();
    return [x - left - width / 2, y - top - height / 2];
  };

  const inWorld = (event: { readonly clientX: number; readonly clientY: number }, { x, y, scale }: Window2): Point => {
    const [fromX, fromY] = fromMiddle({ x: event.clientX, y: event.clientY });
    return { x: x + fromX / scale, y: y - fromY / scale };
  };

  surface.addEventListener("pointerdown", (event) => {
    if (held || event.button !== 0) return;
    surface.setPointerCapture(event.pointerId);
    const now = view();
    const grip = now && fingers.size === 0 ? grab(inWorld(event, now), now.scale) : undefined;
    if (grip) {
      held = { pointer: event.pointerId, grip };
      return;
    }
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  // A finger that holds something does not scroll the page.
  surface.addEventListener("touchmove", (event) => held && event.preventDefault(), { passive: false });
  surface.addEventListener("pointermove", (event) => {
    const window = view();
    if (held?.pointer === event.pointerId && window) return held.grip.move(inWorld(event, window));
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const now = { x: event.clientX, y: event.clientY };
    const other = [...fingers].find(([id]) => id !== event.pointerId)?.[1];
    if (other) {
      const distance = (finger: Point): number => Math.max(Math.hypot(finger.x - other.x, finger.y - other.y), 1);
      zoom(distance(now) / distance(before), ...fromMiddle(other));
    } else {
      move(now.x - before.x, now.y - before.y);
    }
    fingers.set(event.pointerId, now);
  });
  for (const end of ["pointerup", "pointercancel"] as const) {
    surface.addEventListener(end, (event) => {
      fingers.delete(event.pointerId);
      if (held?.pointer !== event.pointerId) return;
      const { grip } = held;
      held = undefined;
      grip.end();
    });
  }
  surface.addEventListener(
    "wheel",
    (event) => {
      if (document.activeElement !== surface) return;
      event.preventDefault();
      zoom(Math.exp(-event.deltaY / 400), ...fromMiddle({ x: event.clientX, y: event.clientY }));
    },
    { passive: false },
  );
  surface.addEventListener("keydown", (event) => {
    const arrow = arrowOf(event);
    if (arrow) move(-KEY_STEP * surface.clientWidth * arrow[0], -KEY_STEP * surface.clientHeight * arrow[1]);
    else if (event.key === "+" || event.key === "=") zoom(KEY_ZOOM);
    else if (event.key === "-") zoom(1 / KEY_ZOOM);
    else if (event.key === "0") changed(undefined);
    else return;
    event.preventDefault();
  });
}
