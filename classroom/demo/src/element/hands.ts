import type { DemoDrag, SapDemo } from "./types.js";
import { canPlay } from "./detection.js";
import { Grab } from "./grab.js";
import type { Keyboard } from "./keys.js";
import { inWords } from "./narrate.js";
import type { Run } from "./run.js";
import { Selection } from "./selection.js";

/** What hands find and do, beside what anybody may call. */
interface Handled {
  run(): Run | undefined;
  guess(choice: number): void;
  /** A ball was taken, to be moved. */
  took(): void;
  /** A ball was moved by hand; a static world has run its detection again. */
  moved(drag: DemoDrag, isDetected: boolean): void;
  /** A choice is to be shown. */
  chose(): void;
  /** The pointer is on a ball, or on none. */
  pointed(ball: number | undefined): void;
  /** Puts a ball elsewhere, with this velocity; also in the demos that show the same world. */
  place(ball: number, x: number, y: number, vx: number, vy: number): void;
  /** Runs the detection again where the world stands still. */
  detectAgain(): void;
  /** Says this at once. */
  say(text: string): void;
  /** Says soon what there is to say, after this. */
  saySoon(first?: string): void;
}

/** The hands of a visitor, by pointer and by keys: which balls they choose, and where they put them. */
export class Hands {
  readonly selection: Selection = new Selection();
  readonly #demo: SapDemo;
  readonly #handled: Handled;
  #grab: Grab | undefined;

  constructor(demo: SapDemo, handled: Handled) {
    this.#demo = demo;
    this.#handled = handled;
  }

  /** Lets pointers take hold of the balls in a picture. */
  reachInto(picture: HTMLElement): void {
    this.#grab = new Grab(picture, {
      balls: () => this.#handled.run()?.timeline,
      isDraggable: () => this.#isDraggable,
      take: () => this.#handled.took(),
      move: (ball, x, y) => this.#move(ball, x, y),
      isMoving: () => this.#handled.run()?.options.isStatic === false,
      release: (ball, vx, vy) => {
        const run = this.#handled.run()!;
        if (run.options.isStatic) return;
        const { x, y } = run.placeOf(ball);
        this.#handled.place(ball, x, y, vx, vy);
        if (!this.#demo.isPlaying) this.#handled.detectAgain();
      },
      choose: (ball) => this.#handled.run() && this.#choose(ball),
      point: (ball) => this.#handled.pointed(ball),
    });
  }

  /** What is asked about stays as it is until it has been guessed. */
  get #isDraggable(): boolean {
    const run = this.#handled.run();
    return run?.options.isDraggable === true && !run.question;
  }

  /** Whether a ball is held and moved. */
  get isHolding(): boolean {
    return this.#grab?.held !== undefined;
  }

  /** Keeps the ball that is held where the hand is, in a world that goes on. */
  hold(): void {
    const { held, target } = this.#grab ?? {};
    if (held !== undefined && target) this.#handled.place(held, target.x, target.y, 0, 0);
  }

  /** The pointer is on a ball, or on its endpoint, or on none. */
  point(ball: number | undefined): void {
    this.#handled.pointed(ball);
  }

  readonly keyboard: Keyboard = {
    playOrPause: () => {
      if (this.#demo.isPlaying) return this.#demo.pause();
      // Where nothing moves and nothing is stepped through, there is nothing to play.
      const run = this.#handled.run();
      if (run && canPlay(run.options)) this.#demo.play();
      else this.#demo.step();
    },
    step: () => this.#demo.step(),
    back: () => this.#demo.back(),
    moveCursor: (by) => {
      const { names, timeline } = this.#handled.run()!;
      if (timeline.radii.length === 0) return;
      this.selection.moveCursor(by, timeline.radii.length);
      this.#handled.took();
      this.#handled.chose();
      this.#handled.say(`Ball ${names[this.selection.cursor!]}`);
    },
    take: () => this.selection.cursor !== undefined && this.#choose(this.selection.cursor),
    takeNone: () => this.#choose(undefined),
    push: (dx, dy) => {
      const run = this.#handled.run()!;
      if (!this.#isDraggable) return;
      const ball = (this.selection.cursor ??= 0);
      if (ball >= run.timeline.radii.length) return;
      this.#demo.pause();
      const { x, y } = run.placeOf(ball);
      this.#move(ball, x + dx, y + dy);
      const place = run.placeOf(ball);
      this.#handled.saySoon(`${run.names[ball]} is at ${inWords(place.x)}, ${inWords(place.y)}.`);
    },
    guess: (choice) => this.#handled.guess(choice),
  };

  /** In a static world, the algorithm runs again at once. */
  #move(ball: number, x: number, y: number): void {
    const run = this.#handled.run()!;
    const isStill = !this.#demo.isPlaying;
    if (isStill) {
      this.#handled.place(ball, x, y, 0, 0);
      this.#handled.detectAgain();
    }
    this.#handled.moved({ ball, ...run.placeOf(ball) }, isStill);
  }

  #choose(ball: number | undefined): void {
    this.selection.cursor = ball;
    if (this.#handled.run()!.options.explains) {
      this.selection.take(ball);
      if (this.selection.pair) this.#demo.pause();
    }
    this.#handled.chose();
    if (this.selection.pair) this.#handled.saySoon();
  }
}
