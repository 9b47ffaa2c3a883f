// The recorded runs: which to look at, and their plots, table and file.

import runs from "virtual:benchmark-results";
import { LibraryList } from "./library-list.ts";
import { looksOf } from "./looks.ts";
import { bytes, type Case, count, duration, type Entry, fastest, fastestOwn, fastestAlternative, type Run, significant, timesOf } from "./results.ts";
import type { Lead, Point } from "./plots.ts";

type Task = "cases" | "worlds";
const TASKS: readonly (readonly [Task, string])[] = [
  ["cases", "find all pairs"],
  ["worlds", "track moving boxes"],
];
/** Inputs with fewer boxes are small: a plot over their number does not help. */
const SMALL = 100;

export class RecordedRuns {
  readonly #run = select("recorded-run");
  readonly #task = select("recorded-task");
  readonly #scene = select("recorded-scene");
  readonly #libraries = new LibraryList(element("recorded-libraries"), () => void this.#showScene());

  constructor() {
    const machine = element("recorded-machine");
    if (runs.length === 0) {
      machine.textContent = "There are no recorded results yet; bench/run and bench/js/run create them. You can measure in this browser below.";
      for (const place of ["plot-time", "plot-memory", "plot-ratio"]) element(place).closest("figure")?.remove();
      element("recorded-table").closest("details")?.remove();
      return;
    }
    fill(this.#run, runs.map(({ name, date, machine: { cpu } }, at) => [String(at), `${name}, ${date}, ${cpu}`]));
    this.#run.addEventListener("change", () => this.#showRun());
    this.#task.addEventListener("change", () => this.#showTask());
    this.#scene.addEventListener("change", () => void this.#showScene());
    this.#showRun();
    let width = innerWidth;
    addEventListener("resize", () => {
      if (innerWidth === width) return; // a phone's address bar came or went
      width = innerWidth;
      void this.#showScene();
      void this.#showLeads();
    });
  }

  get #chosen(): Run {
    const run = runs[Number(this.#run.value)];
    if (!run) throw new Error("no run is chosen");
    return run;
  }

  get #cases(): readonly Case[] {
    return this.#chosen[this.#task.value as Task].filter(({ boxes }) => boxes > SMALL);
  }

  #showRun(): void {
    const { machine, date, tools, address, name } = this.#chosen;
    const loads = [...this.#chosen.cases, ...this.#chosen.worlds].flatMap(({ load }) => load ?? []);
    const load = Math.max(machine.load ?? 0, ...loads);
    const quiet = load > machine.cores ? `Other programs were running (load up to ${load.toFixed(1)}), so the ratios are more reliable than the times.` : "";
    element("recorded-machine").textContent = `${machine.cpu}, ${machine.cores} cores, ${machine.system}; ${tools}; ${date}. ${quiet}`;
    const link = document.createElement("a");
    link.href = address;
    link.download = "";
    link.textContent = "Download the results as JSON";
    element("recorded-download").replaceChildren(link, ` (${name}, every round of every library)`);
    fill(this.#task, TASKS.filter(([task]) => this.#chosen[task].length > 0));
    this.#showTask();
  }

  #showTask(): void {
    const scenes = new Set(this.#cases.map(({ scene, dimensions }) => `${scene} ${dimensions}D`));
    fill(this.#scene, [...scenes].map((scene) => [scene, scene]));
    void this.#showLibraries();
    void this.#showScene();
    void this.#showLeads();
  }

  /** Who took part in any of the scenes. */
  get #entries(): Entry[] {
    return this.#cases.flatMap(({ results }) => results);
  }

  async #showLibraries(): Promise<void> {
    const { swatch } = await import("./plots.ts");
    const entries = this.#entries;
    this.#libraries.list(entries, this.#chosen, this.#task.value === "worlds", looksOf(entries), swatch);
  }

  async #showScene(): Promise<void> {
    const cases = this.#cases.filter(({ scene, dimensions }) => `${scene} ${dimensions}D` === this.#scene.value);
    cases.sort((a, b) => a.boxes - b.boxes);
    element("recorded-table").replaceChildren(...table(cases));
    const points = (value: "median_ns" | "peak_bytes"): Point[] =>
      cases.flatMap(({ boxes, results }) =>
        results.flatMap((entry) => {
          const number = timesOf(entry)?.[value];
          return number && this.#libraries.isShown(entry.name) ? [{ name: entry.name, alternative: entry.alternative, boxes, value: number }] : [];
        }),
      );
    const { drawLines, drawNothing } = await import("./plots.ts");
    const looks = looksOf(this.#entries);
    const draw = (place: string, of: Point[], unit: "time" | "memory"): void => {
      if (of.length > 0) drawLines(element(place), of, looks, { unit });
      else drawNothing(element(place), "Nothing was measured here, or no library is selected.");
    };
    draw("plot-time", points("median_ns"), "time");
    draw("plot-memory", points("peak_bytes"), "memory");
  }

  async #showLeads(): Promise<void> {
    const leads = this.#cases.flatMap((one): Lead[] => {
      const alternative = fastestAlternative(one);
      return alternative ? [{ scene: `${one.scene} ${one.dimensions}D`, boxes: one.boxes, ratio: alternative.ratio, alternative: alternative.name }] : [];
    });
    const { drawLeads, drawNothing } = await import("./plots.ts");
    if (leads.length > 0) drawLeads(element("plot-ratio"), leads);
    else drawNothing(element("plot-ratio"), "No alternative took part.");
  }
}

