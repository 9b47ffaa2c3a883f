// The complexity table, written into the page when it is built, from the results that
// `cargo run --release -p sweep-and-prune-complexity` keeps in docs/.

import complexity from "../../../docs/complexity.json" with { type: "json" };

type Variant = (typeof complexity.variants)[number];
type Case = "best" | "average" | "worst";

const CASES: readonly Case[] = ["best", "average", "worst"];
const PLACE = "<complexity-table></complexity-table>";

/** Puts the table where the page asks for it. */
export function insertComplexity(page: string): string {
  return page.replace(PLACE, table);
}

function table(): string {
  return `
    <div class="table-scroll formulas" tabindex="0" role="region" aria-label="The complexity table">
      <table>
        <thead>
          <tr><th scope="col">Algorithm</th>${CASES.map((name) => `<th scope="col">${capital(name)}</th>`).join("")}<th scope="col">Space</th></tr>
        </thead>
        <tbody>${complexity.variants.map(row).join("")}</tbody>
      </table>
    </div>`;
}

function row(variant: Variant): string {
  const sort = variant.sort ? `<small>${variant.sort}</small>` : "";
  return `
    <tr>
      <th scope="row">${capital(variant.method)}${sort}</th>
      ${CASES.map((name) => `<td>${variant[name]}<small>${measured(variant, name)}</small></td>`).join("")}
      <td>${variant.space}</td>
    </tr>`;
}

/**
 * The measured growth in each of the case's worlds, such as n^1.12, n^1.46. A world in which only
 * one part of the algorithm is at its worst makes another claim, and is not shown.
 */
function measured(variant: Variant, name: Case): string {
  const worlds = variant.rows.filter((found) => found.case === name && found.claim.startsWith(variant[name]));
  const slopes = worlds.map((found) => found.slope.toFixed(2));
  return [...new Set(slopes)].map((slope) => `n<sup>${slope}</sup>`).join(", ");
}

function capital(text: string): string {
  return text[0]?.toUpperCase() + text.slice(1);
}
