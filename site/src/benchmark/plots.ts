// The plots. Colors are the page's own, by name, so that light and dark need no new drawing.

import * as Plot from "@observablehq/plot";
import { COLORS, type Look, type Looks } from "./looks.ts";
import { bytes, count, duration, significant } from "./results.ts";

/** A library's number at a number of boxes. */
export interface Point {
  readonly name: string;
  readonly alternative: boolean;
  readonly boxes: number;
  readonly value: number;
}

/** Room for a line's name, and for the leader that leads to it. */
const NAME_WIDTH = 6.4;
const LEADER = 22;
/** Plots that are narrower have the names beneath. */
const ROOM_BESIDE = 560;
/** From one name to the next. */
const NAME_HEIGHT = 15;

/** Lines over the number of boxes, both logarithmic, into `place`, each with its name at its end or, where there is no room, beneath. */
export function drawLines(place: HTMLElement, points: readonly Point[], looks: Looks, options: { unit: "time" | "memory" }): void {
  const format = options.unit === "time" ? duration : bytes;
  const names = [...new Set(points.map(({ name }) => name))];
  const sizes = [...new Set(points.map(({ boxes }) => boxes))];
  const of = (name: string): Point[] => points.filter((point) => point.name === name);
  const title = (point: Point): string => `${point.name}\n${count(point.boxes)} boxes: ${format(point.value)}`;

  const base = frame(place);
  const most = Math.max(...sizes);
  const ends = names.map((name) => of(name).reduce((a, b) => (b.boxes > a.boxes ? b : a)));
  // A library that was not measured with the most boxes has no label at the right: the corner below is free.
  const text = ({ name, boxes }: Point): string => (boxes < most ? `${name}, to ${shortCount(boxes)}` : name);
  const isBeside = base.width >= ROOM_BESIDE;
  const marginRight = isBeside ? LEADER + 16 + NAME_WIDTH * Math.max(...ends.map((end) => text(end).length)) : base.marginRight;
  const height = 480;
  const [top, right, bottom] = [base.marginTop, base.width - marginRight, height - base.marginBottom];
  const x = logarithmic(sizes, [base.marginLeft, right]);
  const y = logarithmic(points.map(({ value }) => value), [bottom, top]);
  const early = ends.filter(({ boxes }) => boxes < most).sort((a, b) => b.value - a.value);
  const places = [
    ...apart(ends.filter(({ boxes }) => boxes === most), y.at, [top, bottom - NAME_HEIGHT * (early.length + 1)]),
    ...early.map((point, index) => ({ point, at: bottom - NAME_HEIGHT * (early.length - 1 - index) })),
  ];
  const labels = (isBeside ? places : []).map(({ point, at }) => ({ ...point, text: text(point), labelX: x.of(right + LEADER), labelY: y.of(at) }));

  const dots = (name: string, data: readonly object[], channels: { x: string; y: string; dx?: number }): Plot.Dot => {
    const { color, width, symbol, isFull } = looks(name);
    const fill = isFull ? { fill: color } : { fill: "var(--paper)", stroke: color, strokeWidth: 1.5 };
    return Plot.dot(data, { ...channels, symbol, r: width > 3 ? 5 : 3.75, ...fill });
  };
  const plot = Plot.plot({
    ...base,
    height,
    marginRight,
    x: { type: "log", label: "boxes", labelAnchor: "center", domain: x.domain, ticks: sizes, tickFormat: shortCount, grid: false },
    y: { type: "log", label: null, domain: y.domain, ticks: ticks(y.domain), tickFormat: format, grid: true },
    marks: [
      ...labels
        .filter(({ boxes }) => boxes === most)
        .map((label) => Plot.link([label], { x1: "boxes", y1: "value", x2: "labelX", y2: "labelY", stroke: looks(label.name).color, strokeDasharray: "1 3" })),
      ...names.map((name) => {
        const { color, width, dash } = looks(name);
        return Plot.line(of(name), { x: "boxes", y: "value", stroke: color, strokeWidth: width, strokeDasharray: dash });
      }),
      ...names.map((name) => dots(name, of(name), { x: "boxes", y: "value" })),
      ...labels.map((label) => dots(label.name, [label], { x: "labelX", y: "labelY", dx: 6 })),
      Plot.text(labels, { x: "labelX", y: "labelY", text: "text", textAnchor: "start", dx: 14, fill: "var(--ink)" }),
      Plot.tip(points, Plot.pointer({ x: "boxes", y: "value", title })),
    ],
  });
  const beneath = isBeside ? [] : [key(places.map(({ point }) => ({ name: text(point), swatch: swatch(looks(point.name)) })))];
  show(place, plot, summary(points, format), beneath);
}

