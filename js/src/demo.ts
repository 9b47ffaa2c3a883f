/**
 * `<sap-demo>`: an element that shows an algorithm at work on moving balls, step by step, forward
 * and back. Importing this module defines it. For browsers only.
 *
 * @module
 */
import type { SapDemo as Demo } from "./demo/api.js";
import { SapDemoElement } from "./demo/element.js";
import { readShared as read } from "./demo/share.js";

export type { DemoDrag, DemoEvent, DemoEventMap, DemoSort, DemoState, Row } from "./demo/api.js";

/** `<sap-demo>`. */
export type SapDemo = Demo;
/** The class of `<sap-demo>`. */
export const SapDemo: { new (): Demo; prototype: Demo } = SapDemoElement as unknown as { new (): Demo; prototype: Demo };

/** The attributes that an address from `share()` holds after its `#`, as pairs of name and value. */
export function readShared(hash: string): [name: string, value: string][] {
  return read(hash);
}

if (!customElements.get("sap-demo")) customElements.define("sap-demo", SapDemo);

declare global {
  interface HTMLElementTagNameMap {
    "sap-demo": Demo;
  }
}
