// The demos of the article: loaded when a reader comes near the first of them.

import type { SapDemo } from "sweep-and-prune-classroom/demo";
import { compile } from "virtual:listing/quicksort";
import "../classroom/start.ts";
import "sweep-and-prune-classroom/demo";
import { programOf } from "../edit/harness.ts";
import { FastSweep } from "../lanes/fast-sweep.ts";
import { LibraryTrial } from "../library/library-trial.ts";
import { BoxPlayground } from "../playground/box-playground.ts";
import { ThreeStructures } from "../structures/three-structures.ts";

// This demo runs its listing: the quicksort of the library takes the median of three, and leaves the rest to insertion sort.
document.querySelector<SapDemo>("#d14 sap-demo")!.program = programOf("quicksort", compile);
customElements.define("box-playground", BoxPlayground);
customElements.define("fast-sweep", FastSweep);
customElements.define("library-trial", LibraryTrial);
customElements.define("three-structures", ThreeStructures);
