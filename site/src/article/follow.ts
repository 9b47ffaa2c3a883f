// Highlights the lines of a listing that match the current event of a demo. Readers can switch this
// off, for all listings at once; the choice is stored.

import type { DemoEvent } from "sweep-and-prune-classroom/demo";
import { store, stored } from "../shell/stored.ts";

const KEY = "follow-demos";

export function followDemos(): void {
  const listings = [...document.querySelectorAll<HTMLElement>(".listing[data-follows]")];
  const buttons = listings.map((listing) => listing.querySelector<HTMLButtonElement>("[data-part=follow]"));
  let follows = stored(KEY) !== "off";

  const show = (): void => {
    for (const button of buttons) button?.setAttribute("aria-pressed", String(follows));
    if (!follows) for (const listing of listings) highlight(listing, undefined);
  };
  show();
  for (const button of buttons) {
    button?.addEventListener("click", () => {
      follows = !follows;
      store(KEY, follows ? undefined : "off");
      show();
    });
  }
  for (const listing of listings) {
    const demo = document.querySelector(`#${listing.dataset["follows"]} sap-demo`);
    demo?.addEventListener("sap-show", (event) => {
      if (follows) highlight(listing, (event as CustomEvent<DemoEvent | undefined>).detail);
    });
  }
}

/** The lines that do what the event says: the one that a program tells, or else those that are marked with its kind. */
function highlight(listing: HTMLElement, event: DemoEvent | undefined): void {
  for (const [at, line] of listing.querySelectorAll<HTMLElement>("pre .line").entries()) {
    const isAtWork = event?.line === undefined ? line.dataset["kinds"]?.split(" ").includes(event?.kind ?? "none") : event.line === at + 1;
    line.classList.toggle("at-work", isAtWork === true);
  }
}
