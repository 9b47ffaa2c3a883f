// What the files of pages leave to the build: empty elements of names that are known here or there, each with what stands in
// its place.

import type { Plugin } from "vite";

export type Attributes = Readonly<Record<string, string>>;

/** By the name of an element, what it becomes. `text` has its attributes as they are written, for what stays an element. */
export type Tags = Readonly<Record<string, (attributes: Attributes, text: string) => string>>;

/** Also what has come in the place of an element is filled in. */
export function filledIn(page: string, tags: Tags): string {
  const empty = new RegExp(`<(${Object.keys(tags).join("|")})((?: [\\w-]+(?:="[^"]*")?)*)></\\1>`, "g");
  const filled = page.replace(empty, (_, name: string, text: string) => tags[name]!(attributesOf(text), text));
  return filled === page ? page : filledIn(filled, tags);
}

const attributesOf = (text: string): Attributes => Object.fromEntries([...text.matchAll(/([\w-]+)(?:="([^"]*)")?/g)].map(([, name, value = ""]) => [name!, value]));

export const fillIn = (tags: Tags): Plugin => ({
  name: "fill-in",
  transformIndexHtml: { order: "pre", handler: (page) => filledIn(page, tags) },
});
