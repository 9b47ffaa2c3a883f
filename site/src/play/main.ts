import { offerGpu } from "../gpu/offer.ts";
import { BoxPlayground } from "../playground/box-playground.ts";

customElements.define("box-playground", BoxPlayground);
offerGpu(document.querySelector<HTMLButtonElement>("#gpu-start")!);
