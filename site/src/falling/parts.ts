// Parts that more than one page is made of, as they are written when the site is built.

/** A choice with a label; its options, value and text, may come later by script. */
export const choice = (
  id: string,
  part: string,
  label: string,
  options: readonly (readonly [value: string, text: string])[] = [],
): string =>
  `<div class="field">
          <label for="${id}-${part}">${label}</label>
          <select id="${id}-${part}" data-part="${part}" autocomplete="off" disabled>${options
            .map(([value, text]) => `<option value="${value}">${text}</option>`)
            .join("")}</select>
        </div>`;

/** A slider with its value as text. */
export const slider = (id: string, part: string, label: string, value: string): string =>
  `<div class="field">
          <label for="${id}-${part}">${label}</label>
          <span class="value" data-part="${part}-value" aria-hidden="true">${value}</span>
          <input id="${id}-${part}" data-part="${part}" type="range" autocomplete="off" disabled />
        </div>`;

/** A picture of what would move, where no scripts run; scripts/preview.mjs draws it. */
export const still = (name: string, says: string): string =>
  `<noscript><img class="still" src="./still/${name}.jpg" alt="${says}" loading="lazy" /></noscript>`;
