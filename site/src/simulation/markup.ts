// The inside of a `<falling-balls>`, written into the page when it is built: the page has its final
// shape before any script runs. `falling-balls.ts` finds the parts by their `data-part`.

import { bruteForceTests, counterRows, formatCount } from "../panel/counters.ts";
import { choice, seedField, slider, still, transport } from "../panel/parts.ts";
import { TIME_COUNTERS, WORK_COUNTERS } from "./counters.ts";

/** Fills every empty `<falling-balls …></falling-balls>` of a page. */
export function expandFallingBalls(page: string): string {
  return page.replace(/<falling-balls([^>]*)><\/falling-balls>/g, (_, attributes: string) => {
    const attribute = (name: string): string => {
      const value = new RegExp(`\\b${name}="([^"]*)"`).exec(attributes)?.[1];
      if (value === undefined) throw new Error(`<falling-balls${attributes}> has no ${name}`);
      return value;
    };
    return `<falling-balls${attributes}>${inside(attribute("id"), Number(attribute("bodies")))}</falling-balls>`;
  });
}

function inside(id: string, bodies: number): string {
  return `
    <div class="panel" role="group" aria-labelledby="${id}-heading">
      <div class="panel-stage">
        <canvas data-part="canvas" role="img" aria-label="Discs falling into a box"></canvas>
        ${still("discs", "Discs of very different sizes that have fallen into a box")}
        <p class="stage-message" data-part="message">Loading</p>
      </div>

      ${transport()}

      <div class="panel-side">
        <div class="panel-method">
          ${choice(id, "algorithm", "Algorithm")}
          ${choice(id, "sort", "Sort")}
          ${choice(id, "axis", "Sweep axis")}
        </div>
        <div class="panel-counters">
          <section><h3>Work of one step</h3><dl>${counterRows(WORK_COUNTERS, (key) => (key === "brute-force" ? formatCount(bruteForceTests(bodies)) : "–"))}</dl></section>
          <section><h3>Time of one step</h3><dl>${counterRows(TIME_COUNTERS)}</dl></section>
          <canvas class="panel-stages" data-part="stages" role="img" aria-label="Time per stage over the last pictures, stacked; the numbers are next to it"></canvas>
        </div>
      </div>

      <div class="panel-world">
        ${slider(id, "bodies", "Discs", formatCount(bodies))}
        ${slider(id, "size", "Size", "100%")}
        ${slider(id, "spread", "Size ratio", "1 : 1")}
        ${seedField(id)}
        ${slider(id, "gravity", "Gravity", "9.81 m/s²")}
        ${slider(id, "substeps", "Substeps", "8")}
        <label class="switch"><input type="checkbox" data-part="lines" autocomplete="off" disabled /> <span>Draw a line for each pair</span></label>
      </div>
    </div>`;
}
