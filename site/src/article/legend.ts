// The legend of a demo or figure: what each of its colors means, with a swatch of the same shape.
// `<sap-demo legend="test overlap">`, and `<color-key shows="test overlap"></color-key>` elsewhere, become a list.

/** A swatch, drawn as the demo draws the thing, and what it means. */
interface Key {
  readonly swatch: string;
  /** The words for it in the text have this class, `is-...`, if it has a color of its own. */
  readonly word?: string;
  readonly says: string;
}

const pair = (color: string, rest: string): string =>
  `<line x1="5" y1="8" x2="29" y2="8" stroke="var(--sap-${color})" ${rest}/>`;
const rings = `<circle cx="6" cy="8" r="4.5" fill="none" stroke="var(--sap-check)" stroke-width="3"/><circle cx="28" cy="8" r="4.5" fill="none" stroke="var(--sap-check)" stroke-width="3"/>`;
const upright = (x: number, color: string, rest = ""): string =>
  `<line x1="${x}" y1="1" x2="${x}" y2="15" stroke="var(--sap-${color})" stroke-width="2.5" ${rest}/>`;
const cell = (color: string): string =>
  `<rect x="6" y="1.5" width="22" height="13" fill="var(--sap-${color})" stroke="var(--sap-ink)" stroke-width="1.5"/>`;
const box = (rest: string): string => `<rect x="8" y="2" width="18" height="12" fill="var(--sap-stage)" ${rest}/>`;
const dot = (rest: string): string => `<circle cx="17" cy="8" r="5" stroke-width="2" ${rest}/>`;
const disc = (rest: string): string => `<circle cx="17" cy="8" r="6.5" ${rest}/>`;

