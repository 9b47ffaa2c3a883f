/**
 * `<sap-demo>`: an element that shows an algorithm at work on moving balls, step by step, forward
 * and back. Importing this module defines it.
 *
 * @module
 */
import { SapDemo } from "./demo/element.js";

if (!customElements.get("sap-demo")) customElements.define("sap-demo", SapDemo);

declare global {
  interface HTMLElementTagNameMap {
    "sap-demo": SapDemo;
  }
}

export { SapDemo };
export type { DemoEvent, DemoState } from "./demo/element.js";
