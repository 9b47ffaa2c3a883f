// The inside of `<box-playground>`, written into the page when it is built. `box-playground.ts`
// finds the parts by their `data-part`.

import { choice, slider, still } from "../falling/parts.ts";

/** The counters. */
export const COUNTERS = [
  { key: "ms", label: "Time", meaning: "from boxes to the list of all pairs; mean of the middle half of the last 60 steps" },
  { key: "pairs", label: "Pairs", meaning: "pairs whose boxes overlap on every axis" },
  { key: "tests", label: "Tests", meaning: "pairs of boxes handed to the box test; 0 for a sweep on every axis, which checks flags instead" },
  { key: "axisOverlaps", label: "Axis overlaps", meaning: "pairs whose intervals overlap on the swept axis; for a sweep on every axis, summed over the axes" },
  { key: "comparisons", label: "Sort comparisons", meaning: "how often the sort compared two endpoints" },
  { key: "swaps", label: "Sort swaps", meaning: "how often the sort swapped two endpoints" },
] as const;

export function expandPlayground(page: string): string {
  return page.replace("<box-playground></box-playground>", () => `<box-playground>${markup()}</box-playground>`);
}

function markup(): string {
  const rows = COUNTERS.map(
    ({ key, label, meaning }) =>
      `<div class="counter" data-counter="${key}"><dt title="${meaning}">${label}</dt><dd>–</dd></div>`,
  );
  return `
    <div class="panel" role="group" aria-label="Playground">
      <div class="panel-stage">
        <div class="surface" data-part="surface" tabindex="0" role="application" aria-label="The boxes; those in a pair are highlighted. Arrow keys move the view, plus and minus zoom, zero shows everything. B selects the next box: then arrow keys move it, with shift they resize it, and Delete removes it. N adds a box.">
          <canvas data-part="picture"></canvas>
        </div>
        ${still("playground", "Five hundred boxes in clusters; those that overlap another are highlighted")}
        <p class="stage-message" data-part="message">Loading</p>
      </div>
      <div class="panel-transport">
        <button type="button" class="primary" data-part="play" disabled>Pause</button>
        <button type="button" data-part="step" disabled>Step</button>
        <button type="button" data-part="reset" disabled>Reset</button>
        <button type="button" data-part="fit" disabled>Show all</button>
        <p class="moment" data-part="moment">Step 0</p>
        <p class="status" role="status" data-part="status"></p>
      </div>
      <div class="panel-tools" role="group" aria-label="Change the boxes">
        <button type="button" data-part="draw" aria-pressed="false" disabled>Draw</button>
        <button type="button" data-part="add" disabled>Add a box</button>
        <button type="button" data-part="delete" disabled>Delete</button>
        <button type="button" data-part="undo" disabled>Undo</button>
        <button type="button" data-part="clear" disabled>Clear</button>
        <button type="button" data-part="import" disabled>Import a file</button>
        <input type="file" data-part="file" accept=".csv,.json,.txt,text/csv,application/json,text/plain" aria-label="A file with boxes" hidden />
        <p data-part="selected" role="status"></p>
        <p data-part="imported" role="status"></p>
        <p class="hint">Drag a box to move it, or choose <em>Draw</em> and drag where there is none. Files: CSV or JSON, by the button or dropped on the picture.</p>
        <details>
          <summary>Paste boxes as text</summary>
          <textarea data-part="pasted" rows="5" spellcheck="false" aria-label="Boxes as CSV or JSON" autocomplete="off">min_x,min_y,max_x,max_y
0,0,2,2
5,5,6,6
2,1,3,4</textarea>
          <button type="button" data-part="paste" disabled>Use these boxes</button>
        </details>
      </div>
      <div class="panel-side">
        <div class="panel-method">
          ${choice("playground", "algorithm", "Algorithm")}
          ${choice("playground", "sort", "Sort")}
          ${choice("playground", "axis", "Sweep axis")}
        </div>
        <section><h2 class="small">This step</h2><dl>${rows.join("")}</dl></section>
        <p class="about" data-part="about">&nbsp;</p>
      </div>
      <div class="panel-world">
        ${choice("playground", "scene", "Scene")}
        ${choice("playground", "motion", "Motion")}
        ${choice("playground", "dimensions", "Dimensions", [["2", "2D"], ["3", "3D, viewed along z"]])}
        <div class="field">
          <label for="playground-seed">Seed</label>
          <input id="playground-seed" data-part="seed" type="number" inputmode="numeric" min="0" max="4294967295" step="1" value="1" autocomplete="off" disabled />
        </div>
        ${slider("playground", "boxes", "Boxes", "500")}
        ${slider("playground", "size", "Size", "× 1")}
        ${slider("playground", "spread", "Largest : smallest", "1 : 1")}
      </div>
    </div>
    <section class="export" aria-labelledby="export-heading">
      <h2 id="export-heading">Export these boxes</h2>
      <p>
        The boxes of the step that is shown, with exact coordinates, and the call that finds their pairs. Copying
        pauses the world, and the address leads back to the same step.
      </p>
      <div class="export-choice">
        ${choice("playground", "format", "As", [["js", "JavaScript"], ["rs", "Rust"], ["py", "Python"], ["json", "JSON"], ["csv", "CSV"]])}
        <button type="button" data-part="copy" disabled>Copy</button>
        <button type="button" data-part="download" disabled>Download</button>
        <button type="button" data-part="share" disabled>Copy the address</button>
        <p role="status" data-part="exported"></p>
      </div>
      <pre tabindex="0" aria-label="Preview of the export: its beginning and its end"><code data-part="preview"> </code></pre>
    </section>`;
}
