// The first picture of the article as it stands in the page before its script, and where there are no scripts: the numbers in the
// text are counted in the picture.

import { init, Runner } from "sweep-and-prune-classroom";
import type { Plugin } from "vite";
import { bruteForceTests, formatCount } from "../panel/counters.ts";
import { MovingBoxes, WORLD_HEIGHT } from "./moving-boxes.ts";

/** As wide as the picture is in a window of 1280 by 900 pixels. */
const WIDTH = 309;
const COUNT = 400;
const LINE = 0.12;

await init();
const boxes = new MovingBoxes(COUNT, 1, WIDTH);
const runner = new Runner({ dimensions: 2, method: "sorted pairwise", axis: 0, persistent: true });
// The second frame: the first sorts what is in no order.
runner.step(boxes.rows);
const { pairs, counts } = runner.step(boxes.rows);
runner.free();
const touched = boxes.touchedBy(LINE * WIDTH);
const entered = touched.at(-1)!;
const partners = boxes.touchedBy(boxes.rows[4 * entered]!).filter((box) => box !== entered);
const all = bruteForceTests(COUNT);

const numbers: Readonly<Record<string, string>> = {
  ALL: formatCount(all),
  TESTS: formatCount(counts.tests),
  SHARE: ((100 * counts.tests) / all).toFixed(1),
  FEWER: formatCount(Math.floor(all / counts.tests)),
  COMPARISONS: formatCount(counts.comparisons),
  PAIRS: formatCount(counts.pairs),
  PARTNERS: formatCount(partners.length),
};

function picture(): string {
  const round = (value: number): number => Math.round(value * 100) / 100;
  const rect = (box: number): string => {
    const [left = 0, top = 0, right = 0, bottom = 0] = boxes.rows.subarray(4 * box, 4 * box + 4);
    return `M${round(left)} ${round(top)}H${round(right)}V${round(bottom)}H${round(left)}z`;
  };
  const middle = (box: number): string => `${round((boxes.rows[4 * box]! + boxes.rows[4 * box + 2]!) / 2)} ${round((boxes.rows[4 * box + 1]! + boxes.rows[4 * box + 3]!) / 2)}`;
  const overlapping = new Set(pairs);
  const path = (kind: string, ids: readonly number[]): string => `<path class="${kind}" d="${ids.map(rect).join("")}"/>`;
  const every = [...Array(COUNT).keys()];
  const at = round(LINE * WIDTH);
  const tests = partners.map((partner) => `M${middle(entered)}L${middle(partner)}`).join("");
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${WIDTH} ${WORLD_HEIGHT}"><style>
svg{background:#f3f0e8}path{fill:none;stroke-width:.4}.box{stroke:#59616a}.overlap{fill:#0e6670;fill-opacity:.72;stroke:#0e6670}.line{stroke:#c42b1c;stroke-width:.7}.touched{stroke:#c42b1c;fill:#c42b1c;fill-opacity:.25}.test{stroke:#0b7a4b;stroke-width:.9}
@media(prefers-color-scheme:dark){svg{background:#191d21}.box{stroke:#a0a8b0}.overlap{fill:#63c5c4;stroke:#63c5c4}.line,.touched{stroke:#ff8a75}.touched{fill:#ff8a75}.test{stroke:#4fd695}}
</style>${path("box", every.filter((box) => !overlapping.has(box)))}${path("overlap", every.filter((box) => overlapping.has(box)))}<path class="line" d="M${at} 0V${WORLD_HEIGHT}"/>${path("touched", touched)}<path class="test" d="${tests}"/></svg>`;
}

export const hero: Plugin = {
  name: "hero",
  transformIndexHtml: { order: "pre", handler: (page) => page.replace(/%([A-Z]+)%/g, (text, name: string) => numbers[name] ?? text) },
  generateBundle() {
    this.emitFile({ type: "asset", fileName: "still/hero.svg", source: picture() });
  },
};
