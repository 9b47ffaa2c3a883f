// The complexity table, written into the page when it is built, from the results that
// `cargo run --release -p sweep-and-prune-complexity` keeps in docs/.

import complexity from "../../../docs/complexity.json" with { type: "json" };

type Variant = (typeof complexity.variants)[number];
type Case = "best" | "average" | "worst";

const CASES: readonly Case[] = ["best", "average", "worst"];

/** The rows that are shown at once, in the order of the article. The others are folded away. */
const SHOWN: readonly (readonly [method: string, sort: string | null])[] = [
  ["global pairwise", null],
  ["sorted pairwise", "quicksort"],
  ["sorted pairwise", "insertion sort"],
  ["endpoint sweep", "quicksort"],
  ["endpoint sweep", "insertion sort"],
  ["swap-driven sweep", null],
];

/** Six algorithms in a table, and the others folded away. */
export function complexityTables(): string {
  const shown = SHOWN.map(([method, sort]) => {
    const found = complexity.variants.find((variant) => variant.method === method && variant.sort === sort);
    if (!found) throw new Error(`docs/complexity.json has no ${method} with ${sort}`);
    return found;
  });
  const others = complexity.variants.filter((variant) => !shown.includes(variant));
  return `${table("Cost of six algorithms", shown)}
    <details class="more">
      <summary>The other ${others.length}: more sorts, and sweeps on every axis</summary>
      <p><i>M</i> and <i>S</i> are like <i>m</i> and <i>s</i>, summed over all axes; <i>p</i> counts the pairs that overlap on every axis.</p>
      ${table("Cost of the other algorithms", others)}
    </details>`;
}

function table(label: string, variants: readonly Variant[]): string {
  return `
    <div class="table-scroll formulas" tabindex="0" role="region" aria-label="${label}">
      <table>
        <thead>
          <tr><th scope="col">Algorithm</th>${CASES.map((name) => `<th scope="col">${capital(name)}</th>`).join("")}<th scope="col">Space</th></tr>
        </thead>
        <tbody>${variants.map(row).join("")}</tbody>
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
