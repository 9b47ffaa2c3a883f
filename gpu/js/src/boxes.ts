import { GpuError } from "./errors.js";
import { Usage } from "./usage.js";

/** Boxes in buffers on the device. */
export interface GpuBoxes {
  /**
   * The boxes, with the usage `STORAGE`. A box is a row of single-precision floats without padding: the min corner, then the
   * max corner. So a 2D box has 16 bytes and a 3D box 24.
   */
  readonly boxes: GPUBuffer;

  /** How many boxes there are: the first of the buffer. */
  readonly count: number;

  /**
   * With the usage `STORAGE`, two 32-bit whole numbers for each box: its category, then its mask. Two boxes pair only if the
   * category of each has a bit in the mask of the other. Filters choose among overlapping boxes; they do not make the search
   * faster.
   */
  readonly filters?: GPUBuffer;

  /**
   * With the usage `STORAGE`, the number of the world of each box, below 2^31. Boxes of different worlds never pair. A box
   * with a greater number counts as invalid.
   */
  readonly worlds?: GPUBuffer;
}

/** Checks the sizes and usages of buffers. */
export function checkBoxes({ boxes, count, filters, worlds }: GpuBoxes, dimensions: number): void {
  if (!(Number.isInteger(count) && count >= 0)) throw new RangeError(`count is ${count}; it must be a whole number, 0 or more`);
  checkBuffer("boxes", boxes, 8 * dimensions * count, Usage.STORAGE);
  if (filters) checkBuffer("filters", filters, 8 * count, Usage.STORAGE);
  if (worlds) checkBuffer("worlds", worlds, 4 * count, Usage.STORAGE);
}

/** Checks the size and the usage of a buffer that a caller passed. */
export function checkBuffer(name: string, buffer: GPUBuffer, needed: number, usage: number): void {
  if (buffer.size < needed) {
    throw new GpuError("BUFFER_TOO_SMALL", `the buffer \`${name}\` has ${buffer.size} bytes, but ${needed} are needed`);
  }
  if (!(buffer.usage & usage)) {
    const missing = usage === Usage.STORAGE ? "STORAGE" : "COPY_SRC";
    throw new GpuError("BUFFER_USAGE", `the buffer \`${name}\` was made without the usage ${missing}`);
  }
}
