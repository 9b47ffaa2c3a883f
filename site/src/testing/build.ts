// The page on tests: docs/testing.md, with the tables of fuzz/TOTALS.md where it asks for them. Written when the site is
// built, so that neither is copied by hand.

import { existsSync, readFileSync } from "node:fs";
import { Marked } from "marked";
import { REPOSITORY } from "../shell/pages.ts";

const root = new URL("../../../", import.meta.url);
const read = (path: string): string => readFileSync(new URL(path, root), "utf8");

/** Where the totals stand, in docs/testing.md. */
const TOTALS = "<!-- on the site, fuzz/TOTALS.md stands here -->";

/** Puts the text where the page asks for it. */
export function insertTesting(page: string): string {
  return page.replace("<testing-text></testing-text>", text);
}

function text(): string {
  const testing = read("docs/testing.md");
  if (!testing.includes(TOTALS)) throw new Error(`docs/testing.md lacks ${TOTALS}`);
  // Without their title, and one level below the heading that they stand under.
  const totals = read("fuzz/TOTALS.md").replace(/^# .*\n/, "").replace(/^#/gm, "##");
  const marked = new Marked({
    renderer: {
      /** A file of the repository is a link to it. */
      codespan({ text }) {
        const code = `<code>${text.replaceAll("&", "&amp;").replaceAll("<", "&lt;")}</code>`;
        const isFile = /^\w[\w.-]*\/\S*$/.test(text) && existsSync(new URL(text, root));
        return isFile ? `<a href="${REPOSITORY}/blob/main/${text}">${code}</a>` : code;
      },
    },
    // A wide table scrolls by itself, and is named by the heading above it.
    hooks: {
      postprocess: (html) =>
        html.replace(/<h(\d)>(.*?)<\/h\1>|<table>|<\/table>|<th>/g, (tag, depth?: string, title?: string) => {
          if (depth) heading = title!.replace(/<[^>]*>/g, "");
          if (tag === "<table>") return `<div class="table-scroll" tabindex="0" role="region" aria-label="${heading}, table ${(tables += 1)}"><table>`;
          if (tag === "</table>") return "</table></div>";
          return tag === "<th>" ? `<th scope="col">` : tag;
        }),
    },
  });
  let [heading, tables] = ["", 0];
  return marked.parse(testing.replace(TOTALS, totals), { async: false });
}
