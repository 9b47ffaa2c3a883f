import { WIDTH } from "./options.js";

/** Where the balls are that a pointer may meet. */
export interface Balls {
  readonly positions: Float32Array;
  readonly radii: Float32Array;
}

/** What a pointer does, in units of the world. */
interface Grabbing {
  /** The balls, if any can be met. */
  balls(): Balls | undefined;
  /** Whether balls may be moved, and not only chosen. */
  isDraggable(): boolean;
  /** Whether the balls move by themselves. */
  isMoving(): boolean;
  /** A ball is about to be moved. */
  take(): void;
  move(ball: number, x: number, y: number): void;
  /** Let go, with the speed that the pointer had, in units a second. */
  release(ball: number, vx: number, vy: number): void;
  /** Pressed and let go in one place. */
  choose(ball: number | undefined): void;
  /** The pointer is on a ball, or on none. */
  point(ball: number | undefined): void;
}

/** A finger hits a ball from this many CSS pixels away. Among balls that move, it has to leave room to scroll the page. */
const REACH = 14;
const REACH_MOVING = 4;
/** A press that moves less, in CSS pixels, is a choice. */
const CLICK = 4;
/** A released ball keeps its mean speed over this many milliseconds. */
const SPEED_MS = 80;

/** Lets pointers (a mouse, fingers, a pen) take hold of balls in a picture. */
export class Grab {
  readonly #picture: HTMLElement;
  readonly #grabbing: Grabbing;
  #held: { pointer: number; ball: number; dx: number; dy: number; from: [number, number]; hasMoved: boolean } | undefined;
  #path: { x: number; y: number; at: number }[] = [];

  constructor(picture: HTMLElement, grabbing: Grabbing) {
    this.#picture = picture;
    this.#grabbing = grabbing;
    picture.addEventListener("pointerdown", (event) => this.#down(event));
    picture.addEventListener("pointermove", (event) => this.#move(event));
    picture.addEventListener("pointerup", (event) => this.#up(event));
    picture.addEventListener("pointercancel", () => this.#drop());
    picture.addEventListener("pointerleave", () => grabbing.point(undefined));
    // A finger on a ball moves the ball; elsewhere it scrolls the page.
    picture.addEventListener("touchstart", (event) => this.#touch(event), { passive: false });
  }

  /** The ball that is held and moved. */
  get held(): number | undefined {
    return this.#held?.hasMoved ? this.#held.ball : undefined;
  }

  /** Where the ball that is held should be. */
  get target(): { x: number; y: number } | undefined {
    const last = this.#path.at(-1);
    return this.#held?.hasMoved && last ? { x: last.x, y: last.y } : undefined;
  }

  #touch(event: TouchEvent): void {
    const touch = event.touches[0];
    if (!touch || !this.#grabbing.isDraggable()) return;
    const [x, y] = this.#inWorld(touch);
    if (this.#ballAt(x, y) !== undefined) event.preventDefault();
  }

  #down(event: PointerEvent): void {
    if (event.button !== 0 || this.#held) return;
    const [x, y] = this.#inWorld(event);
    const ball = this.#ballAt(x, y);
    if (ball === undefined) return this.#grabbing.choose(undefined);
    const { positions } = this.#grabbing.balls()!;
    const [dx, dy] = [positions[2 * ball]! - x, positions[2 * ball + 1]! - y];
    this.#held = { pointer: event.pointerId, ball, dx, dy, from: [event.clientX, event.clientY], hasMoved: false };
    this.#path = [];
    this.#picture.setPointerCapture(event.pointerId);
  }

  #move(event: PointerEvent): void {
    const held = this.#held;
    if (!held) return this.#grabbing.point(this.#ballAt(...this.#inWorld(event)));
    if (event.pointerId !== held.pointer || !this.#grabbing.isDraggable()) return;
    const far = Math.hypot(event.clientX - held.from[0], event.clientY - held.from[1]);
    if (!held.hasMoved && far < CLICK) return;
    if (!held.hasMoved) this.#grabbing.take();
    held.hasMoved = true;
    const [x, y] = this.#inWorld(event);
    this.#path.push({ x: x + held.dx, y: y + held.dy, at: event.timeStamp });
    this.#grabbing.move(held.ball, x + held.dx, y + held.dy);
  }

  #up(event: PointerEvent): void {
    const held = this.#held;
    if (!held || event.pointerId !== held.pointer) return;
    if (!held.hasMoved) {
      this.#held = undefined;
      this.#grabbing.choose(held.ball);
      return;
    }
    const last = this.#path.at(-1)!;
    const recent = this.#path.filter(({ at }) => event.timeStamp - at <= SPEED_MS)[0] ?? last;
    const seconds = Math.max(event.timeStamp - recent.at, 16) / 1000;
    this.#held = undefined;
    this.#grabbing.release(held.ball, (last.x - recent.x) / seconds, (last.y - recent.y) / seconds);
  }

  #drop(): void {
    const held = this.#held;
    this.#held = undefined;
    if (held?.hasMoved) this.#grabbing.release(held.ball, 0, 0);
  }

  #inWorld({ clientX, clientY }: { clientX: number; clientY: number }): [number, number] {
    const { left, top, width } = this.#picture.getBoundingClientRect();
    const scale = WIDTH / width;
    return [(clientX - left) * scale, (clientY - top) * scale];
  }

  /** The ball at a point, the smallest if there are several; or else the nearest within reach. */
  #ballAt(x: number, y: number): number | undefined {
    const { positions, radii } = this.#grabbing.balls() ?? { positions: new Float32Array(), radii: new Float32Array() };
    const reach = ((this.#grabbing.isMoving() ? REACH_MOVING : REACH) * WIDTH) / Math.max(this.#picture.clientWidth, 1);
    let nearest: number | undefined;
    let least = reach;
    radii.forEach((radius, ball) => {
      const outside = Math.max(0, Math.hypot(positions[2 * ball]! - x, positions[2 * ball + 1]! - y) - radius);
      const isSmaller = nearest === undefined || radius <= radii[nearest]!;
      if (outside < least || (outside === least && isSmaller)) [nearest, least] = [ball, outside];
    });
    return nearest;
  }
}