const KEYS: Readonly<Record<string, Key>> = {
  test: { swatch: pair("check", 'stroke-width="4"') + rings, word: "test", says: "tested now" },
  candidate: { swatch: pair("check", 'stroke-width="4"') + rings, word: "test", says: "candidate: overlaps on x, tested now" },
  flagged: { swatch: pair("check", 'stroke-width="4"') + rings, word: "test", says: "gets a flag now" },
  flag: { swatch: pair("edge", 'stroke-width="2" stroke-dasharray="2 5"'), word: "flag", says: "one flag: overlap on one axis" },
  found: { swatch: pair("check", 'stroke-width="4"') + rings, word: "test", says: "just found to overlap on both axes" },
  apart: { swatch: pair("overlap", 'stroke-width="2" stroke-dasharray="5 4"'), word: "overlap", says: "boxes overlap, balls do not touch" },
  overlap: { swatch: pair("overlap", 'stroke-width="2"'), word: "overlap", says: "boxes overlap" },
  skip: {
    swatch: `${upright(7, "skip")}${upright(27, "skip")}${pair("skip", 'stroke-width="2" stroke-dasharray="4 3"')}`,
    word: "skip",
    says: "gap: everything after it is skipped",
  },
  missed: { swatch: pair("sweep", 'stroke-width="4" stroke-dasharray="3 4"'), word: "missed", says: "overlap, missed" },
  line: { swatch: upright(17, "sweep"), word: "sweep", says: "sweep line" },
  "right-edge": { swatch: upright(17, "sweep"), word: "sweep", says: "right endpoint of A" },
  touched: { swatch: disc('fill="var(--sap-inside)" stroke="var(--sap-muted)" stroke-width="1.5"'), word: "touched", says: "touched by the line" },
  edges: {
    swatch: `${upright(11, "edge")}${upright(23, "edge", 'stroke-dasharray="4 3"')}`,
    word: "edge",
    says: "left edge (solid), right edge (dashed)",
  },
  compare: { swatch: cell("comparison"), word: "compare", says: "compared" },
  swap: { swatch: cell("swap"), word: "swap", says: "swapped" },
  flash: { swatch: `${upright(8, "swap", 'style="stroke-width:5"')}<rect x="18" y="1.5" width="14" height="13" fill="var(--sap-swap)" stroke="var(--sap-ink)" stroke-width="1.5"/>`, word: "swap", says: "swapped just now" },
  moved: {
    swatch: `<rect x="6" y="1.5" width="22" height="13" fill="var(--sap-stage)" stroke="var(--sap-line)"/><rect x="6" y="11" width="22" height="3.5" fill="var(--sap-swap)"/>`,
    word: "swap",
    says: "swapped earlier in this sort",
  },
  frames: {
    swatch: `<rect x="3" y="3" width="10" height="10" fill="none" stroke="var(--sap-edge)" stroke-width="1.5" stroke-dasharray="3 2"/><rect x="20" y="3" width="10" height="10" fill="none" stroke="var(--sap-edge)" stroke-width="1.5"/>`,
    word: "edge",
    says: "box in the frame before (dashed), box in this frame",
  },
  swept: { swatch: `<rect x="3" y="3" width="28" height="10" fill="var(--sap-edge)" fill-opacity="0.2" stroke="var(--sap-edge)" stroke-width="1.5"/>`, word: "edge", says: "swept box" },
  "chosen-box": { swatch: box('stroke="var(--sap-chosen)" stroke-width="3" stroke-dasharray="5 2"'), word: "focus", says: "the box in question" },
  "tested-box": { swatch: box('stroke="var(--sap-check)" stroke-width="3"'), word: "test", says: "tested against it" },
  "overlapping-box": { swatch: box('style="fill:color-mix(in oklab, var(--sap-overlap) 55%, var(--sap-stage))" stroke="var(--sap-muted)"'), word: "overlap", says: "overlaps another box" },
  "focus-box": { swatch: box('style="fill:var(--sap-chosen)" stroke="var(--sap-chosen)"'), word: "focus", says: "the box in question" },
  "lane-box": { swatch: box('style="fill:color-mix(in oklab, var(--sap-check) 45%, var(--sap-stage))" stroke="var(--sap-check)"'), word: "test", says: "compared with it now" },
  "overlapping-lane": { swatch: box('style="fill:var(--sap-overlap)" stroke="var(--sap-overlap)"'), word: "overlap", says: "true, and overlaps" },
  loaded: { swatch: box('style="fill:color-mix(in oklab, var(--sap-edge) 35%, var(--sap-stage))" stroke="var(--sap-muted)"'), word: "edge", says: "cache line loaded" },
  looked: { swatch: `<rect x="3" y="1" width="28" height="14" fill="var(--sap-edge)" fill-opacity="0.2"/>`, word: "edge", says: "where its partners are looked for" },
  begins: { swatch: dot('fill="var(--sap-overlap)" stroke="var(--sap-overlap)"'), word: "overlap", says: ")( becomes (): an overlap begins" },
  ends: { swatch: dot('fill="var(--paper)" stroke="var(--sap-overlap)"'), word: "overlap", says: "() becomes )(: it ends" },
  unchanged: { swatch: dot('fill="var(--paper)" stroke="var(--sap-muted)"'), says: "(( or )): nothing changes" },
  now: { swatch: `<line x1="3" y1="8" x2="31" y2="8" stroke="var(--sap-sweep)" stroke-width="2.5"/>`, word: "sweep", says: "now" },
  focus: { swatch: disc('fill="none" stroke="var(--sap-chosen)" stroke-width="3"'), word: "focus", says: "the ball in question" },
  within: { swatch: cell("inside"), word: "touched", says: "its interval in the array" },
  inside: {
    swatch: `${upright(11, "chosen")}${upright(23, "chosen", 'stroke-dasharray="4 3"')}`,
    word: "focus",
    says: "endpoints inside its interval",
  },
};

/** The legend for these keys, as html. */
export function legend(names: string): string {
  const items = names.split(" ").map((name) => {
    const key = KEYS[name];
    if (!key) throw new Error(`there is no color key "${name}", only ${Object.keys(KEYS).join(", ")}`);
    return `<li><svg viewBox="0 0 34 16" width="34" height="16" aria-hidden="true">${key.swatch}</svg><span${key.word ? ` class="is-${key.word}"` : ""}>${key.says}</span></li>`;
  });
  return `<ul class="legend row" aria-label="Legend">${items.join("")}</ul>`;
}
