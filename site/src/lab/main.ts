import { BallLab } from "./ball-lab.ts";

customElements.define("ball-lab", BallLab);
