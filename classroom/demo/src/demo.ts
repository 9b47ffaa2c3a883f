/**
 * `<sap-demo>`: an element that shows an algorithm at work on moving balls, step by step, forward
 * and back. Importing this module defines it. For browsers only.
 *
 * @module
 */
import { SapDemo } from "./element/api.js";
import { readShared as read } from "./element/share.js";

export { type DemoDrag, type DemoEvent, type DemoEventMap, type DemoMark, type DemoProgram, type DemoSort, type DemoState, type ProgramEvent, type Row, SapDemo } from "./element/api.js";

/** The attributes that an address from `share()` holds after its `#`, as pairs of name and value. */
export function readShared(hash: string): [name: string, value: string][] {
  return read(hash);
}

if (!customElements.get("sap-demo")) customElements.define("sap-demo", SapDemo);

declare global {
  interface HTMLElementTagNameMap {
    "sap-demo": SapDemo;
  }
}
