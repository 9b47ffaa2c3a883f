import { openDevice } from "./device.js";
import { GpuError } from "./errors.js";
import { PairFinder } from "./finder.js";
import { Usage } from "./usage.js";

/** Options of {@link findPairs}. */
export interface GpuFindPairsOptions {
  /** 2 or 3. */
  readonly dimensions: 2 | 3;

  /** The device to use. By default one is opened at the first call, and kept. */
  readonly device?: GPUDevice;

  /**
   * Called instead if there is no GPU to use: `findPairs` of the package `sweep-and-prune` finds the same pairs on the
   * processor, in another order. By default that is an error, since the difference in speed may be large.
   */
  readonly fallback?: (boxes: Float32Array, options: { readonly dimensions: 2 | 3 }) => Uint32Array | Promise<Uint32Array>;
}

/** The device that is opened at the first call without one. */
let opened: Promise<GPUDevice> | undefined;

/** The finders of each device, by dimensions. */
const finders = new WeakMap<GPUDevice, Map<number, Promise<PairFinder>>>();

/**
 * Finds all overlapping pairs of boxes on the GPU and copies them back: `a` and `b` in turn, `a < b`. Boxes are rows of
 * the min corner and then the max corner, as in `sweep-and-prune`. Boxes that stay on the GPU are found faster with
 * {@link PairFinder}. They are copied at the call, so they may be changed while it waits.
 *
 * @throws {@link GpuError}; `RangeError` for an invalid box, with its index, and for a length or an option; `TypeError` for
 * anything but a `Float32Array`.
 */
export async function findPairs(boxes: Float32Array, options: GpuFindPairsOptions): Promise<Uint32Array> {
  // What TypeScript does not see.
  const { dimensions, fallback } = options ?? {};
  if (!(boxes instanceof Float32Array)) throw new TypeError("boxes must be a Float32Array");
  if (dimensions !== 2 && dimensions !== 3) throw new RangeError(`dimensions is ${dimensions}; it must be 2 or 3`);
  if (boxes.length % (2 * dimensions) !== 0) {
    throw new RangeError(`boxes has ${boxes.length} numbers; a box has ${2 * dimensions}`);
  }
  // The caller may change its boxes while this waits.
  boxes = boxes.slice();
  let device: GPUDevice;
  try {
    device = options.device ?? (await defaultDevice());
  } catch (error) {
    if (fallback && error instanceof GpuError) return fallback(boxes, { dimensions });
    throw error;
  }
  const finder = await finderOf(device, dimensions);
  const buffer = device.createBuffer({ size: Math.max(boxes.byteLength, 64), usage: Usage.STORAGE | Usage.COPY_DST });
  try {
    device.queue.writeBuffer(buffer, 0, boxes as Float32Array<ArrayBuffer>);
    // Copied before the next search may overwrite it: the finder reads in the turn of the search.
    const { invalid, firstInvalid, numbers } = await finder.findAndRead({ boxes: buffer, count: boxes.length / (2 * dimensions) });
    if (invalid > 0) throw new RangeError(`box ${firstInvalid} is invalid: min <= max must hold on each axis, and neither may be NaN`);
    return numbers;
  } finally {
    buffer.destroy();
  }
}

/** The device of calls without one. A lost device is opened again. */
function defaultDevice(): Promise<GPUDevice> {
  opened ??= openDevice().then((device) => {
    void device.lost.then(() => (opened = undefined));
    return device;
  });
  return opened.catch((error) => {
    opened = undefined;
    throw error;
  });
}

/** The finder of a device. */
function finderOf(device: GPUDevice, dimensions: 2 | 3): Promise<PairFinder> {
  const ofDevice = finders.get(device) ?? new Map<number, Promise<PairFinder>>();
  finders.set(device, ofDevice);
  const known = ofDevice.get(dimensions);
  if (known) return known;
  const finder = PairFinder.create(device, { dimensions });
  ofDevice.set(dimensions, finder);
  // The next call tries again.
  finder.catch(() => ofDevice.delete(dimensions));
  return finder;
}
