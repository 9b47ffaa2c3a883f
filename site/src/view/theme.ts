/** The colors of the page as drawings need them, read from the custom properties of the style sheet. */
export interface Theme {
  /** From the floor up. */
  readonly ramp: readonly string[];
  readonly stage: string;
  readonly floor: string;
  readonly edge: string;
  readonly line: string;
}

export function readTheme(): Theme {
  const style = getComputedStyle(document.documentElement);
  const color = (name: string): string => style.getPropertyValue(`--${name}`).trim();
  return {
    ramp: [0, 1, 2, 3, 4].map((stop) => color(`ramp-${stop}`)),
    stage: color("stage"),
    floor: color("floor"),
    edge: color("edge"),
    line: color("ink"),
  };
}

export { onThemeChange } from "../shell/theme.ts";
