// `<fast-sweep>`: the sweep of a column as loads of cache lines and lanes of vectors. Its first picture stands in the page already.

import record from "../../../core/src/pairs/columns.txt?raw";
import { firstStep, type Shown, sweepOf } from "./picture.ts";

export class FastSweep extends HTMLElement {
  #shown: Shown = sweepOf(record, 8);

  connectedCallback(): void {
    const [slider, lanes] = [this.querySelector("input")!, this.querySelector("select")!];
    const show = (): void => {
      this.querySelector(".fast-picture")!.innerHTML = this.#shown.html(Number(slider.value));
    };
    slider.addEventListener("input", show);
    lanes.addEventListener("change", () => {
      this.#shown = sweepOf(record, Number(lanes.value));
      slider.max = String(this.#shown.steps.length - 1);
      slider.value = String(firstStep(this.#shown));
      show();
    });
    slider.disabled = lanes.disabled = false;
    this.dataset["ready"] = "";
  }
}
