// What the page and the worker of a library say to each other.

/** The first message: what to run. */
export interface Start {
  readonly library: string;
  readonly scene: string;
  readonly dimensions: number;
  readonly boxes: number;
}

/** The worker's answer after its warm-up: its pairs, and about how long a call takes, in ms. */
export interface Ready {
  readonly fingerprint: string;
  readonly pairs: number;
  readonly estimate: number;
}

/** Asks for the mean time of a call in ms, over this many calls. */
export interface Time {
  readonly calls: number;
}

export type Answer = { readonly value: Ready | number } | { readonly failed: string };
