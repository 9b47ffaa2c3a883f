// What programs do in a frame or for a request, each with this package, with rbush, with flatbush, and by hand.
import { bulletHell } from "./bullet-hell.js";
import { editor } from "./editor.js";
import { meshes } from "./meshes.js";
import { service } from "./service.js";

/** By name: how many frames are measured, and the forms. */
export const scenes = {
  "bullet hell": { frames: 300, forms: bulletHell() },
  editor: { frames: 300, forms: editor() },
  "three.js scene": { frames: 60, forms: meshes() },
  "GeoJSON service": { frames: 20, forms: service() },
};
