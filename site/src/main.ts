import { BallLab } from "./lab/ball-lab.ts";

customElements.define("ball-lab", BallLab);
