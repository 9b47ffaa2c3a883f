// The inside of `<race-track>`, written into the page when it is built: the page has its final shape
// before any script runs. `race-track.ts` finds the parts by their `data-part`.

import { choice, slider, still } from "../falling/parts.ts";
import { MEASURES } from "./record.ts";

/** How many algorithms can run side by side. */
export const LANES = 4;

/** The counters of a lane. */
export const LANE_COUNTERS = [
  { key: "ms", label: "Time", meaning: "from boxes to the list of all pairs; mean of the middle half of the last 60 steps" },
  { key: "tests", label: "Tests", meaning: "pairs of boxes handed to the box test in this step; 0 for a sweep on every axis, which checks flags instead" },
  { key: "axis-overlaps", label: "Axis overlaps", meaning: "pairs whose intervals overlap on the swept axis; for a sweep on every axis, summed over the axes" },
  { key: "comparisons", label: "Comparisons", meaning: "how often the sort compared two endpoints in this step" },
  { key: "swaps", label: "Swaps", meaning: "how often the sort swapped two endpoints in this step" },
  { key: "pairs", label: "Pairs", meaning: "pairs whose boxes overlap on every axis" },
] as const;

export function expandRace(page: string): string {
  return page.replace("<race-track></race-track>", () => `<race-track>${markup()}</race-track>`);
}

function markup(): string {
  return `
    <div class="race" role="group" aria-label="Race">
      <div class="race-stage">
        <canvas data-part="picture" role="img" aria-label="The boxes; those in a pair are highlighted"></canvas>
        ${still("race", "A thousand boxes; those that overlap another are highlighted")}
        <p class="stage-message" data-part="message">Loading</p>
      </div>
      <div class="race-plot">
        <canvas data-part="plot" role="img" aria-label="The cost of each algorithm, step by step; the numbers are below"></canvas>
        <div class="race-plot-choice">
          ${choice("race", "measure", "Plot", MEASURES.map(({ key, label }) => [key, label]))}
          <label class="switch"><input type="checkbox" data-part="log" autocomplete="off" disabled /> <span>Logarithmic</span></label>
        </div>
      </div>
      <div class="race-transport">
        <button type="button" class="primary" data-part="play" disabled>Pause</button>
        <button type="button" data-part="step" disabled>Step</button>
        <button type="button" data-part="reset" disabled>Reset</button>
        <p class="moment" data-part="moment">Step 0</p>
        <p class="verdict" data-part="verdict">&nbsp;</p>
        <p class="status" role="status" data-part="status"></p>
        <p class="alarm" role="alert" data-part="alarm"></p>
      </div>
      <div class="race-world">
        ${choice("race", "dimensions", "Dimensions", [["2", "2D"], ["3", "3D"]])}
        ${choice("race", "scene", "Scene")}
        ${choice("race", "motion", "Motion")}
        ${slider("race", "boxes", "Boxes", "1,000")}
        <div class="field">
          <label for="race-seed">Seed</label>
          <input id="race-seed" data-part="seed" type="number" inputmode="numeric" min="0" max="4294967295" step="1" value="1" autocomplete="off" disabled />
        </div>
      </div>
      <p class="race-about" data-part="about">&nbsp;</p>
      <div class="race-lanes">
        ${Array.from({ length: LANES }, (_, lane) => laneMarkup(lane + 1)).join("")}
      </div>
    </div>`;
}

function laneMarkup(lane: number): string {
  const rows = LANE_COUNTERS.map(
    ({ key, label, meaning }) =>
      `<div class="counter" data-counter="${key}"><dt title="${meaning}">${label}</dt><dd>–</dd></div>`,
  );
  return `
    <fieldset class="lane" data-lane="${lane}">
      <legend>Lane ${lane}</legend>
      ${choice(`lane-${lane}`, "algorithm", "Algorithm")}
      ${choice(`lane-${lane}`, "sort", "Sort")}
      ${choice(`lane-${lane}`, "axis", "Sweep axis")}
      <dl>${rows.join("")}</dl>
      <p class="lane-out" data-part="out"></p>
    </fieldset>`;
}
