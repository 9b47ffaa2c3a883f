// The legend of a demo or figure: what each of its colors means, with a swatch of the same shape.
// `<color-key shows="test overlap"></color-key>` becomes a list. Colors are those of article.css.

/** A swatch, drawn as the demo draws the thing, and what it means. */
interface Key {
  readonly swatch: string;
  readonly says: string;
}

const pair = (color: string, rest: string): string =>
  `<line x1="5" y1="8" x2="29" y2="8" stroke="var(--sap-${color})" ${rest}/>`;
const rings = `<circle cx="6" cy="8" r="4.5" fill="none" stroke="var(--sap-check)" stroke-width="3"/><circle cx="28" cy="8" r="4.5" fill="none" stroke="var(--sap-check)" stroke-width="3"/>`;
const upright = (x: number, color: string, rest = ""): string =>
  `<line x1="${x}" y1="1" x2="${x}" y2="15" stroke="var(--sap-${color})" stroke-width="2.5" ${rest}/>`;
const cell = (color: string): string =>
  `<rect x="6" y="1.5" width="22" height="13" fill="var(--sap-${color})" stroke="var(--sap-ink)" stroke-width="1.5"/>`;
const disc = (rest: string): string => `<circle cx="17" cy="8" r="6.5" ${rest}/>`;

const KEYS: Readonly<Record<string, Key>> = {
  test: { swatch: pair("check", 'stroke-width="4"') + rings, says: "tested now" },
  candidate: { swatch: pair("check", 'stroke-width="4"') + rings, says: "candidate: overlaps on x, tested now" },
  found: { swatch: pair("check", 'stroke-width="4"') + rings, says: "just found to overlap on both axes" },
  apart: { swatch: pair("overlap", 'stroke-width="2" stroke-dasharray="5 4"'), says: "boxes overlap, balls do not touch" },
  overlap: { swatch: pair("overlap", 'stroke-width="2"'), says: "boxes overlap" },
  skip: {
    swatch: `${upright(7, "skip")}${upright(27, "skip")}${pair("skip", 'stroke-width="2" stroke-dasharray="4 3"')}`,
    says: "gap: everything after it is skipped",
  },
  missed: { swatch: pair("sweep", 'stroke-width="4" stroke-dasharray="3 4"'), says: "overlap, missed" },
  line: { swatch: upright(17, "sweep"), says: "sweep line" },
  touched: { swatch: disc('fill="var(--sap-inside)" stroke="var(--sap-muted)" stroke-width="1.5"'), says: "touched by the line" },
  edges: {
    swatch: `${upright(11, "edge")}${upright(23, "edge", 'stroke-dasharray="4 3"')}`,
    says: "left edge (solid), right edge (dashed)",
  },
  compare: { swatch: cell("comparison"), says: "compared" },
  swap: { swatch: cell("swap"), says: "swapped" },
  moved: {
    swatch: `<rect x="6" y="1.5" width="22" height="13" fill="var(--sap-stage)" stroke="var(--sap-line)"/><rect x="6" y="11" width="22" height="3.5" fill="var(--sap-swap)"/>`,
    says: "swapped earlier in this sort",
  },
  focus: { swatch: disc('fill="none" stroke="var(--sap-chosen)" stroke-width="3"'), says: "the ball in question" },
  inside: {
    swatch: `${upright(11, "chosen")}${upright(23, "chosen", 'stroke-dasharray="4 3"')}`,
    says: "endpoints inside its interval",
  },
};

/** The legend for these keys, as html. */
export function legend(names: string): string {
  const items = names.split(" ").map((name) => {
    const key = KEYS[name];
    if (!key) throw new Error(`there is no color key "${name}", only ${Object.keys(KEYS).join(", ")}`);
    return `<li><svg viewBox="0 0 34 16" width="34" height="16" aria-hidden="true">${key.swatch}</svg>${key.says}</li>`;
  });
  return `<ul class="legend" aria-label="Legend">${items.join("")}</ul>`;
}
