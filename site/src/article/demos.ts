// The demos of the article: loaded when a reader comes near the first of them.

import "../classroom/start.ts";
import "sweep-and-prune-classroom/demo";
import { FallingBalls } from "../simulation/falling-balls.ts";
import { LibraryTrial } from "../library/library-trial.ts";
import { ThreeStructures } from "../structures/three-structures.ts";

customElements.define("falling-balls", FallingBalls);
customElements.define("library-trial", LibraryTrial);
customElements.define("three-structures", ThreeStructures);
