/** The colors of the page as drawings need them. */
export interface Theme {
  /** From the floor up. */
  readonly ramp: readonly string[];
  readonly floor: string;
  readonly edge: string;
  readonly line: string;
}

/** A color of the style sheet, by its custom property, as it is within an element: light or dark, as a canvas takes it, also where the visitor forces other colors. */
export function colorOf(name: string, place: Element = document.body): string {
  const probe = document.createElement("i");
  probe.style.forcedColorAdjust = "none";
  probe.style.color = `var(--${name})`;
  place.append(probe);
  const { color } = getComputedStyle(probe);
  probe.remove();
  return color;
}

export function readTheme(): Theme {
  const ramp = [0, 1, 2, 3, 4].map((stop) => colorOf(`ramp-${stop}`));
  return { ramp, floor: colorOf("floor"), edge: colorOf("edge"), line: colorOf("ink") };
}
