// The compiled simulation of falling balls, loaded once in each thread.

import { Simulation } from "../../../classroom/simulation/wasm/simulation.js";
import scalarWasm from "../generated/simulation.wasm?url";
import simdWasm from "../generated/simulation.simd.wasm?url";
import { hasSimd } from "../simd.ts";

let loaded: Promise<unknown> | undefined;

export const loadSimulation = (): Promise<unknown> => (loaded ??= Simulation.load(new URL(hasSimd() ? simdWasm : scalarWasm, self.location.href)));

export { Simulation };
