// The explanation. What stands at its top comes first; the demos come when a reader comes near them.

import "sweep-and-prune/demo.css";
import { startArticle } from "./article/article.ts";
import { HeroBoxes } from "./hero/hero-boxes.ts";

customElements.define("hero-boxes", HeroBoxes);

const near = new IntersectionObserver(
  (entries) => {
    if (!entries.some(({ isIntersecting }) => isIntersecting)) return;
    near.disconnect();
    void import("./article/demos.ts");
  },
  { rootMargin: "300px" },
);
for (const element of document.querySelectorAll("sap-demo, falling-balls, library-trial")) near.observe(element);
// A link into the article: its demos are fetched before the page is laid out.
if (document.getElementById(location.hash.slice(1))?.querySelector("sap-demo")) void import("./article/demos.ts");

startArticle();
