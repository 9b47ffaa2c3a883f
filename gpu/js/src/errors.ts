/** Why a call was rejected: what {@link GpuError.code} says. */
export type GpuErrorCode =
  /** This page or runtime has no WebGPU. */
  | "NO_WEBGPU"
  /** There is WebGPU, but no GPU that it can use. */
  | "NO_ADAPTER"
  /** The GPU could not be opened. */
  | "NO_DEVICE"
  /** The GPU was lost or destroyed: open a device again and make a new finder. */
  | "DEVICE_LOST"
  /** More boxes than the device's limits allow. */
  | "TOO_MANY_BOXES"
  /** More pairs than a buffer of the device holds. None was written. */
  | "TOO_MANY_PAIRS"
  /** A buffer that was passed has fewer bytes than the call needs. */
  | "BUFFER_TOO_SMALL"
  /** A buffer that was passed lacks a usage. */
  | "BUFFER_USAGE"
  /** The device has not enough memory. */
  | "OUT_OF_MEMORY"
  /** The device rejected a command, which is a fault of this package or of the browser. */
  | "DEVICE";

/** A call that the GPU cannot do. After it the finder can be used again, unless the device is lost. */
export class GpuError extends Error {
  /** Why. */
  readonly code: GpuErrorCode;

  /** For `TOO_MANY_PAIRS` the exact number of pairs, for `TOO_MANY_BOXES` the number of boxes, else `undefined`. */
  readonly count: number | undefined;

  /** @internal */
  constructor(code: GpuErrorCode, message: string, count?: number) {
    super(message);
    this.name = "GpuError";
    this.code = code;
    this.count = count;
  }
}
