// Writes the first picture of `<three-structures>` into the page, so that it is there without scripts too; and below it
// how to embed it elsewhere.

import { init } from "sweep-and-prune-classroom";
import { iframeOf } from "../../../classroom/demo/src/element/snippet.ts";
import { SITE } from "../shell/pages.ts";
import { inside } from "./panels.ts";

await init();

const SNIPPET = iframeOf(`${SITE}embed.html#three-structures`, "The same boxes in a sweep, a grid and a tree", 936, 968);

export function threeStructures(): string {
  const text = SNIPPET.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
  return `<three-structures>${inside()}</three-structures>
      <details class="ask embed-code"><summary>Embed this figure</summary><textarea readonly rows="6" aria-label="Code to embed this figure">${text}</textarea></details>`;
}
