// Writes the first picture of `<three-structures>` into the page, so that it is there without scripts too.

import { init } from "sweep-and-prune/algorithms";
import { countPairs, panels } from "./panels.ts";
import { world } from "./structures.ts";

await init();

export function expandStructures(page: string): string {
  return page.replace("<three-structures></three-structures>", () => {
    const boxes = world("even");
    return `<three-structures>
      <div class="structures" role="group" aria-label="Eighty boxes in a sweep, a grid and a tree. B chooses the next box, the arrow keys move it.">${panels(boxes, 0)}</div>
      <div class="choices"><label>World
        <select autocomplete="off" disabled>
          <option value="even">Boxes of similar size, everywhere</option>
          <option value="long">A long level</option>
          <option value="one large">One large box among small ones</option>
        </select></label></div>
      <p class="caption">All three find the same <strong data-part="pairs">${countPairs(boxes)}</strong> pairs.</p>
    </three-structures>`;
  });
}
