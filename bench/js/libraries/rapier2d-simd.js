import RAPIER from "@dimforge/rapier2d-simd-compat";
import { createWith } from "./rapier.js";

export const create = (setting) => createWith(RAPIER, setting);
