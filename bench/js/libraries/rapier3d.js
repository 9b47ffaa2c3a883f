import RAPIER from "@dimforge/rapier3d-compat";
import { createWith } from "./rapier.js";

export const create = (setting) => createWith(RAPIER, setting);
