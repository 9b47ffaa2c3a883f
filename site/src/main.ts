// The explanation. What stands at its top comes first; the demos come when a reader comes near them.

import "sweep-and-prune-classroom/demo.css";
import { startArticle } from "./article/article.ts";
import { HeroBoxes } from "./hero/hero-boxes.ts";
import { showLoadFailureAfter } from "./load-failed.ts";
import { whenNear } from "./panel/awake.ts";

customElements.define("hero-boxes", HeroBoxes);

const DEMOS = "sap-demo, box-playground, library-trial, fast-sweep, three-structures";

/** The script of the demos; where it does not load, each of them says so. */
let isLoading = false;
function loadDemos(): void {
  if (isLoading) return;
  isLoading = true;
  import("./article/demos.ts").catch((error: unknown) => {
    for (const demo of document.querySelectorAll(DEMOS)) showLoadFailureAfter(demo, error);
  });
}

void whenNear(document.querySelectorAll(DEMOS)).then(loadDemos);
// A link into the article: its demos are fetched before the page is laid out.
if (document.getElementById(location.hash.slice(1))?.matches(`:has(${DEMOS}), section:has(${DEMOS}) *`)) loadDemos();

startArticle();
