/** A ball as it is given: its center and radius; its velocity, in units a second, if it has one. */
export type Row = readonly [x: number, y: number, radius: number, vx?: number, vy?: number];

/** What a demo shows at one moment, in numbers that mean the same for every algorithm. */
export interface DemoState {
  /** Ticks of 1/60 s since the beginning. */
  tick: number;
  /** How many events of the detection have been played. */
  events: number;
  /** Pairs of boxes handed to the box test, so far in this detection. */
  tests: number;
  /** Looks at the flags of a pair, where those take the place of tests: one for each overlap on an axis that is found, begins or ends. */
  flagChecks: number;
  /** Pairs that overlap on a swept axis, as far as is known. */
  axisOverlaps: number;
  /** Pairs found to overlap. */
  pairs: number;
  /** Comparisons of the sort. */
  comparisons: number;
  /** Swaps of the sort. */
  swaps: number;
  /** Positions and velocities, bit for bit, in 16 hexadecimal digits. */
  hash: string;
}

/** One event of an algorithm, as listeners of `sap-event` are told it. */
export interface DemoEvent {
  /**
   * What was done: a comparison or a swap of the sort, a pair tested, skipped or found, or given a flag, a ball entered or left
   * by the line; or the full sweep that a swap-driven method begins with.
   */
  kind: "compare" | "swap" | "test" | "enter" | "leave" | "overlap" | "skip" | "flag" | "start";
  /** The first ball. */
  a: number;
  /** The second; of `enter` and `leave` the same. */
  b: number;
  /** Which event of the detection, from 0. */
  index: number;
  /** The line of the program that did it, if a program did and says which. */
  line?: number;
}

/** What is to stand out in a demo: a ball, or all things of a kind, named as the colors are. */
export interface DemoMark {
  /** Which ball. */
  ball?: number | undefined;
  /** Which color, without `--sap-`. */
  color?: string | undefined;
}

/** A comparison or a swap of the sort: the positions in the array; of a comparison, the edges. */
export interface DemoSort {
  /** What was done. */
  kind: "compare" | "swap";
  /** The first position, or edge. */
  i: number;
  /** The second. */
  j: number;
}

/** A ball that was moved by hand, and where it is now. */
export interface DemoDrag {
  /** Which ball. */
  ball: number;
  /** The x of its center now. */
  x: number;
  /** The y of its center now. */
  y: number;
}

/** One thing that a program did. An edge is `2 * ball` for a left end, and one more for a right end. */
export type ProgramEvent =
  | {
      /** Two edges were compared. */
      readonly kind: "compare";
      /** The first edge. */
      readonly a: number;
      /** The second edge. */
      readonly b: number;
      /** The line of the program. */
      readonly line?: number | undefined;
    }
  | {
      /** Two positions of the array were swapped. */
      readonly kind: "swap";
      /** The first position. */
      readonly i: number;
      /** The second position. */
      readonly j: number;
    }
  | {
      /** Two balls were tested, or found to overlap. */
      readonly kind: "test" | "overlap";
      /** The first ball. */
      readonly a: number;
      /** The second ball. */
      readonly b: number;
      /** The line of the program. */
      readonly line?: number | undefined;
    }
  | {
      /** Two balls overlap on one axis. */
      readonly kind: "axis overlap";
      /** 0 is x, 1 is y. */
      readonly axis: number;
      /** The first ball. */
      readonly a: number;
      /** The second ball. */
      readonly b: number;
    }
  | {
      /** From now on the program works on the array of an axis. */
      readonly kind: "array";
      /** 0 is x, 1 is y. */
      readonly axis: number;
      /** Its edges, in order. */
      readonly edges: readonly number[];
    };

/**
 * Finds pairs in the place of a compiled algorithm. `boxes` are rows of min corner and max corner, `before` those of the
 * detection before, if there was one. It runs once for each detection; its events are kept to go back in time. The events may
 * arrive later, for example from a worker: until then the demo waits. An exception is shown in the place of the demo.
 */
export type DemoProgram = (boxes: Float64Array, before: Float64Array | undefined) => readonly ProgramEvent[] | Promise<readonly ProgramEvent[]>;

/** What the element tells, each event bubbling out of it. */
export interface DemoEventMap {
  /** It has begun, or has been simulated on: what it shows now. */
  simulate: CustomEvent<DemoState>;
  /** An event was played. */
  "sap-event": CustomEvent<DemoEvent>;
  /** A comparison or a swap of the sort was played. */
  "sap-sort": CustomEvent<DemoSort>;
  /** A ball was moved by hand. */
  "sap-drag": CustomEvent<DemoDrag>;
  /** Another moment is shown: the event at work, if there is one. */
  "sap-show": CustomEvent<DemoEvent | undefined>;
  /** The pointer is on a ball, or on its endpoint in the array; on none, `undefined`. */
  "sap-point": CustomEvent<number | undefined>;
}

/** `<sap-demo>`, beside its attributes. Each of those is a property as well, in camel case. */
export interface SapDemo extends HTMLElement {
  /** Plays on, from wherever it is. */
  play(): void;
  /** Stops where it is. */
  pause(): void;
  /** Goes on to the next event that is shown; after the last, to the next detection. */
  step(): void;
  /** Goes back to the event before, or to the end of the detection before. */
  back(): void;
  /** Starts over, as the attributes say. A demo that was paused stays paused. */
  reset(): void;
  /** Goes to the k-th of the moments that are kept; 0 is the oldest. Beyond the last, to the last. */
  seek(k: number): void;
  /** The address of a page with this demo alone, as it is now. */
  share(): string;
  /** An iframe of that page, in four lines. */
  embedCode(): string;
  /** Whether it plays. */
  readonly isPlaying: boolean;
  /** What it shows, in numbers. */
  readonly state: DemoState;
  /** The event at work, if there is one. */
  readonly event: DemoEvent | undefined;
  /** The balls where they are, rows of x, y, radius. To set it is to set the attribute. */
  get balls(): Row[];
  /** As the attribute: how many, or which. */
  set balls(value: number | readonly Row[]);
  /** The pairs found so far in this detection. */
  readonly pairs: [number, number][];
  /** What finds the pairs in the place of `strategy`; the world goes on where it is when that changes. */
  program: DemoProgram | undefined;
  /** Resolves when the program has answered; at once where nothing is awaited. */
  readonly settled: Promise<void>;
  /** What is to stand out. */
  marked: DemoMark | undefined;
  /** What the balls are called. */
  readonly names: readonly string[];
  /** The balls that the visitor has chosen, at most two. */
  readonly chosen: number[];
  /** Resolves when it is loaded and shown; also if it cannot be, which it then says itself. */
  readonly ready: Promise<void>;

  /** Listens to one of the {@link DemoEventMap | element's own events}. */
  addEventListener<K extends keyof DemoEventMap>(
    type: K,
    listener: (this: this, event: DemoEventMap[K]) => unknown,
    options?: boolean | AddEventListenerOptions,
  ): void;
  /** Listens to any other event. */
  addEventListener(type: string, listener: EventListenerOrEventListenerObject, options?: boolean | AddEventListenerOptions): void;
}
