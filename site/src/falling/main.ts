import { FallingBalls } from "./falling-balls.ts";

customElements.define("falling-balls", FallingBalls);
