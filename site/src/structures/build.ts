// Writes the first picture of `<three-structures>` into the page, so that it is there without scripts too; and below it
// how to embed it elsewhere.

import { init } from "sweep-and-prune/algorithms";
import { SITE } from "../shell/pages.ts";
import { inside } from "./panels.ts";

await init();

/** As the demos' own: the script, which a page may leave out, gives the frame the height of what is in it. */
const SNIPPET = `<iframe src="${SITE}embed.html#three-structures"
  title="The same boxes in a sweep, a grid and a tree"
  style="width: 100%; max-width: 1000px; height: 1000px; border: 0"
  loading="lazy"></iframe>
<script>addEventListener("message", ({ data, source }) => { for (const frame of document.querySelectorAll("iframe")) if (frame.contentWindow === source && data?.sapDemoHeight) frame.style.height = data.sapDemoHeight + "px"; });</script>`;

export function expandStructures(page: string): string {
  const text = SNIPPET.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
  return page.replace(
    "<three-structures></three-structures>",
    () => `<three-structures>${inside()}</three-structures>
      <details class="ask embed-code"><summary>Embed this figure</summary><textarea readonly rows="6" aria-label="Code to embed this figure">${text}</textarea></details>`,
  );
}