/** The head and the body of the table: a row for each library, columns for each number of boxes. */
export function table(cases: readonly Case[]): HTMLElement[] {
  const names = [...new Set(cases.flatMap(({ results }) => results.map(({ name }) => name)))];
  const head = document.createElement("thead");
  head.append(row(["Library", ...cases.map(({ boxes }) => `${count(boxes)} boxes`)].map((text) => cell("th", text, "col"))));
  const body = document.createElement("tbody");
  for (const name of names) {
    const cells = cases.map((one) => {
      const entry = one.results.find((entry) => entry.name === name);
      const times = entry && timesOf(entry);
      if (!times) return cell("td", entry && "Untimed" in entry.outcome ? entry.outcome.Untimed.why : "", undefined, "why");
      const own = fastestOwn(one);
      const ratio = entry.alternative && own ? ` (×${significant(times.median_ns / own)})` : "";
      const memory = times.peak_bytes ? `, ${bytes(times.peak_bytes)}` : "";
      const isFastest = fastest(one) === name;
      return cell("td", `${duration(times.median_ns)}${ratio}${memory}${isFastest ? ", fastest" : ""}`, undefined, isFastest ? "fastest" : "");
    });
    const line = row([cell("th", name, "row"), ...cells]);
    if (cases.some(({ results }) => results.some((entry) => entry.name === name && !entry.alternative))) line.className = "own";
    body.append(line);
  }
  const caption = document.createElement("caption");
  const pairs = cases.map((one) => `${count(one.pairs)} pairs of ${count(one.boxes)} boxes (checked against: ${one.reference})`);
  caption.textContent = `Time of a call (× the time of sweep-and-prune), peak memory. ${pairs.join("; ")}.`;
  return [caption, head, body];
}

function row(cells: readonly HTMLElement[]): HTMLTableRowElement {
  const line = document.createElement("tr");
  line.append(...cells);
  return line;
}

function cell(tag: "td" | "th", text: string, scope?: string, name = ""): HTMLElement {
  const made = document.createElement(tag);
  made.textContent = text;
  if (scope) made.setAttribute("scope", scope);
  if (name) made.className = name;
  return made;
}

/** Fills a choice, keeping what was chosen if it is still there. */
export function fill(choice: HTMLSelectElement, options: readonly (readonly [value: string, text: string])[]): void {
  const before = choice.value;
  choice.replaceChildren(...options.map(([value, text]) => new Option(text, value)));
  if (options.some(([value]) => value === before)) choice.value = before;
  choice.disabled = options.length === 0;
}

export function element(id: string): HTMLElement {
  const found = document.getElementById(id);
  if (!found) throw new Error(`there is no #${id}`);
  return found;
}

export const select = (id: string): HTMLSelectElement => element(id) as HTMLSelectElement;
