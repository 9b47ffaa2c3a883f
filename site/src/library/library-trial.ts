import { findPairs, init } from "sweep-and-prune";
import { showLoadFailure } from "../load-failed.ts";
import { bruteForceTests, formatCount } from "../panel/counters.ts";

/** The numbers of boxes that the slider offers; more would block the page for too long. */
const BOXES = [10, 20, 50, 100, 200, 500, 1_000, 2_000, 5_000, 10_000, 20_000, 50_000, 100_000, 200_000, 500_000, 1_000_000];
/** Brute force checks the result up to this many boxes; more would take too long. */
const CHECKED = 5_000;
/** The side of a box at which each of `n` boxes in the unit cube overlaps about two others. */
const side = (n: number): number => 0.5 * Math.cbrt(4 / n);

/**
 * `<library-trial>`: the package, called by this page as any program calls it: random boxes in,
 * how many pairs and how long out, and brute force in plain JavaScript beside it.
 */
export class LibraryTrial extends HTMLElement {
  connectedCallback(): void {
    const [button, slider] = [this.querySelector("button")!, this.querySelector("input")!];
    const [count, result] = [this.querySelector(".value")!, this.querySelector<HTMLElement>("[role=status]")!];
    slider.max = String(BOXES.length - 1);
    const boxes = (): number => BOXES[slider.valueAsNumber] ?? CHECKED;
    const showCount = (): void => {
      count.textContent = formatCount(boxes());
      slider.setAttribute("aria-valuetext", count.textContent);
    };
    showCount();
    slider.addEventListener("input", showCount);
    slider.disabled = button.disabled = false;
    button.addEventListener("click", async () => {
      try {
        await init();
      } catch (error) {
        return showLoadFailure(result, error);
      }
      result.textContent = await trial(boxes());
    });
  }
}

/** Runs the library, and brute force where it is quick enough, on `n` random boxes; says what came out. */
async function trial(n: number): Promise<string> {
  const boxes = randomBoxes(n);
  findPairs(boxes, { dimensions: 3 }); // once without timing, so that the code is compiled
  const started = performance.now();
  const pairs = findPairs(boxes, { dimensions: 3 });
  const time = performance.now() - started;
  const found = `${formatCount(pairs.length / 2)} pairs among ${formatCount(n)} boxes in ${time.toFixed(1)} ms.`;

  const tests = formatCount(bruteForceTests(n));
  if (n > CHECKED) return `${found} Brute force would make ${tests} tests; this page runs it only up to ${formatCount(CHECKED)} boxes.`;
  const begun = performance.now();
  const expected = bruteForce(boxes);
  const bruteTime = performance.now() - begun;
  const agreement = inOrder(pairs) === inOrder(expected) ? "the same pairs" : "DIFFERENT pairs, which is a bug: please report it";
  return `${found} Brute force, ${tests} tests in plain JavaScript: ${agreement}, ${bruteTime.toFixed(1)} ms.`;
}

/** Random boxes in the unit cube, one row per box: min corner, max corner. */
function randomBoxes(n: number): Float32Array {
  const boxes = new Float32Array(6 * n);
  for (let row = 0; row < boxes.length; row += 6) {
    for (let axis = 0; axis < 3; axis++) {
      boxes[row + axis] = Math.random();
      boxes[row + 3 + axis] = (boxes[row + axis] ?? 0) + side(n) * (0.5 + Math.random());
    }
  }
  return boxes;
}

function bruteForce(boxes: Float32Array): number[] {
  const pairs: number[] = [];
  const at = (index: number): number => boxes[index] as number;
  for (let a = 0; a < boxes.length; a += 6) {
    for (let b = a + 6; b < boxes.length; b += 6) {
      if (at(a) > at(b + 3) || at(b) > at(a + 3)) continue;
      if (at(a + 1) > at(b + 4) || at(b + 1) > at(a + 4)) continue;
      if (at(a + 2) > at(b + 5) || at(b + 2) > at(a + 5)) continue;
      pairs.push(a / 6, b / 6);
    }
  }
  return pairs;
}

/** Pairs as text: the same for the same pairs, in whatever order. */
const inOrder = (pairs: ArrayLike<number>): string =>
  Array.from({ length: pairs.length / 2 }, (_, at) => `${pairs[2 * at]} ${pairs[2 * at + 1]}`).sort().join();
