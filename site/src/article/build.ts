// Assembles the article when the site is built: its sections, contents, reading time, listings,
// legends, drawings and posters of the demos. All of it is in the page that is sent, so it can be read without scripts.

import { readFileSync } from "node:fs";
import type { Plugin } from "vite";
import { figures } from "./figures/index.ts";
import { legend } from "./legend.ts";
import { highlight, listing } from "../code/listing.ts";
import { below, codesIn } from "../code/readme.ts";
import { withPosters } from "./poster.ts";
import { spaceTime } from "./space-time.ts";
import { complexityTables } from "../complexity/table.ts";
import { inside as fastSweep } from "../lanes/picture.ts";
import { expandStructures } from "../structures/build.ts";
import { SITE } from "../shell/pages.ts";

/** The files of sections/, in the order in which they are read. */
const SECTIONS = [
  "naive",
  "boxes",
  "transitivity",
  "sorted-pairwise",
  "endpoints",
  "sweep",
  "pruning",
  "sorting",
  "swaps",
  "axis",
  "falling",
  "cost",
  "beyond",
  "practice",
  "reading",
] as const;

const WORDS_A_MINUTE = 200;

/** The columns of a real search of the library. */
const COLUMNS = new URL("../../../core/src/pairs/columns.txt", import.meta.url);

export const article: Plugin = {
  name: "article",
  transformIndexHtml: { order: "pre", handler: (page) => (page.includes("<article-sections>") ? assemble(page) : page) },
};

function assemble(page: string): string {
  const sections = SECTIONS.map((name) => section(name));
  const minutes = Math.round(words(sections.map(({ html }) => html).join(" ")) / WORDS_A_MINUTE);
  const contents = sections.map(({ name, title }) => `<li><a href="#${name}">${title}</a></li>`).join("");
  const whole = page
    .replace("<article-sections></article-sections>", () => sections.map(({ html }) => html).join("\n"))
    .replace("<article-contents></article-contents>", () => `<ol>${contents}</ol>`)
    .replace("<reading-time></reading-time>", () => `${minutes} minutes to read, longer if you play`);
  return expand(whole);
}

/** One section: its file begins with its heading. */
function section(name: string): { name: string; title: string; html: string } {
  const text = readFileSync(new URL(`./sections/${name}.html`, import.meta.url), "utf8");
  const title = /^<h2>(.*?)<\/h2>/.exec(text)?.[1];
  if (title === undefined) throw new Error(`sections/${name}.html does not begin with its <h2>`);
  const anchor = `<a class="anchor" href="#${name}" aria-label="Link to: ${title}">#</a>`;
  const body = text.slice(text.indexOf("</h2>") + 5);
  const html = `<section id="${name}" aria-labelledby="${name}-heading">
    <h2 id="${name}-heading">${title}${anchor}</h2>${body}</section>`;
  return { name, title, html };
}

/** Fills in the listings, legends and drawings. */
function expand(page: string): string {
  return expandStructures(withPosters(withLegends(page)))
    .replace("<space-time></space-time>", () => `<space-time>${spaceTime()}</space-time>`)
    .replace("<fast-sweep></fast-sweep>", () => `<fast-sweep>${fastSweep(readFileSync(COLUMNS, "utf8"))}</fast-sweep>`)
    .replace("<complexity-table></complexity-table>", complexityTables)
    .replaceAll("%SITE%", SITE)
    .replace("<trial-code></trial-code>", () => highlight(codesIn(below("js/README.md", "Example"))[0]!.text, "js", "how to call the library"))
    .replace(/<code-listing name="([^"]*)"(?: follows="([^"]*)")?><\/code-listing>/g, (_, name: string, follows?: string) =>
      listing(name, follows),
    )
    .replace(/<color-key shows="([^"]*)"><\/color-key>/g, (_, names: string) => legend(names))
    .replace(/<drawn-figure name="([^"]*)"><\/drawn-figure>/g, (_, name: string) => {
      const draw = figures[name];
      if (!draw) throw new Error(`there is no figure "${name}"`);
      return draw();
    });
}

/** Below each demo, what its colors mean: those that its `legend` names. */
const withLegends = (page: string): string =>
  page.replace(/(<sap-demo[^>]*) legend="([^"]*)"(.*?<\/sap-demo>)/g, (_, demo: string, names: string, rest: string) => `${demo}${rest}${legend(names)}`);

function words(html: string): number {
  return html.replace(/<[^>]*>/g, " ").split(/\s+/).filter(Boolean).length;
}
