// What belongs together lights up together: a word of a caption, its entry in the legend, the lines of the listing, the ball, its
// endpoints in the array, and the same thing in the picture. By a pointer, or by the keyboard on a legend.

import type { SapDemo } from "sweep-and-prune-classroom/demo";
import { arrowOf } from "../panel/arrows.ts";

/** The color in a demo, and the kinds of lines of a listing, of each kind of word. */
const WORDS: Readonly<Record<string, { readonly color: string; readonly kinds: readonly string[] }>> = {
  test: { color: "check", kinds: ["test"] },
  overlap: { color: "overlap", kinds: ["overlap"] },
  skip: { color: "skip", kinds: ["skip"] },
  sweep: { color: "sweep", kinds: ["enter", "leave"] },
  missed: { color: "sweep", kinds: [] },
  edge: { color: "edge", kinds: [] },
  touched: { color: "inside", kinds: ["enter"] },
  flag: { color: "edge", kinds: ["flag"] },
  compare: { color: "comparison", kinds: ["compare"] },
  swap: { color: "swap", kinds: ["swap"] },
  focus: { color: "chosen", kinds: [] },
};

const wordOf = (element: Element): string => /\bis-(\w+)/.exec(element.className)?.[1] ?? "";

/** A demo, or several of one figure, with all that speaks of them. */
interface Group {
  readonly demos: readonly SapDemo[];
  readonly words: HTMLElement[];
  readonly balls: HTMLElement[];
  readonly lines: readonly HTMLElement[];
}

export function markTogether(): void {
  const groups = new Map<Element, Group>();
  for (const demo of document.querySelectorAll(".sections sap-demo")) {
    const place = placeOf(demo);
    if (groups.has(place)) continue;
    const demos = [...place.querySelectorAll<SapDemo>("sap-demo")];
    groups.set(place, { demos, words: [], balls: [], lines: [...place.querySelectorAll<HTMLElement>(".listing .line[data-kinds]")] });
  }
  const groupOf = (element: Element): Group | undefined => groups.get(placeOf(element)) ?? nearby(element, groups);
  for (const word of document.querySelectorAll<HTMLElement>('.sections [class^="is-"]')) if (wordOf(word) in WORDS) groupOf(word)?.words.push(word);
  for (const ball of document.querySelectorAll<HTMLElement>(".sections b")) groupOf(ball)?.balls.push(ball);
  for (const group of groups.values()) start(group);
  for (const legend of document.querySelectorAll<HTMLElement>(".legend")) makeReachable(legend);
}

/** What holds a demo and what is said of it. */
const placeOf = (element: Element): Element => element.closest(".beside, .two, .three") ?? element.closest("figure.demo") ?? element;

/** The group of the figure just before, or else just after, the block that an element stands in. */
function nearby(element: Element, groups: ReadonlyMap<Element, Group>): Group | undefined {
  const block = element.closest("section > *, .sections > section > *") ?? element;
  for (const way of ["previousElementSibling", "nextElementSibling"] as const) {
    let sibling = block[way];
    for (let steps = 0; sibling && steps < 3; steps++, sibling = sibling[way]) {
      const place = [sibling, ...sibling.querySelectorAll("*")].find((one) => groups.has(one));
      if (place) return groups.get(place);
    }
  }
  return undefined;
}

function start(group: Group): void {
  const mark = (name: string | undefined): void => {
    const { color, kinds = [] } = WORDS[name ?? ""] ?? {};
    for (const word of group.words) word.classList.toggle("marked", wordOf(word) === name);
    for (const line of group.lines) line.classList.toggle("marked", line.dataset["kinds"]!.split(" ").some((kind) => kinds.includes(kind)));
    for (const demo of group.demos) demo.marked = color === undefined ? undefined : { color };
  };
  const onPoint = (element: HTMLElement, name: string | undefined): void => {
    const place = element.closest<HTMLElement>(".legend li") ?? element;
    for (const event of ["pointerenter", "focus"]) place.addEventListener(event, () => mark(name));
    for (const event of ["pointerleave", "blur"]) place.addEventListener(event, () => mark(undefined));
  };
  for (const word of group.words) onPoint(word, wordOf(word));
  for (const line of group.lines) {
    const kinds = line.dataset["kinds"]!.split(" ");
    onPoint(line, Object.keys(WORDS).find((name) => WORDS[name]!.kinds.some((kind) => kinds.includes(kind))));
  }
  const markBall = (demo: SapDemo | undefined, name: string | undefined): void => {
    for (const word of group.balls) word.classList.toggle("marked", word.textContent === name);
    const others = demo ? group.demos.filter((other) => other !== demo) : group.demos;
    for (const other of others) other.marked = name === undefined ? undefined : { ball: other.names.indexOf(name) };
  };
  for (const demo of group.demos) {
    demo.addEventListener("sap-point", ({ detail }) => markBall(demo, detail === undefined ? undefined : demo.names[detail]));
  }
  for (const word of group.balls) {
    word.addEventListener("pointerenter", () => markBall(undefined, word.textContent));
    word.addEventListener("pointerleave", () => markBall(undefined, undefined));
  }
}

/** One stop for Tab in each legend; arrow keys go from entry to entry. */
function makeReachable(legend: HTMLElement): void {
  const entries = [...legend.querySelectorAll<HTMLElement>("li")];
  entries.forEach((entry, at) => (entry.tabIndex = at === 0 ? 0 : -1));
  legend.addEventListener("keydown", (event) => {
    const arrow = arrowOf(event);
    if (!arrow) return;
    event.preventDefault();
    const next = entries[(entries.indexOf(document.activeElement as HTMLElement) + arrow[0] + arrow[1] + entries.length) % entries.length]!;
    for (const entry of entries) entry.tabIndex = entry === next ? 0 : -1;
    next.focus();
  });
}
