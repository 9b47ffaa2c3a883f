// Starts the compiled algorithms of this page: those of the classroom, and broken variants that only the site has.

import { init } from "sweep-and-prune-classroom";
import { addVariants } from "sweep-and-prune-classroom/variants";
import wasm from "../generated/algorithms.wasm?url";
import { broken } from "./broken.ts";

addVariants(broken, wasm);

/** The first to start them decides which they are: so every part of a page that runs an algorithm starts them by this. */
export async function startAlgorithms(): Promise<void> {
  await init({ wasm });
}