/** A short line as the plots draw it. */
export function swatch({ color, dash, width, symbol, isFull }: Look): SVGSVGElement {
  const fill = isFull ? { fill: color } : { fill: "var(--paper)", stroke: color, strokeWidth: 1.5 };
  const plot = Plot.plot({
    width: width > 0 ? 36 : 14,
    height: 14,
    margin: 0,
    axis: null,
    x: { domain: [0, 2] },
    y: { domain: [0, 2] },
    marks: [
      Plot.line(width > 0 ? [[0, 1], [2, 1]] : [], { stroke: color, strokeWidth: width, strokeDasharray: dash }),
      Plot.dot([[1, 1]], { symbol, r: width > 3 ? 5 : 3.75, ...fill }),
    ],
  }) as SVGSVGElement;
  plot.setAttribute("aria-hidden", "true");
  plot.querySelector("style")?.remove(); // it would be part of the name of what it stands in
  return plot;
}

/** A logarithmic scale, as Plot makes it: what is where, and where is what. A lone value is in the middle. */
function logarithmic(values: readonly number[], [from, to]: readonly [number, number]): { domain: [number, number]; at(value: number): number; of(pixel: number): number } {
  const [low, high] = [Math.min(...values), Math.max(...values)];
  const domain: [number, number] = low < high ? [low, high] : [low / 2, low * 2];
  const decades = Math.log(domain[1] / domain[0]);
  return {
    domain,
    at: (value) => from + (Math.log(value / domain[0]) / decades) * (to - from),
    of: (pixel) => domain[0] * Math.exp(((pixel - from) / (to - from)) * decades),
  };
}

/** Where the names stand: at the height of their points, but a line apart and within the plot. */
function apart(points: readonly Point[], heightOf: (value: number) => number, [top, bottom]: readonly [number, number]): { point: Point; at: number }[] {
  const names = points.map((point) => ({ point, at: heightOf(point.value) })).sort((a, b) => a.at - b.at);
  let free = top - NAME_HEIGHT;
  for (const name of names) free = name.at = Math.max(name.at, free + NAME_HEIGHT);
  free = bottom + NAME_HEIGHT;
  for (const name of [...names].reverse()) free = name.at = Math.min(name.at, free - NAME_HEIGHT);
  return names;
}

/** A dot for each scene and number of boxes: how many times as long as sweep-and-prune the fastest alternative takes. */
export interface Lead {
  readonly scene: string;
  readonly boxes: number;
  readonly ratio: number;
  readonly alternative: string;
}

