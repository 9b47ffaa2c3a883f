// What the documents of this repository say, for the pages that show it: so the tests that run a README run these examples too.

import { readFileSync } from "node:fs";

export interface Code {
  readonly language: string;
  readonly text: string;
}

/** The lines of a document, or those below a heading up to the next one. */
export function below(file: string, heading?: string): string[] {
  const lines = readFileSync(new URL(`../../../${file}`, import.meta.url), "utf8").split("\n");
  const at = heading === undefined ? 0 : lines.findIndex((line) => line === `## ${heading}` || line === `# ${heading}`);
  if (at < 0) throw new Error(`${file} has no heading "${heading}"`);
  const end = lines.findIndex((line, place) => place > at && line.startsWith("## "));
  return lines.slice(at + 1, heading === undefined || end < 0 ? undefined : end);
}

/** The code among lines, without the lines that documentation of Rust hides. */
export function codesIn(lines: readonly string[]): Code[] {
  return [...lines.join("\n").matchAll(/^```(\w+)\n(.*?)\n```$/gms)].map(([, language = "", code = ""]) => ({
    language,
    text: code.split("\n").filter((line) => language !== "rust" || !line.startsWith("# ")).join("\n"),
  }));
}
