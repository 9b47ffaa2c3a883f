import type { RunnerOptions } from "../algorithms/runner.js";
import type { Wasm } from "../../../../js/src/wasm/init.js";

/** A method shown on purpose: a value of the attribute `variant` of `<sap-demo>`. */
export interface DemoVariant {
  /** The name of the method. */
  readonly method: string;
  /** If it is a broken form of another method, that one. Then brute force shows what it misses. */
  readonly like?: RunnerOptions["method"];
  /** Default attributes that show what is to be seen. */
  readonly defaults: Readonly<Record<string, string>>;
}

/** Expensive cases and incomplete ones. */
const known: Record<string, DemoVariant> = {
  // The ball in focus is enclosed by another, of which no edge lies between its own.
  "one-to-n": {
    method: "one-to-n scan",
    defaults: {
      balls: "[[300,200,40],[310,210,150],[360,120,45],[80,300,50],[520,110,50]]",
      focus: "0",
      static: "",
      draggable: "",
      boxes: "",
      array: "",
      decorations: "checks:700,edges:focus",
    },
  },
  // One of many is thrown from side to side, past all the others.
  teleport: {
    method: "swap-driven sweep",
    defaults: {
      balls: "[[40,60,24],[100,130,14],[140,227,21],[180,324,16],[220,201,23],[260,298,18],[300,175,25],[340,272,20],[380,149,15],[420,246,22],[460,343,17],[500,220,24]]",
      motion: "teleport",
      "skip-interval": "60",
      rainbow: "",
      decorations: "edges:array",
      speed: "2",
    },
  },
};

let algorithms: Wasm | undefined;

/**
 * Adds values of the attribute `variant`, with the compiled algorithms that know their methods. Call it before
 * `sweep-and-prune-classroom/demo` is imported.
 */
export function addVariants(variants: Readonly<Record<string, DemoVariant>>, wasm?: Wasm): void {
  Object.assign(known, variants);
  algorithms = wasm ?? algorithms;
}

/** The variants, by name. */
export function variants(): Readonly<Record<string, DemoVariant>> {
  return known;
}

/** The compiled algorithms that know their methods, if they are not those of this package. */
export function algorithmsOfVariants(): Wasm | undefined {
  return algorithms;
}
