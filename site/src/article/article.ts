// What the article does besides its demos: listings that follow them, the code for the three
// balls, choices that change a demo, and contents that mark the section that is being read.

import type { SapDemo } from "sweep-and-prune-classroom/demo";
import { copyable } from "../code/copy.ts";
import { showLoadFailureAfter } from "../load-failed.ts";
import { followDemos } from "./follow.ts";
import { markTogether } from "./marks.ts";
import { startSpaceTime } from "./space-time.ts";
import { TransitivityCode } from "./transitivity.ts";

const whenIdle = window.requestIdleCallback ?? setTimeout;

export function startArticle(): void {
  customElements.define("transitivity-code", TransitivityCode);
  for (const listing of document.querySelectorAll<HTMLElement>(".listing")) copyable(listing);
  for (const listing of document.querySelectorAll<HTMLElement>(".listing[data-listing]")) editable(listing);
  for (const figure of document.querySelectorAll<HTMLElement>("space-time")) startSpaceTime(figure);
  followDemos();
  // Not while the page loads: nothing is pointed at yet.
  whenIdle(markTogether);
  for (const choices of document.querySelectorAll<HTMLElement>(".choices[data-for]")) applyChoices(choices);
  markContents();
  const sections = [...document.querySelectorAll(".sections > section")];
  document.querySelector("hero-boxes")!.addEventListener("settled", () => layOutWhenIdle(sections), { once: true });
  addEventListener("scroll", () => layOutAtOnce(sections), { once: true });
}

/** Lays out the sections that article.css leaves out at first, one when nothing else is to be done: all at once takes a phone half a second. */
function layOutWhenIdle([next, ...others]: readonly Element[]): void {
  next?.classList.add("laid-out");
  if (others.length > 0) whenIdle(() => requestAnimationFrame(() => layOutWhenIdle(others)));
}

/** Lays them all out, and what was scrolled to stays where it is: it lies in the last section that begins in view. */
function layOutAtOnce(sections: readonly Element[]): void {
  const inView = sections.findLast((section) => section.getBoundingClientRect().top < innerHeight);
  const top = (): number => inView?.getBoundingClientRect().top ?? 0;
  const before = top();
  for (const section of sections) section.classList.add("laid-out");
  const moved = top() - before;
  // Where all were laid out already nothing moves, and a smooth scroll is not cut short.
  if (moved !== 0) scrollBy({ top: moved, behavior: "instant" });
}

/** A listing can be changed, and its demo runs it. The editor is loaded when the first one is. */
function editable(listing: HTMLElement): void {
  const button = listing.querySelector<HTMLButtonElement>("[data-part=edit]")!;
  const demo = document.querySelector<SapDemo>(`#${listing.dataset["follows"]} sap-demo`)!;
  let end: (() => void) | undefined;
  button.addEventListener("click", async () => {
    if (end) {
      end();
      end = undefined;
    } else {
      button.disabled = true;
      try {
        const [{ edit }] = await Promise.all([import("./editing.ts"), import("./demos.ts")]);
        await demo.ready;
        end = edit(listing, demo);
      } catch (error) {
        return showLoadFailureAfter(listing, error);
      } finally {
        button.disabled = false;
      }
    }
    button.setAttribute("aria-pressed", String(end !== undefined));
    button.textContent = end ? "Done" : "Edit";
  });
}

/** Each choice is an attribute of a demo, or of all the demos of a figure. A slider fills its value into a template. */
function applyChoices(choices: HTMLElement): void {
  const demos = document.querySelectorAll(`#${choices.dataset["for"]} sap-demo`);
  choices.addEventListener("input", ({ target }) => {
    const choice = target as HTMLInputElement | HTMLSelectElement;
    const { attribute = "", template = "{}", off } = choice.dataset;
    const isOff = choice instanceof HTMLInputElement && choice.type === "checkbox" && !choice.checked;
    const value = isOff ? off : template.replace("{}", choice.value);
    for (const demo of demos) {
      if (value === undefined) demo.removeAttribute(attribute);
      else demo.setAttribute(attribute, value);
    }
  });
}

/** Marks the section that is being read in the contents, and names it at the top where they are out of sight. */
function markContents(): void {
  const here = document.querySelector<HTMLElement>(".here")!;
  here.addEventListener("click", () => (document.querySelector<HTMLDetailsElement>(".contents details")!.open = true));
  const links = new Map(
    [...document.querySelectorAll<HTMLAnchorElement>(".contents a")].map((link) => [link.hash.slice(1), link]),
  );
  const seen = new Set<string>();
  const observer = new IntersectionObserver(
    (entries) => {
      for (const { target, isIntersecting } of entries) {
        if (isIntersecting) seen.add(target.id);
        else seen.delete(target.id);
      }
      const current = [...links.keys()].find((id) => seen.has(id));
      for (const [id, link] of links) {
        if (id === current) link.setAttribute("aria-current", "true");
        else link.removeAttribute("aria-current");
      }
      here.hidden = current === undefined;
      if (current === undefined) return;
      const place = [...links.keys()].indexOf(current) + 1;
      here.firstElementChild!.textContent = `${place} of ${links.size}: ${links.get(current)!.textContent}`;
    },
    // The section in the upper third of the window counts as being read.
    { rootMargin: "-10% 0px -66% 0px" },
  );
  for (const id of links.keys()) observer.observe(document.getElementById(id) as HTMLElement);
}
