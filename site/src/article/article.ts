// What the article does besides its demos: listings that follow them, the code for the three
// balls, choices that change a demo, and contents that mark the section that is being read.

import { followDemos } from "./follow.ts";
import { TransitivityCode } from "./transitivity.ts";

export function startArticle(): void {
  customElements.define("transitivity-code", TransitivityCode);
  for (const listing of document.querySelectorAll<HTMLElement>(".listing")) copyable(listing);
  followDemos();
  for (const choices of document.querySelectorAll<HTMLElement>(".choices[data-for]")) applyChoices(choices);
  markContents();
}

function copyable(listing: HTMLElement): void {
  const button = listing.querySelector("[data-part=copy]");
  const code = listing.querySelector("code");
  button?.addEventListener("click", async () => {
    const copied = await navigator.clipboard.writeText(`${code?.textContent ?? ""}\n`).then(
      () => "Copied",
      () => "Not allowed",
    );
    button.textContent = copied;
    setTimeout(() => (button.textContent = "Copy"), 1500);
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

/** Marks the section that is being read in the contents. */
function markContents(): void {
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
    },
    // The section in the upper third of the window counts as being read.
    { rootMargin: "-10% 0px -66% 0px" },
  );
  for (const id of links.keys()) observer.observe(document.getElementById(id) as HTMLElement);
}
