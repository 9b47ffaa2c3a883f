/**
 * The colors of a demo, each a CSS custom property `--sap-…` that a page can set. The defaults
 * follow the page's `color-scheme`.
 */
const defaults = {
  /** Behind the balls. */
  stage: "light-dark(#f6f4ee, #191d21)",
  /** Text, and outlines. */
  ink: "light-dark(#1c2126, #ebe8e1)",
  muted: "light-dark(#59616a, #a0a8b0)",
  line: "light-dark(#cdc8ba, #3a4248)",
  ball: "light-dark(#d8d2c3, #3d464d)",
  /** A pair that is tested. */
  check: "light-dark(#0b7a4b, #4fd695)",
  /** A pair that is found to overlap. */
  overlap: "light-dark(#0e6670, #63c5c4)",
  /** A pair, or a row of pairs, that need not be tested. */
  skip: "light-dark(#7a5c00, #d9b44a)",
  /** The sweep line. */
  sweep: "light-dark(#c42b1c, #ff8a75)",
  /** Balls that the sweep line touches. */
  inside: "light-dark(#f0b7a8, #7d4338)",
  /** Endpoints. */
  edge: "light-dark(#5f5a9e, #aaa5ee)",
  /** Endpoints that the sort compares, and that it swaps. */
  comparison: "light-dark(#b3480b, #ffab6b)",
  swap: "light-dark(#0059b8, #6db5ff)",
  /** The ball that is chosen or in focus. */
  chosen: "light-dark(#8a1f7a, #f08fe0)",
} as const;

export type ColorName = keyof typeof defaults;
/** Resolved colors, as a canvas takes them. */
export type Theme = Readonly<Record<ColorName, string>>;

const names = Object.keys(defaults) as ColorName[];

/** Declarations for the style of the element: each color as `--_name`. */
export const declarations: string = names.map((name) => `--_${name}: var(--sap-${name}, ${defaults[name]});`).join("\n");

/**
 * Resolves the colors where the element stands, and notices when they change for whatever reason:
 * each is the color of an invisible probe, and the probes have transitions, which tell.
 */
export class ThemeProbe {
  readonly #probes: ReadonlyMap<ColorName, HTMLElement>;
  /** To be put into the shadow root. */
  readonly element: HTMLElement;

  constructor(changed: () => void) {
    this.element = document.createElement("span");
    this.element.hidden = true;
    this.#probes = new Map(names.map((name) => [name, this.#probe(name)]));
    this.element.style.cssText = "display:block;position:absolute;width:0;height:0;overflow:hidden;visibility:hidden";
    this.element.setAttribute("aria-hidden", "true");
    let isTold = false;
    this.element.addEventListener("transitionend", () => {
      if (isTold) return;
      isTold = true;
      queueMicrotask(() => {
        isTold = false;
        changed();
      });
    });
  }

  read(): Theme {
    const color = (name: ColorName): string => getComputedStyle(this.#probes.get(name)!).color;
    return Object.fromEntries(names.map((name) => [name, color(name)])) as Theme;
  }

  #probe(name: ColorName): HTMLElement {
    const probe = document.createElement("i");
    probe.style.cssText = `color: var(--_${name}); forced-color-adjust: none; transition: color 1ms step-end`;
    this.element.append(probe);
    return probe;
  }
}

/** Colors of as many balls, well apart, readable under dark text. */
export function rainbow(index: number, count: number): string {
  return `oklch(0.78 0.13 ${Math.round((360 * index) / Math.max(count, 1) + 20)})`;
}
