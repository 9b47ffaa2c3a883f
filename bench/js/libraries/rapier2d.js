import RAPIER from "@dimforge/rapier2d-compat";
import { createWith } from "./rapier.js";

export const create = (setting) => createWith(RAPIER, setting);
