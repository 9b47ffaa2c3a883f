import { SapComparisonElement } from "./comparison.js";
import { SapDemoElement } from "./element.js";
import type { SapDemo as Interface } from "./types.js";

export type { DemoDrag, DemoEvent, DemoEventMap, DemoMark, DemoProgram, DemoSort, DemoState, ProgramEvent, Row } from "./types.js";

/** `<sap-demo>`, beside its attributes. Each of those is a property as well, in camel case. */
export interface SapDemo extends Interface {}

// Before `<sap-demo>`: a demo looks for the comparison that it stands in.
if (!customElements.get("sap-comparison")) customElements.define("sap-comparison", SapComparisonElement);

/** The class of `<sap-demo>`. */
export const SapDemo: {
  /** A new element, in no document yet. */
  new (): SapDemo;
  /** What all of them inherit. */
  prototype: SapDemo;
} = SapDemoElement as unknown as { new (): SapDemo; prototype: SapDemo };
