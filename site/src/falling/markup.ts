// The inside of a `<falling-balls>`, written into the page when it is built: the page has its final
// shape before any script runs. `falling-balls.ts` finds the parts by their `data-part`.

import { expandPlayground } from "../playground/markup.ts";
import { expandRace } from "../race/markup.ts";
import { bruteForceTests, COUNTERS, formatCount } from "./counters.ts";
import { choice, slider, still } from "./parts.ts";

interface SimulationOptions {
  readonly id: string;
  readonly dimensions: 2 | 3;
  /** How many bodies it begins with. */
  readonly bodies: number;
}

/** Fills every empty `<falling-balls …></falling-balls>` of a page, and the race and the playground. */
export function expandFallingBalls(page: string): string {
  return expandPlayground(expandRace(page)).replace(/<falling-balls([^>]*)><\/falling-balls>/g, (_, attributes: string) => {
    const attribute = (name: string): string => {
      const value = new RegExp(`\\b${name}="([^"]*)"`).exec(attributes)?.[1];
      if (value === undefined) throw new Error(`<falling-balls${attributes}> has no ${name}`);
      return value;
    };
    const options: SimulationOptions = {
      id: attribute("id"),
      dimensions: attribute("dimensions") === "2" ? 2 : 3,
      bodies: Number(attribute("bodies")),
    };
    return `<falling-balls${attributes}>${inside(options)}</falling-balls>`;
  });
}

function inside({ id, dimensions, bodies }: SimulationOptions): string {
  return `
    <div class="panel" role="group" aria-labelledby="${id}-heading">
      <div class="panel-stage">
        ${dimensions === 2 ? discStage() : sphereStage()}
        ${still(dimensions === 2 ? "discs" : "spheres", `${dimensions === 2 ? "Discs of very different sizes" : "Ten thousand spheres"} that have fallen into a box`)}
        <p class="stage-message" data-part="message">Loading</p>
      </div>

      <div class="panel-transport">
        <button type="button" class="primary" data-part="play" disabled>Pause</button>
        <button type="button" data-part="step" disabled>Step</button>
        <button type="button" data-part="reset" disabled>Reset</button>
        <p class="moment" data-part="moment">Step 0</p>
        <p class="status" role="status" data-part="status"></p>
      </div>

      <div class="panel-side">
        <div class="panel-method">
          ${choice(id, "algorithm", "Algorithm")}
          ${choice(id, "sort", "Sort")}
          ${choice(id, "axis", "Sweep axis")}
        </div>
        <div class="panel-counters">
          ${counterList("work", "Work of one step", bodies)}
          ${counterList("time", "Time of one step", bodies)}
          <canvas class="panel-stages" data-part="stages" role="img" aria-label="Time per stage over the last pictures, stacked; the numbers are next to it"></canvas>
        </div>
      </div>

      <div class="panel-world">
        ${slider(id, "bodies", dimensions === 2 ? "Discs" : "Spheres", formatCount(bodies))}
        ${slider(id, "size", "Size", "100%")}
        ${slider(id, "spread", "Largest : smallest", "1 : 1")}
        <div class="field">
          <label for="${id}-seed">Seed</label>
          <input id="${id}-seed" data-part="seed" type="number" inputmode="numeric" min="0" max="4294967295" step="1" value="1" autocomplete="off" disabled />
        </div>
        ${slider(id, "gravity", "Gravity", "9.81 m/s²")}
        ${slider(id, "substeps", "Substeps", dimensions === 2 ? "8" : "4")}
        ${dimensions === 2 ? linesSwitch() : ""}
      </div>
    </div>`;
}

const discStage = (): string =>
  `<canvas data-part="canvas" role="img" aria-label="Discs falling into a box"></canvas>`;

const sphereStage = (): string =>
  `<div class="orbit" data-part="orbit" tabindex="0" role="application" aria-label="Spheres falling into a box. Arrow keys turn the view, plus and minus zoom.">
          <canvas data-part="canvas"></canvas>
        </div>`;

const linesSwitch = (): string =>
  `<label class="switch"><input type="checkbox" data-part="lines" autocomplete="off" disabled /> <span>Draw a line for each pair</span></label>`;

function counterList(group: "work" | "time", title: string, bodies: number): string {
  const rows = COUNTERS.filter((counter) => counter.group === group).map(
    ({ key, label, meaning }) =>
      `<div class="counter" data-counter="${key}"><dt title="${meaning}">${label}</dt><dd>${
        key === "brute-force" ? formatCount(bruteForceTests(bodies)) : "–"
      }</dd></div>`,
  );
  return `<section><h3 data-part="${group}-title">${title}</h3><dl>${rows.join("")}</dl></section>`;
}
