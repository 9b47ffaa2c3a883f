// What the page and the worker of a contender say to each other.

/** The first message: what to run. */
export interface Start {
  readonly contender: string;
  readonly scene: string;
  readonly dimensions: number;
  readonly boxes: number;
}

/** What the worker answers when it is warm: its pairs and about how long a call takes, in ms. */
export interface Ready {
  readonly fingerprint: string;
  readonly pairs: number;
  readonly estimate: number;
}

/** Asks for the mean time of a call, in ms, over so many. */
export interface Time {
  readonly calls: number;
}

export type Answer = { readonly ready: Ready } | { readonly time: number } | { readonly failed: string };
