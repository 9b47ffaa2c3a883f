// `<three-structures>` on a page of its own: what the address `embed.html#three-structures` shows.

import "./structures.css";
import { ThreeStructures } from "./three-structures.ts";

customElements.define("three-structures", ThreeStructures);
export { ThreeStructures };
