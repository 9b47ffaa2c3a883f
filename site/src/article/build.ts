// Assembles the article when the site is built: its sections, contents, reading time, listings,
// legends, drawings and posters of the demos. All of it is in the page that is sent, so it can be read without scripts.

import { readFileSync } from "node:fs";
import { figures } from "./figures/index.ts";
import { legend } from "./legend.ts";
import { highlight, listing } from "../code/listing.ts";
import { below, codesIn } from "../code/readme.ts";
import { poster } from "./poster.ts";
import { spaceTime } from "./space-time.ts";
import { complexityTables } from "../complexity/table.ts";
import { inside as fastSweep } from "../lanes/picture.ts";
import { threeStructures } from "../structures/build.ts";
import { SITE } from "../shell/pages.ts";
import type { Tags } from "../shell/tags.ts";

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

export const articleTags: Tags = {
  "article-sections": () => SECTIONS.map((name) => section(name).html).join("\n"),
  "article-contents": () => `<ol>${SECTIONS.map((name) => `<li><a href="#${name}">${section(name).title}</a></li>`).join("")}</ol>`,
  "reading-time": () => `${Math.round(words(SECTIONS.map((name) => section(name).html).join(" ")) / WORDS_A_MINUTE)} minutes to read, longer if you play`,
  "sap-demo": ({ legend: names, ...attributes }, text) => `<sap-demo${text.replace(/ legend="[^"]*"/, "")}>${poster(attributes)}</sap-demo>${names ? legend(names) : ""}`,
  "code-listing": ({ name = "", follows }) => listing(name, follows),
  "color-key": ({ shows = "" }) => legend(shows),
  "drawn-figure": ({ name = "" }) => {
    const draw = figures[name];
    if (!draw) throw new Error(`there is no figure "${name}"`);
    return draw();
  },
  "space-time": () => `<space-time>${spaceTime()}</space-time>`,
  "fast-sweep": () => `<fast-sweep>${fastSweep(readFileSync(COLUMNS, "utf8"))}</fast-sweep>`,
  "complexity-table": complexityTables,
  "three-structures": threeStructures,
  "trial-code": () => highlight(codesIn(below("js/README.md", "Example"))[0]!.text, "js", "how to call the library"),
  "site-address": () => SITE,
};

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

function words(html: string): number {
  return html.replace(/<[^>]*>/g, " ").split(/\s+/).filter(Boolean).length;
}
