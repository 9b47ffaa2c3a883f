import { BoxPlayground } from "../playground/box-playground.ts";

customElements.define("box-playground", BoxPlayground);