export function drawLeads(place: HTMLElement, leads: readonly Lead[]): void {
  const sizes = [...new Set(leads.map(({ boxes }) => boxes))].sort((a, b) => a - b);
  const look = (boxes: number): Look => {
    const at = sizes.indexOf(boxes);
    return { color: `var(--line-${((at + 3) % COLORS) + 1})`, dash: "", width: 0, symbol: SIZES[at % SIZES.length] ?? "circle", isFull: true };
  };
  const title = ({ scene, boxes, ratio, alternative }: Lead): string =>
    `${scene}, ${count(boxes)} boxes\n${alternative} takes ${significant(ratio)} times as long`;
  const scenes = [...new Set(leads.map(({ scene }) => scene))];
  const ratios = leads.map(({ ratio }) => ratio);
  const domain: [number, number] = [Math.min(1, ...ratios), Math.max(...ratios)];
  const axis = { ticks: ticks(domain, [1, 2, 5]), tickFormat: String, label: "× the time of sweep-and-prune →" };
  const plot = Plot.plot({
    ...frame(place),
    height: 20 * scenes.length + 100,
    marginTop: 42,
    marginLeft: 118,
    x: { type: "log", domain },
    y: { type: "point", label: null, domain: scenes, grid: true },
    marks: [
      Plot.gridX(axis),
      Plot.axisX({ ...axis, anchor: "top" }),
      Plot.axisX({ ...axis, anchor: "bottom" }),
      Plot.ruleX([1], { stroke: "var(--ink)" }),
      ...sizes.map((size) => {
        const { color, symbol } = look(size);
        return Plot.dot(
          leads.filter(({ boxes }) => boxes === size),
          { x: "ratio", y: "scene", fill: color, stroke: "var(--paper)", symbol, r: 5.5 },
        );
      }),
      Plot.tip(leads, Plot.pointer({ x: "ratio", y: "scene", title })),
    ],
  });
  const least = leads.reduce((a, b) => (b.ratio < a.ratio ? b : a));
  const text = `The fastest alternative takes at least ${significant(least.ratio)} times as long as sweep-and-prune: ${title(least).replace("\n", ", ")}.`;
  show(place, plot, text, []);
  place.prepend(key(sizes.map((size) => ({ name: `${count(size)} boxes`, swatch: swatch(look(size)) }))));
}

/** The symbols of numbers of boxes, from the least on. */
const SIZES = ["triangle", "circle", "square", "diamond"] as const;

/** What a plot shows nothing of. */
export function drawNothing(place: HTMLElement, why: string): void {
  const note = document.createElement("p");
  note.className = "note";
  note.textContent = why;
  place.replaceChildren(note);
}

interface Frame {
  readonly width: number;
  readonly marginTop: number;
  readonly marginLeft: number;
  readonly marginRight: number;
  readonly marginBottom: number;
  readonly style: Readonly<Record<string, string>>;
}

function frame(place: HTMLElement): Frame {
  return {
    width: Math.max(place.clientWidth, 280),
    marginTop: 20,
    marginLeft: 54,
    marginRight: 24,
    marginBottom: 42,
    style: { background: "transparent", fontSize: "12px", fontFamily: "inherit" },
  };
}

function show(place: HTMLElement, plot: Element, text: string, beneath: readonly Element[]): void {
  // One picture with one description: the names of its parts are nothing to be read out.
  for (const part of plot.querySelectorAll("g[aria-label]")) part.removeAttribute("aria-label");
  plot.setAttribute("role", "img");
  plot.setAttribute("aria-label", text);
  place.replaceChildren(plot, ...beneath);
}

function key(entries: readonly { name: string; swatch: Element }[]): HTMLElement {
  const all = document.createElement("ul");
  all.className = "key";
  for (const { name, swatch } of entries) {
    const item = document.createElement("li");
    item.append(swatch, name);
    all.append(item);
  }
  return all;
}

/** The description of a plot, for readers who do not see it. */
function summary(points: readonly Point[], format: (value: number) => string): string {
  const most = Math.max(...points.map(({ boxes }) => boxes));
  const there = points.filter(({ boxes }) => boxes === most).sort((a, b) => a.value - b.value);
  return `At ${count(most)} boxes: ${there.map(({ name, value }) => `${name} ${format(value)}`).join(", ")}.`;
}

/** Powers of ten within a domain, times these; if that are not two, times 1, 2 and 5. */
function ticks([low, high]: readonly [number, number], factors: readonly number[] = [1]): number[] {
  const first = Math.floor(Math.log10(low));
  const powers = Array.from({ length: Math.ceil(Math.log10(high)) - first + 1 }, (_, index) => 10 ** (first + index));
  const within = powers.flatMap((power) => factors.map((factor) => factor * power)).filter((value) => value >= low && value <= high);
  return within.length > 1 || factors.length > 1 ? within : ticks([low, high], [1, 2, 5]);
}

const compact = new Intl.NumberFormat("en", { notation: "compact" });
const shortCount = (value: number): string => compact.format(value);
