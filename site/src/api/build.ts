// The API page: highlighted examples, and links to the documentation of each language if it was built.

import { existsSync } from "node:fs";
import { COPY, highlight } from "../code/listing.ts";
import { below, type Code, codesIn } from "../code/readme.ts";
import { REPOSITORY } from "../shell/pages.ts";
import type { Tags } from "../shell/tags.ts";

/** Whose README begins with how to install it, and with an example. */
const PACKAGES = { rust: "core/README.md", js: "js/README.md", python: "python/README.md" } as const;

/** Code below a caption, with a button that copies it. */
const listing = ({ text, language }: Code, caption: string, label: string, what = "the example"): string =>
  `<figure class="listing"><figcaption class="row"><span>${caption}</span>${COPY.replace(">", ` aria-label="Copy ${what}">`)}</figcaption>${highlight(text, language, label)}</figure>`;

/** How to install a package and how to use it, as its README begins. */
function beginning(file: string): string {
  const [installation, example] = codesIn(below(file)) as [Code, Code];
  return `<div class="examples">${listing(installation, "Install", `installation by ${installation.text}`, installation.text)}${listing(example, "Find pairs", `an example in ${example.language}`)}</div>`;
}

/** What the README of the repository says about whether the packages can be installed by name; nothing once they can. */
function availability(): string {
  const says = below("README.md", "Install").filter((line) => line.startsWith("Version ")).join(" ");
  return says.replace(/\[(.*?)\]\((#.*?)\)/, `<a href="${REPOSITORY}$2">$1</a>`);
}

/** The table below a heading, whose cells are code. */
function tableBelow(file: string, heading: string): string {
  const [head = [], , ...rows] = below(file, heading).filter((line) => line.startsWith("|")).map((line) => line.slice(1, -1).split("|").map((cell) => cell.trim()));
  const cell = (text: string): string => text.replaceAll("<", "&lt;").replace(/`([^`]*)`/g, "<code>$1</code>");
  return `<div class="table-scroll" tabindex="0" role="region" aria-label="${heading} and sap">
        <table><thead><tr>${head.map((text) => `<th scope="col">${cell(text)}</th>`).join("")}</tr></thead>
        <tbody>${rows.map((row) => `<tr>${row.map((text) => `<td>${cell(text)}</td>`).join("")}</tr>`).join("")}</tbody></table></div>`;
}

/** The first page of each language’s documentation, below public/. */
const DOCUMENTATION = {
  rust: "api/rust/sweep_and_prune/index.html",
  js: "api/js/index.html",
  python: "api/python/sweep_and_prune.html",
  guide: "api/python/guide.html",
} as const;

export const apiTags: Tags = {
  "api-availability": availability,
  "api-example": ({ name }) => beginning(PACKAGES[name as keyof typeof PACKAGES]),
  "guide-code": ({ file = "", heading = "" }) => listing(codesIn(below(file, heading))[0]!, heading, `sweep-and-prune: ${heading}`),
  "guide-table": ({ file = "", heading = "" }) => tableBelow(file, heading),
  "api-link": ({ name, says }) => {
    const path = DOCUMENTATION[name as keyof typeof DOCUMENTATION];
    const exists = existsSync(new URL(`../../public/${path}`, import.meta.url));
    return exists ? `<p><a href="./${path}">${says}</a></p>` : "";
  },
};
