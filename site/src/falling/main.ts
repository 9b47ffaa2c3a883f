import { FallingBalls } from "../simulation/falling-balls.ts";

customElements.define("falling-balls", FallingBalls);
