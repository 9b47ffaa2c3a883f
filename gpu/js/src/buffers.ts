import type { Bound } from "./steps.js";
import { Usage } from "./usage.js";

/** What a buffer of a finder holds. */
export type Slot =
  /** Bounds of each box, in the order of the input: eight numbers. */
  | "rows"
  /** Bounds of the nodes of the tree, level by level. */
  | "nodes"
  /** The min corners on each axis, sorted. */
  | "sortedX"
  | "sortedY"
  | "sortedZ"
  /** What is sorted: keys, and the order of the boxes. */
  | "highKeys"
  | "keys"
  | "otherKeys"
  | "order"
  | "otherOrder"
  /** The table of the sort, and the sums of each level of a scan. */
  | "table"
  | `sums${number}`
  /** Category and mask of each box. */
  | "filters"
  /** The number of pairs of each box, or of all boxes before it. */
  | "tally"
  /** How many boxes are invalid, and the first. */
  | "invalid"
  /** Pairs and summary of a call without buffers of its own. */
  | "pairs"
  | "summary"
  /** The indices of pairs while they are sorted. */
  | "firsts"
  | "otherFirsts"
  | "seconds"
  | "otherSeconds"
  /** Bound where a kernel's input is missing. */
  | "unused";

/** Buffers that grow as needed and never shrink. */
export class Buffers {
  readonly #device: GPUDevice;
  readonly #slots = new Map<Slot, GPUBuffer>();
  /** The parameters of the steps. */
  params: GPUBuffer | undefined;

  constructor(device: GPUDevice) {
    this.#device = device;
  }

  /** The first `numbers` numbers of a buffer. Its contents are kept unless it has to grow. */
  get(slot: Slot, numbers: number): Bound {
    // The largest element of any array, so that an empty array can be bound.
    const size = Math.max(4 * numbers, 64);
    let buffer = this.#slots.get(slot);
    if (!buffer || buffer.size < size) {
      // An eighth more than needed, so that sizes that vary a little do not make a new buffer each time.
      const spare = Math.max(size, Math.min(size + 4 * Math.floor(size / 32), 4 * Math.floor(mostBytes(this.#device) / 4)));
      const usage = Usage.STORAGE | Usage.COPY_SRC | Usage.COPY_DST | Usage.INDIRECT | Usage.VERTEX;
      buffer = this.#device.createBuffer({ label: `sweep-and-prune: ${slot}`, size: spare, usage });
      this.#slots.set(slot, buffer);
    }
    return { buffer, size };
  }

  /** Gives the memory of all buffers back. They are made again when they are needed. */
  destroy(): void {
    for (const buffer of this.#slots.values()) buffer.destroy();
    this.params?.destroy();
    this.#slots.clear();
    this.params = undefined;
  }
}

/** The largest array that a kernel can see on a device, in bytes. */
export const mostBytes = ({ limits }: GPUDevice): number => Math.min(limits.maxStorageBufferBindingSize, limits.maxBufferSize);
