import type { Library } from "../libraries/index.js";

export const REFERENCE_LIMIT: number;
export const library: Library;
