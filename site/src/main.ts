// The explanation.

import "sweep-and-prune/demo";
import "sweep-and-prune/demo.css";
import { startArticle } from "./article/article.ts";
import { FallingBalls } from "./falling/falling-balls.ts";
import { LibraryTrial } from "./library/library-trial.ts";

customElements.define("falling-balls", FallingBalls);
customElements.define("library-trial", LibraryTrial);
startArticle();
