// A listing of the article: a module of src/listings as text, highlighted when the site is built.
// Tags at the end of a line (`// @test`) are not shown. They say what the line does, so that the page
// can highlight it while a demo does the same; `@added` marks a line that the listing before it lacks.

import { readFileSync } from "node:fs";
import { createCssVariablesTheme, createHighlighter, type ShikiTransformer } from "shiki";

const LANGUAGES = ["javascript", "rust", "python", "shell", "c", "cpp"];
const colors = createCssVariablesTheme({ name: "css-variables", variablePrefix: "--code-" });
const highlighter = await createHighlighter({ langs: LANGUAGES, themes: [colors] });

/** Tags at the end of a line, with the slashes before them if nothing else stands behind those. */
const TAGS = /\s*(?:\/\/)?((?:\s+@[a-z]+)+)\s*$/;

/** A module's code as it is shown, and what each line does. */
export function readListing(name: string): { code: string; kinds: string[] } {
  const text = readFileSync(new URL(`../listings/${name}.js`, import.meta.url), "utf8");
  const lines = text.replace(/^(import .*\n)*\n?/, "").trimEnd().split("\n");
  const kinds = lines.map((line) => TAGS.exec(line)?.[1]?.trim().replaceAll("@", "") ?? "");
  return { code: lines.map((line) => line.replace(TAGS, "")).join("\n"), kinds };
}

/** The listings that a reader can change, and the demo runs them: those that edit/harness.ts knows how to call. */
const EDITABLE = new Set(["pairwise", "sorted-pairwise", "sweep", "sweep-and-prune", "sweep-all-axes", "one-to-n", "quicksort", "insertion-sort", "swap-driven", "swap-all-axes"]);

/** The listing of a module, as html; `follows` is the id of the demo whose events highlight its lines. */
export function listing(name: string, follows: string | undefined): string {
  const { code, kinds } = readListing(name);
  const edit = follows && EDITABLE.has(name) ? `<button type="button" class="small" data-part="edit" aria-pressed="false">Edit</button>` : "";
  const follow = follows && kinds.some((kind) => kind.replace("added", "") !== "")
    ? `<button type="button" class="small" data-part="follow" aria-pressed="true" aria-label="Follow the demo">Follow</button>`
    : "";
  return `
    <figure class="listing"${follows ? ` data-follows="${follows}"` : ""}${edit ? ` data-listing="${name}"` : ""}>
      <figcaption class="row"><span>${name}.js</span>${follow}${edit}${COPY}</figcaption>
      ${highlight(code, "javascript", `${name}.js`, kinds)}
    </figure>`;
}

/** The button that copies the code of its listing. */
export const COPY = `<button type="button" class="small" data-part="copy">Copy</button>`;

/** Code in color, each line with what it does. */
export function highlight(code: string, lang: string, label: string, kinds: readonly string[] = []): string {
  const marks: ShikiTransformer = {
    pre(node) {
      node.properties = { tabindex: "0", role: "region", "aria-label": `Listing: ${label}` };
    },
    line(node, number) {
      const kind = kinds[number - 1];
      if (!kind) return;
      const events = kind.split(" ").filter((name) => name !== "added");
      if (events.length > 0) node.properties["data-kinds"] = events.join(" ");
      if (kind.includes("added")) node.properties["data-added"] = "";
    },
    // Lines are blocks that end in their line break. Between them, a break stands at the end of the widest line that the
    // browser has read so far, and moves while it reads.
    code(node) {
      node.children = node.children.filter((child) => child.type === "element");
      for (const line of node.children.slice(0, -1)) if (line.type === "element") line.children.push({ type: "text", value: "\n" });
    },
  };
  // Without a limit of time, or a line loses its colors if the machine is busy during the build.
  return highlighter.codeToHtml(code, { lang, theme: "css-variables", transformers: [marks], tokenizeTimeLimit: 0 });
}
