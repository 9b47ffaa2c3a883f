import { messageOf } from "./message-of.ts";

/** Says why there is nothing to see, in place of what `place` says, and offers to load the page again: its address has all choices. */
export function showLoadFailure(place: HTMLElement, error: unknown): void {
  const why = typeof WebAssembly === "undefined"
    ? "This needs WebAssembly, which this browser does not have, or which is switched off."
    : `A file of this page did not load (${messageOf(error)}). Is there a connection?`;
  const retry = Object.assign(document.createElement("button"), { type: "button", textContent: "Try again" });
  retry.addEventListener("click", async () => {
    try {
      // After a new build, the service worker would answer with the old page, whose files are no longer there.
      await (await navigator.serviceWorker.getRegistration())?.unregister();
    } catch {
      // Forbidden here, or no secure connection: then there is none.
    }
    location.reload();
  });
  const says = Object.assign(document.createElement("span"), { textContent: `${why} ` });
  place.replaceChildren(says, retry);
  place.classList.add("load-failure");
}

/** The same after something that stays, once. */
export function showLoadFailureAfter(element: Element, error: unknown): void {
  const known = element.nextElementSibling;
  const place = known instanceof HTMLElement && known.matches(".load-failure") ? known : document.createElement("p");
  showLoadFailure(place, error);
  element.after(place);
}
