import { GpuError } from "./errors.js";
import { READ, Usage } from "./usage.js";

/** The feature of devices that say when something began and ended. */
export const TIMES = "timestamp-query" as const;

/**
 * Opens the fastest GPU for computing, with the largest buffers that it grants, and with the feature `timestamp-query` where it
 * has that. A page that draws has a device already
 * and passes that to {@link PairFinder.create}.
 *
 * @throws {@link GpuError} `NO_WEBGPU`, `NO_ADAPTER` or `NO_DEVICE`.
 */
export async function openDevice(): Promise<GPUDevice> {
  const gpu = globalThis.navigator?.gpu as GPU | undefined;
  if (!gpu) {
    throw new GpuError("NO_WEBGPU", "there is no WebGPU here: it needs a recent browser and a secure page (https or localhost)");
  }
  const adapter = await gpu.requestAdapter({ powerPreference: "high-performance" });
  if (!adapter) throw new GpuError("NO_ADAPTER", "the browser found no GPU that WebGPU can use");
  const { maxStorageBufferBindingSize, maxBufferSize } = adapter.limits;
  const requiredLimits = { maxStorageBufferBindingSize, maxBufferSize };
  const requiredFeatures = [TIMES].filter((feature) => adapter.features.has(feature));
  try {
    return await adapter.requestDevice({ label: "sweep-and-prune", requiredLimits, requiredFeatures });
  } catch (error) {
    throw new GpuError("NO_DEVICE", `the GPU could not be opened: ${error}`);
  }
}

/** Devices that are lost. */
const lost = new WeakSet<GPUDevice>();

/** Notes when a device is lost. */
export function watch(device: GPUDevice): void {
  void device.lost.then(() => lost.add(device));
}

/** Does something with a device, and throws what the device finds wrong meanwhile. */
export async function checked<R>(device: GPUDevice, run: () => R): Promise<R> {
  if (lost.has(device)) throw deviceLost();
  for (const filter of ["validation", "out-of-memory", "internal"] as const) device.pushErrorScope(filter);
  let result: R;
  let errors: (GPUError | null)[];
  try {
    result = run();
  } finally {
    const popped = [device.popErrorScope(), device.popErrorScope(), device.popErrorScope()];
    // The scopes of a lost device fail.
    errors = await Promise.all(popped).catch(() => {
      throw deviceLost();
    });
  }
  const [internal, memory, validation] = errors;
  if (memory) throw new GpuError("OUT_OF_MEMORY", "the memory of the GPU is not enough");
  const other = internal ?? validation;
  if (other) throw new GpuError("DEVICE", `the GPU rejected a command: ${other.message}`);
  return result;
}

/** Reads the beginning of a buffer. */
export async function read(device: GPUDevice, buffer: GPUBuffer, bytes: number): Promise<Uint32Array> {
  if (bytes === 0) return new Uint32Array();
  const copy = await checked(device, () => {
    const copy = device.createBuffer({ size: bytes, usage: Usage.MAP_READ | Usage.COPY_DST });
    const encoder = device.createCommandEncoder();
    encoder.copyBufferToBuffer(buffer, 0, copy, 0, bytes);
    device.queue.submit([encoder.finish()]);
    return copy;
  });
  try {
    await copy.mapAsync(READ);
  } catch {
    throw deviceLost();
  }
  const numbers = new Uint32Array(copy.getMappedRange().slice(0));
  copy.destroy();
  return numbers;
}

function deviceLost(): GpuError {
  return new GpuError("DEVICE_LOST", "the GPU was lost: open a device again and make a new finder");
}
