// The explanation's own parts.
import { LibraryTrial } from "./library/library-trial.ts";

customElements.define("library-trial", LibraryTrial);
