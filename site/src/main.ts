// The explanation.

import "sweep-and-prune/demo";
import "sweep-and-prune/demo.css";
import { startArticle } from "./article/article.ts";
import { BallLab } from "./lab/ball-lab.ts";
import { LibraryTrial } from "./library/library-trial.ts";

customElements.define("ball-lab", BallLab);
customElements.define("library-trial", LibraryTrial);
startArticle();
