import { BoxPlayground } from "./box-playground.ts";

customElements.define("box-playground", BoxPlayground);
