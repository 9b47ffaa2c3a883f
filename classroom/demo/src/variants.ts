/**
 * More values of the attribute `variant` of `<sap-demo>`: for a page with compiled algorithms of its own.
 *
 * @module
 */
export type { InitOptions, Wasm } from "../../../js/src/wasm/init.js";
export type { RunnerOptions } from "./algorithms/runner.js";
export { addVariants, type DemoVariant } from "./element/variants.js";
