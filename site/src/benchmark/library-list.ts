// The libraries of a recorded run, to be ticked: how each is drawn, called, and of which version.

import type { Looks } from "./looks.ts";
import type { Entry, Run } from "./results.ts";

/** What measures the machine or another use, and not what a user of the library would choose between. */
const ASIDE = /, (again|fresh|two at once)$/;

export class LibraryList {
  readonly #list: HTMLElement;
  readonly #change: () => void;
  /** By name, for all runs: a chosen library stays chosen. */
  readonly #isShown = new Map<string, boolean>();

  constructor(list: HTMLElement, change: () => void) {
    this.#list = list;
    this.#change = change;
  }

  isShown(name: string): boolean {
    return this.#isShown.get(name) ?? !ASIDE.test(name);
  }

  /** Lists the libraries that took part; `swatch` draws a line as the plots do. */
  list(entries: readonly Entry[], { how, versions }: Run, isWorld: boolean, looks: Looks, swatch: (look: ReturnType<Looks>) => Element): void {
    const names = [...new Set(entries.map(({ name }) => name))];
    const noted = (of: Readonly<Record<string, string>>, name: string): string | undefined => (isWorld ? of[`${name}, world`] : undefined) ?? of[name];
    this.#list.replaceChildren(
      ...names.map((name) => {
        const label = document.createElement("label");
        const box = document.createElement("input");
        box.type = "checkbox";
        box.checked = this.isShown(name);
        box.addEventListener("change", () => {
          this.#isShown.set(name, box.checked);
          this.#change();
        });
        label.append(box, swatch(looks(name)), name);
        const item = document.createElement("li");
        item.append(label);
        const version = noted(versions, name);
        const text = [version && /^\d/.test(version) ? `version ${version}` : version, noted(how, name)].filter(Boolean).join(": ");
        item.append(...withCode(text));
        return item;
      }),
    );
  }
}

/** A note in which what stands between backticks is code. */
function withCode(text: string): HTMLElement[] {
  if (!text) return [];
  const note = document.createElement("span");
  note.className = "note";
  text.split("`").forEach((part, at) => {
    if (at % 2 === 0) return note.append(part);
    const code = document.createElement("code");
    code.textContent = part;
    note.append(code);
  });
  return [note];
}
