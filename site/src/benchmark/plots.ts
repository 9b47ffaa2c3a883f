// The plots. Colours are the page's own, by name, so that light and dark need no new drawing.

import * as Plot from "@observablehq/plot";
import { bytes, count, duration, PLAIN, significant } from "./results.ts";

/** A contender's number at a number of boxes. */
export interface Point {
  readonly name: string;
  readonly rival: boolean;
  readonly boxes: number;
  readonly value: number;
}

const COLOURS = 8;

/** Which line is whose: ours first and thick, those of ours in other settings dashed. */
function lookOf(points: readonly Point[]): (name: string) => { colour: string; dash: string; width: number } {
  const peers = [...new Set(points.filter(({ rival, name }) => rival && !PLAIN.test(name)).map(({ name }) => name))];
  const own = new Set(points.filter(({ rival }) => !rival).map(({ name }) => name));
  const [first] = own;
  return (name) => {
    if (own.has(name)) return { colour: "var(--line-ours)", dash: name === first ? "" : "6 4", width: name === first ? 3 : 2 };
    if (PLAIN.test(name)) return { colour: "var(--ink)", dash: "2 4", width: 1.75 };
    const at = peers.indexOf(name);
    return { colour: `var(--line-${(at % COLOURS) + 1})`, dash: at < COLOURS ? "" : "8 3", width: 1.75 };
  };
}

/** Lines over the number of boxes, both logarithmic, into `place`. */
export function drawLines(place: HTMLElement, points: readonly Point[], options: { unit: "time" | "memory" }): void {
  const look = lookOf(points);
  const format = options.unit === "time" ? duration : bytes;
  const names = [...new Set(points.map(({ name }) => name))];
  const title = (point: Point): string => `${point.name}\n${count(point.boxes)} boxes: ${format(point.value)}`;
  const of = (name: string): Point[] => points.filter((point) => point.name === name);
  const plot = Plot.plot({
    ...frame(place),
    x: { type: "log", label: "boxes", ticks: [...new Set(points.map(({ boxes }) => boxes))], tickFormat: shortCount, grid: false },
    y: { type: "log", label: null, tickFormat: (value: number) => (isPowerOfTen(value) ? format(value) : ""), grid: true },
    marks: [
      ...names.map((name) =>
        Plot.line(of(name), {
          x: "boxes",
          y: "value",
          stroke: look(name).colour,
          strokeWidth: look(name).width,
          strokeDasharray: look(name).dash,
        }),
      ),
      ...names.map((name) => Plot.dot(of(name), { x: "boxes", y: "value", fill: look(name).colour, r: look(name).width + 1 })),
      Plot.tip(points, Plot.pointer({ x: "boxes", y: "value", title })),
    ],
  });
  show(place, plot, summary(points, format), key(names, look));
}

/** A dot for each scene and number of boxes: how many times as long as ours the fastest peer takes. */
export interface Lead {
  readonly scene: string;
  readonly boxes: number;
  readonly ratio: number;
  readonly peer: string;
}

export function drawLeads(place: HTMLElement, leads: readonly Lead[]): void {
  const sizes = [...new Set(leads.map(({ boxes }) => boxes))].sort((a, b) => a - b);
  const colour = (boxes: number): string => `var(--line-${((sizes.indexOf(boxes) + 3) % COLOURS) + 1})`;
  const title = ({ scene, boxes, ratio, peer }: Lead): string =>
    `${scene}, ${count(boxes)} boxes\n${peer} takes ${significant(ratio)} times as long`;
  const scenes = [...new Set(leads.map(({ scene }) => scene))];
  const plot = Plot.plot({
    ...frame(place),
    height: 20 * scenes.length + 80,
    marginLeft: 118,
    x: { type: "log", label: "times as long as ours →", grid: true, tickFormat: (value: number) => (/^[125]/.test(String(value)) || value < 1 ? String(value) : "") },
    y: { type: "point", label: null, domain: scenes, grid: true },
    marks: [
      Plot.ruleX([1], { stroke: "var(--ink)" }),
      ...sizes.map((size) =>
        Plot.dot(
          leads.filter(({ boxes }) => boxes === size),
          { x: "ratio", y: "scene", fill: colour(size), stroke: "var(--paper)", r: 5.5 },
        ),
      ),
      Plot.tip(leads, Plot.pointer({ x: "ratio", y: "scene", title })),
    ],
  });
  const least = leads.reduce((a, b) => (b.ratio < a.ratio ? b : a));
  const text = `The fastest peer takes at least ${significant(least.ratio)} times as long as ours: ${title(least).replace("\n", ", ")}.`;
  const legend = key(sizes.map((size) => `${count(size)} boxes`), (name) => {
    const at = sizes.findIndex((size) => name === `${count(size)} boxes`);
    return { colour: colour(sizes[at] ?? 0), dash: "", width: 2 };
  });
  show(place, plot, text, legend);
}

/** What a plot shows nothing of. */
export function drawNothing(place: HTMLElement, why: string): void {
  const note = document.createElement("p");
  note.className = "note";
  note.textContent = why;
  place.replaceChildren(note);
}

function frame(place: HTMLElement): Plot.PlotOptions {
  return {
    width: Math.max(place.clientWidth, 280),
    height: 360,
    marginLeft: 62,
    marginRight: 24,
    marginBottom: 42,
    style: { background: "transparent", fontSize: "12px", fontFamily: "inherit" },
  };
}

function show(place: HTMLElement, plot: SVGElement | HTMLElement, text: string, legend: HTMLElement): void {
  // One picture with one description: the names of its parts are nothing to be read out.
  for (const part of plot.querySelectorAll("g[aria-label]")) part.removeAttribute("aria-label");
  plot.setAttribute("role", "img");
  plot.setAttribute("aria-label", text);
  place.replaceChildren(legend, plot);
}

function key(names: readonly string[], look: (name: string) => { colour: string; dash: string }): HTMLElement {
  const all = document.createElement("ul");
  all.className = "key";
  for (const name of names) {
    const item = document.createElement("li");
    const { colour, dash } = look(name);
    item.style.setProperty("--colour", colour);
    if (dash) item.style.setProperty("--dash", dash.startsWith("2") ? "dotted" : "dashed");
    item.textContent = name;
    all.append(item);
  }
  return all;
}

/** What a plot says to those who do not see it. */
function summary(points: readonly Point[], format: (value: number) => string): string {
  const most = Math.max(...points.map(({ boxes }) => boxes));
  const there = points.filter(({ boxes }) => boxes === most).sort((a, b) => a.value - b.value);
  return `At ${count(most)} boxes: ${there.map(({ name, value }) => `${name} ${format(value)}`).join(", ")}.`;
}

const isPowerOfTen = (value: number): boolean => Math.abs(Math.log10(value) - Math.round(Math.log10(value))) < 1e-9;

const compact = new Intl.NumberFormat("en", { notation: "compact" });
const shortCount = (value: number): string => compact.format(value);
