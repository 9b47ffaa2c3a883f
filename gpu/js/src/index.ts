/**
 * Experimental: finds every overlapping pair of axis-aligned boxes in 2D and 3D on the GPU, with WebGPU. Nothing is claimed
 * about its speed.
 *
 * @module
 */
export type { GpuBoxes } from "./boxes.js";
export { openDevice } from "./device.js";
export { GpuError, type GpuErrorCode } from "./errors.js";
export { findPairs, type GpuFindPairsOptions } from "./find-pairs.js";
export { type GpuPairFinderOptions, type GpuPairs, PairFinder } from "./finder.js";
export { type Stage, type StageTime } from "./stages.js";
export { type Summary, SUMMARY_BYTES, SUMMARY_DISPATCH, SUMMARY_DRAW } from "./summary.js";
