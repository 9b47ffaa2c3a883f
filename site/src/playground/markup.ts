// The inside of `<box-playground>`, written into the page when it is built. `box-playground.ts`
// finds the parts by their `data-part`.

import type { Report } from "../experiment/experiment.ts";
import { MEASURES } from "../experiment/record.ts";
import { FALLING } from "../experiment/scene.ts";
import { type Counter, counterRows, WORK } from "../panel/counters.ts";
import { choice, seedField, slider, still, transport } from "../panel/parts.ts";
import type { Tags } from "../shell/tags.ts";

interface Shown extends Report {
  /** The mean of the last steps. */
  readonly level: number | null;
}

export const COUNTERS: readonly Counter<Shown>[] = [
  {
    key: "ms",
    label: "Time",
    meaning: "from boxes to the list of all pairs; mean of the middle half of the last 60 steps",
    read: ({ level }) => (level === null ? null : `${level.toFixed(level < 100 ? 2 : 0)} ms`),
  },
  ...WORK,
];

/** Ten thousand spheres: one click away. */
const SPHERES = "./playground.html?scene=falling+balls&amp;dimensions=3&amp;boxes=10000&amp;algorithm=find+pairs";

export const playgroundTags: Tags = { "box-playground": ({ compact, scene }, text) => `<box-playground${text}>${markup(compact !== undefined, scene === FALLING)}</box-playground>` };

function markup(isCompact: boolean, isFalling: boolean): string {
  return `
    <div class="panel" role="group" aria-label="Playground">
      <div class="panel-stage">
        <div class="surface" data-part="surface" tabindex="0" role="application" aria-label="The boxes; those in a pair are highlighted. Arrow keys move the view, plus and minus zoom, zero shows everything. B selects the next box: then arrow keys move it, with shift they resize it, and Delete removes it. N adds a box.">
          <canvas data-part="picture"></canvas>
        </div>
        <div class="orbit" data-part="orbit" hidden></div>
        ${isCompact ? still("discs", "Discs of very different sizes that have fallen into a box") : still("playground", "Five hundred boxes in clusters; those that overlap another are highlighted")}
        <p class="stage-message quiet" data-part="message">Loading</p>
      </div>
      <div class="panel-plot">
        <canvas data-part="lines" role="img" aria-label="The cost of each search, step by step; the numbers are below"></canvas>
        <div class="plot-choice">
          ${choice("playground", "plot", "Plot", MEASURES.map(({ key, label }) => [key, label]))}
          <label class="switch"><input type="checkbox" data-part="log" autocomplete="off" disabled /> <span>Logarithmic</span></label>
        </div>
        <p class="verdict" data-part="verdict"></p>
      </div>
      ${transport(`<button type="button" data-part="fit" ${isFalling ? "hidden " : ""}disabled>Show all</button>
        <label class="switch" data-part="links"${isFalling ? "" : " hidden"}><input type="checkbox" autocomplete="off" disabled /> <span>Pair lines</span></label>`)}
      <div class="panel-lanes row">
        <div class="lanes" data-part="lanes">${laneMarkup(1)}</div>
        <p class="alarm" role="alert" data-part="alarm"></p>
        <button type="button" data-part="add-algorithm" disabled>Add an algorithm</button>
        <a class="button" href="${SPHERES}">10,000 spheres in 3D</a>
      </div>
      <div class="panel-tools row" role="group" aria-label="Change the boxes">
        <button type="button" data-part="draw" aria-pressed="false" disabled>Draw</button>
        <button type="button" data-part="add" disabled>Add a box</button>
        <button type="button" data-part="delete" disabled>Delete</button>
        <button type="button" data-part="undo" disabled>Undo</button>
        <button type="button" data-part="clear" disabled>Clear</button>
        <button type="button" data-part="import" disabled>Import a file</button>
        <input type="file" data-part="file" accept=".csv,.json,.txt,text/csv,application/json,text/plain" aria-label="A file with boxes" hidden />
        <p data-part="selected" role="status"></p>
        <p data-part="imported" role="status"></p>
        <p class="hint">
          <span data-part="hands-hint">Boxes of <span class="is-overlap">this color</span> overlap another. Drag a box to move it, or choose <em>Draw</em> and drag where there is none.</span>
          <span data-part="balls-hint" hidden>Balls fall by themselves. <em>Draw</em> and <em>Add a box</em> make their boxes yours: they no longer fall, and you can drag them.</span>
          Files: CSV or JSON, by the button or dropped on the picture.
        </p>
        <details>
          <summary>Paste boxes as text</summary>
          <textarea data-part="pasted" rows="5" spellcheck="false" aria-label="Boxes as CSV or JSON" autocomplete="off">min_x,min_y,max_x,max_y
0,0,2,2
5,5,6,6
2,1,3,4</textarea>
          <button type="button" data-part="paste" disabled>Use these boxes</button>
        </details>
      </div>
      <div class="panel-world">
        ${choice("playground", "scene", "Scene")}
        ${choice("playground", "motion", "Motion")}
        ${choice("playground", "dimensions", "Dimensions", [["2", "2D"], ["3", "3D, viewed along z"]])}
        ${seedField("playground")}
        ${slider("playground", "boxes", "Boxes", "500")}
        ${slider("playground", "size", "Size", "× 1")}
        ${slider("playground", "spread", "Size ratio", "1 : 1")}
        <p class="about" data-part="about">&nbsp;</p>
      </div>
    </div>
    <section class="export" aria-labelledby="export-heading">
      <${isCompact ? "h4" : "h2"} id="export-heading">Export these boxes</${isCompact ? "h4" : "h2"}>
      <p>
        The boxes of the step that is shown, with exact coordinates, and the call that finds their pairs. Copying
        pauses the world, and the address leads back to the same step.
      </p>
      <div class="export-choice row">
        ${choice("playground", "format", "As", [["js", "JavaScript"], ["rs", "Rust"], ["py", "Python"], ["json", "JSON"], ["csv", "CSV"]])}
        <button type="button" data-part="copy" disabled>Copy</button>
        <button type="button" data-part="download" disabled>Download</button>
        <button type="button" data-part="share" disabled>Copy the address</button>
        <p role="status" data-part="exported"></p>
      </div>
      <pre tabindex="0" aria-label="Preview of the export: its beginning and its end"><code data-part="preview"> </code></pre>
    </section>`;
}

/** One algorithm: its choices, its counters, and how to leave it out if it is not the only one. */
export const laneMarkup = (lane: number): string => `
    <fieldset class="lane" data-lane="${lane}" style="border-color: var(--lane-${lane})">
      <legend>Algorithm ${lane}${lane > 1 ? ` <button type="button" aria-label="Remove algorithm ${lane}">Remove</button>` : ""}</legend>
      ${choice(`lane-${lane}`, "algorithm", "Algorithm")}
      ${choice(`lane-${lane}`, "sort", "Sort")}
      ${choice(`lane-${lane}`, "axis", "Sweep axis")}
      <dl>${counterRows(COUNTERS)}</dl>
      <p class="lane-out"></p>
    </fieldset>`;
