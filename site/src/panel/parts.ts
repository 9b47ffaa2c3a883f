// Parts that more than one page is made of, as they are written when the site is built.

/** The largest seed of a world. */
export const LARGEST_SEED = 2 ** 32 - 1;

/** A control with its label: the tag that `begin` begins gets what all have, and `end` ends it. */
const field = (id: string, part: string, label: string, begin: string, end = "/>"): string =>
  `<div class="field">
          <label for="${id}-${part}">${label}</label>
          ${begin} id="${id}-${part}" data-part="${part}" autocomplete="off" disabled ${end}
        </div>`;

/** A choice; its options, value and text, may come later by script. */
export const choice = (id: string, part: string, label: string, options: readonly (readonly [value: string, text: string])[] = []): string =>
  field(id, part, label, "<select", `>${options.map(([value, text]) => `<option value="${value}">${text}</option>`).join("")}</select>`);

/** A slider with its value as text. */
export const slider = (id: string, part: string, label: string, value: string): string =>
  field(id, part, label, `<span class="value" data-part="${part}-value" aria-hidden="true">${value}</span><input type="range"`);

/** The number that makes one world of many. */
export const seedField = (id: string): string =>
  field(id, "seed", "Seed", `<input type="number" inputmode="numeric" min="0" max="${LARGEST_SEED}" step="1" value="1"`);

/** Play, Step, Reset, and what goes on in words. */
export const transport = (more: string): string =>
  `<div class="panel-transport row">
        <button type="button" class="primary" data-part="play" disabled>Pause</button>
        <button type="button" data-part="step" disabled>Step</button>
        <button type="button" data-part="reset" disabled>Reset</button>
        ${more}
        <p class="moment" data-part="moment">Step 0</p>
        <p class="status" role="status" data-part="status"></p>
      </div>`;

/** A picture of what would move, where no scripts run; scripts/preview.mjs draws it. */
export const still = (name: string, says: string): string =>
  `<noscript><img class="still" src="./still/${name}.jpg" alt="${says}" loading="lazy" /></noscript>`;
