import { read } from "./device.js";
import { Usage } from "./usage.js";

/** A stage of a search, in the words of the table of steps in `docs/gpu.md`. Stages run in this order. */
export type Stage =
  | "read boxes"
  /** Sorts the min corners, makes the keys, and sorts the boxes by them. */
  | "order boxes"
  | "build the tree"
  | "count the pairs"
  | "sum the numbers up"
  | "write the pairs"
  /** Only with the option `sorted`. */
  | "sort the pairs";

/** How long one stage of a search took on the device. */
export interface StageTime {
  /** Which stage. */
  readonly stage: Stage;

  /** 0 or more. Browsers round it: Chromium to a tenth of a millisecond. */
  readonly milliseconds: number;
}

/** The most stages of one search. */
const MOST_STAGES = 7;

/** A time of the device, in bytes. */
const TIME = 8;

/** Lets the device write down when each stage of a search begins and ends. */
export class StageTimer {
  readonly #device: GPUDevice;
  readonly #queries: GPUQuerySet;
  readonly #times: GPUBuffer;
  /** The stages of the last search, in their order. */
  #stages: Stage[] = [];

  /** The device needs the feature `timestamp-query`. */
  constructor(device: GPUDevice) {
    this.#device = device;
    this.#queries = device.createQuerySet({ type: "timestamp", count: 2 * MOST_STAGES });
    this.#times = device.createBuffer({ size: 2 * MOST_STAGES * TIME, usage: Usage.QUERY_RESOLVE | Usage.COPY_SRC });
  }

  /** Forgets the search before. */
  restart(): void {
    this.#stages = [];
  }

  /** How to begin the pass of the next stage. */
  pass(stage: Stage): GPUComputePassDescriptor {
    const beginningOfPassWriteIndex = 2 * (this.#stages.push(stage) - 1);
    return { timestampWrites: { querySet: this.#queries, beginningOfPassWriteIndex, endOfPassWriteIndex: beginningOfPassWriteIndex + 1 } };
  }

  /** Writes the times to a buffer, after the passes. */
  resolve(encoder: GPUCommandEncoder): void {
    encoder.resolveQuerySet(this.#queries, 0, 2 * this.#stages.length, this.#times, 0);
  }

  /** Reads the times of the last search. */
  async read(): Promise<StageTime[]> {
    const stages = this.#stages;
    const numbers = await read(this.#device, this.#times, 2 * TIME * stages.length);
    const times = new BigUint64Array(numbers.buffer);
    // Nanoseconds. A device may reset its clock, as where it saves power: then a time is unknown, and given as 0.
    const milliseconds = (begin: bigint, end: bigint) => Math.max(0, Number(end - begin) / 1e6);
    return stages.map((stage, at) => ({ stage, milliseconds: milliseconds(times[2 * at]!, times[2 * at + 1]!) }));
  }

  /** Gives its memory on the device back. */
  destroy(): void {
    this.#queries.destroy();
    this.#times.destroy();
  }
}
