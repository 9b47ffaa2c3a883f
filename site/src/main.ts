import { BallLab } from "./lab/ball-lab.ts";
import { LibraryTrial } from "./library/library-trial.ts";

customElements.define("ball-lab", BallLab);
customElements.define("library-trial", LibraryTrial);
