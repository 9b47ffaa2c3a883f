import type { Contender } from "../contenders/index.js";

export const REFERENCE_LIMIT: number;
export const contender: Contender;
