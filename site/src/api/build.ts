// The API page: highlighted examples, and links to the documentation of each language if it was built.

import { existsSync, readFileSync } from "node:fs";
import type { Plugin } from "vite";
import { highlight, type Language } from "../code/listing.ts";

const EXAMPLES = {
  rust: {
    language: "rust",
    code: `use sweep_and_prune::{Aabb, find_pairs};

let boxes = [
    Aabb::new([0.0, 0.0], [2.0, 2.0]),
    Aabb::new([5.0, 5.0], [6.0, 6.0]),
    Aabb::new([2.0, 1.0], [3.0, 4.0]), // touches the first box
];
assert_eq!(find_pairs(&boxes)?, [[0, 2]]);`,
  },
  js: {
    language: "javascript",
    code: `import { init, findPairs } from "sweep-and-prune";

await init(); // once
const boxes = new Float32Array([
  0, 0, 2, 2, // minX, minY, maxX, maxY
  5, 5, 6, 6,
  2, 1, 3, 4, // touches the first box
]);
findPairs(boxes, { dimensions: 2 }); // Uint32Array [0, 2]`,
  },
  python: {
    language: "python",
    code: `import numpy as np
import sweep_and_prune as sap

boxes = np.array([
    [0, 0, 2, 2],  # min x, min y, max x, max y
    [5, 5, 6, 6],
    [2, 1, 3, 4],  # touches the first box
], dtype=np.float32)
sap.find_pairs(boxes)  # array([[0, 2]])`,
  },
} as const;

/** What to type in a terminal. */
const INSTALLATION: Readonly<Record<keyof typeof EXAMPLES, readonly (readonly [says: string, line: string])[]>> = {
  rust: [["Install with cargo", "cargo add sweep-and-prune"]],
  js: [["Install with npm", "npm install sweep-and-prune"]],
  python: [["Install with pip", "pip install sweep-and-prune"]],
};

/** Code with a button that copies it. */
const copyable = (code: string, what: string): string =>
  `<div class="listing">${code}<button type="button" class="small" data-part="copy" aria-label="Copy ${what}">Copy</button></div>`;

/** What stands below a heading of a document of this repository: its lines, up to the next heading. */
function below(file: string, heading: string): string[] {
  const lines = readFileSync(new URL(`../../../${file}`, import.meta.url), "utf8").split("\n");
  const at = lines.findIndex((line) => line === `## ${heading}` || line === `# ${heading}`);
  if (at < 0) throw new Error(`${file} has no heading "${heading}"`);
  const end = lines.findIndex((line, place) => place > at && line.startsWith("## "));
  return lines.slice(at + 1, end < 0 ? undefined : end);
}

/** The first code below a heading, without the lines that documentation of Rust hides. */
function codeBelow(file: string, heading: string): string {
  const lines = below(file, heading);
  const begin = lines.findIndex((line) => line.startsWith("```"));
  const language = lines[begin]!.slice(3) as Language;
  const shown = lines.slice(begin + 1, lines.indexOf("```", begin + 1)).filter((line) => language !== "rust" || !line.startsWith("# "));
  return copyable(highlight(shown.join("\n"), language, `sweep-and-prune: ${heading}`), "the example");
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

export const api: Plugin = {
  name: "api",
  transformIndexHtml: {
    order: "pre",
    handler: (page) =>
      page
        .replace(/<api-example name="(rust|js|python)"><\/api-example>/g, (_, name: keyof typeof EXAMPLES) => {
          const { language, code } = EXAMPLES[name];
          const example = copyable(highlight(code, language, `an example in ${language}`), "the example");
          return `<div class="examples">${INSTALLATION[name].map(([says, line]) => `<p>${says}</p>${copyable(highlight(line, "shell", `installation for ${says}`), line)}`).join("")}<p>Find pairs</p>${example}</div>`;
        })
        .replace(/<guide-code file="([^"]*)" heading="([^"]*)"><\/guide-code>/g, (_, file: string, heading: string) => codeBelow(file, heading))
        .replace(/<guide-table file="([^"]*)" heading="([^"]*)"><\/guide-table>/g, (_, file: string, heading: string) => tableBelow(file, heading))
        .replace(/<api-link name="(rust|js|python|guide)">(.*?)<\/api-link>/g, (_, name: keyof typeof DOCUMENTATION, text: string) => {
          const path = DOCUMENTATION[name];
          const exists = existsSync(new URL(`../../public/${path}`, import.meta.url));
          return exists ? `<p><a href="./${path}">${text}</a></p>` : "";
        }),
  },
};
