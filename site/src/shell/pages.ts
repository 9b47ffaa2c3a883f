// The frame of every page, written when the site is built: what stands in the head, the header with
// the navigation, the footer. A page is `<title>`, its own style and scripts, and `<main id="main">`.

import { existsSync, readdirSync, readFileSync } from "node:fs";
import { basename } from "node:path";
import type { IndexHtmlTransformContext, Plugin } from "vite";

/** The address of the published site: for the map of its pages and for previews of links. */
export const SITE = process.env["SITE_URL"] ?? "https://sweep-and-prune.github.io/sweep-and-prune/";
export const REPOSITORY = "https://github.com/sweep-and-prune/sweep-and-prune";

const here = new URL("./", import.meta.url);
const site = new URL("../../", here);

/** The pages of the navigation, in its order. */
const NAVIGATION: readonly (readonly [file: string, name: string])[] = [
  ["index.html", "Article"],
  ["playground.html", "Playground"],
  ["tasks.html", "Tasks"],
  ["benchmark.html", "Benchmark"],
  ["api.html", "API"],
];

/** The way to the guide, where it was built. */
const GUIDE = existsSync(new URL("public/api/python/guide.html", site)) ? ` There is a <a href="./api/python/guide.html">guide</a> for Python that begins with your problem.` : "";

/** What search engines need not know: the frame of an embedded demo, and old addresses that lead to the playground. */
const UNLISTED: readonly string[] = ["embed.html", "falling.html", "race.html"];

/** Asks for a frame without header and footer: a demo inside someone else's page. */
const BARE = '<main id="main" data-shell="bare">';

/** Every page there is: each html file of the site's folder. */
export function pages(): string[] {
  return readdirSync(site).filter((file) => file.endsWith(".html"));
}

export const shell: Plugin = {
  name: "shell",
  transformIndexHtml: { order: "pre", handler: frame },
  generateBundle() {
    const places = pages().filter((file) => !UNLISTED.includes(file)).map((file) => `<url><loc>${addressOf(file)}</loc></url>`);
    const source = `<?xml version="1.0" encoding="UTF-8"?>\n<urlset xmlns="http://www.sitemaps.org/schemas/sitemap/0.9">${places.join("")}</urlset>\n`;
    this.emitFile({ type: "asset", fileName: "sitemap.xml", source });
  },
};

const addressOf = (file: string): string => SITE + (file === "index.html" ? "" : file);

/** What a link to a page shows of it elsewhere. */
function preview(page: string, file: string): string {
  const title = /<title>([^<]*)<\/title>/.exec(page)?.[1] ?? "";
  const description = /name="description"\s+content="([^"]*)"/.exec(page)?.[1] ?? "";
  if (title === "" || description === "") throw new Error(`${file} has no title or no description`);
  if (UNLISTED.includes(file)) return `<meta name="robots" content="noindex" />`;
  return `
    <link rel="canonical" href="${addressOf(file)}" />
    <meta property="og:type" content="article" />
    <meta property="og:url" content="${addressOf(file)}" />
    <meta property="og:title" content="${title}" />
    <meta property="og:description" content="${description}" />
    <meta property="og:image" content="${SITE}preview.png" />
    <meta property="og:image:width" content="1200" />
    <meta property="og:image:height" content="630" />
    <meta property="og:image:alt" content="Moving boxes with a sweep line among them; those that overlap are filled" />
    <meta name="twitter:card" content="summary_large_image" />`;
}

/** A page in its frame. Its head is what its file has before `<main>`; what the visitor has chosen stands in the page itself, so the first picture already has the right colors. */
function frame(page: string, { filename }: IndexHtmlTransformContext): string {
  const file = basename(filename);
  const [head, main] = page.split(/(?=<main)/, 2) as [string, string];
  return `<!doctype html>
<html lang="en">
  <head>
    <meta charset="utf-8" />
    <meta name="viewport" content="width=device-width, initial-scale=1" />
    <link rel="icon" href="./icon.svg" type="image/svg+xml" />
    <link rel="stylesheet" href="./src/style.css" />
    <script>${readFileSync(new URL("theme-first.js", here), "utf8")}</script>
    <script type="module" src="./src/shell/shell.ts"></script>
    ${head}${preview(page, file)}
  </head>
  <body>${main.startsWith(BARE) ? main : `${header(file)}${main}${footer()}`}</body>
</html>`;
}

function header(file: string): string {
  const links = NAVIGATION.map(
    ([target, name]) => `<li><a href="./${target}"${target === file ? ' aria-current="page"' : ""}>${name}</a></li>`,
  );
  return `
    <a class="skip" href="#main">Skip to the content</a>
    <header class="site-header">
      <a class="wordmark" href="./index.html">Sweep and prune</a>
      <nav aria-label="Site"><ul>${links.join("")}</ul></nav>
      <label class="theme"><span class="visually-hidden">Light or dark</span>
        <select id="theme" autocomplete="off">
          <option value="auto">Auto</option>
          <option value="light">Light</option>
          <option value="dark">Dark</option>
        </select>
      </label>
    </header>`;
}

function footer(): string {
  return `
    <footer class="site-footer quiet">
      <p>
        Based on the article <cite>Sort, sweep, and prune</cite> by Lean and on the lesson about sweep and
        prune in Matthias Müller’s <cite>Ten Minute Physics</cite>. Free software under the MIT or Apache 2.0
        license, whichever you prefer: <a href="${REPOSITORY}">source code</a>,
        and <a href="${REPOSITORY}/blob/main/docs/testing.md">how it is tested</a>.${GUIDE} By the sweep-and-prune authors, 2026. These pages load nothing from other hosts, and those that you have
        visited work offline.
      </p>
    </footer>`;
}
