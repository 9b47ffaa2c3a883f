// Light or dark: what the visitor chose, or else what the system says.

import { store, stored } from "./stored.ts";

export type Choice = "auto" | "light" | "dark";

const system = matchMedia("(prefers-color-scheme: dark)");
const root = document.documentElement;

/** What was chosen. */
export const choice = (): Choice => (root.dataset["theme"] as Choice | undefined) ?? "auto";

/** Chooses, for this page and those visited later. */
export function choose(chosen: Choice): void {
  store("theme", chosen === "auto" ? undefined : chosen);
  apply(chosen);
}

/** Calls `changed` whenever the page turns light or dark. */
export function onThemeChange(changed: () => void, signal?: AbortSignal): void {
  const options = signal ? { signal } : {};
  system.addEventListener("change", changed, options);
  window.addEventListener("themechange", changed, options);
}

function apply(chosen: Choice): void {
  if (chosen === "auto") delete root.dataset["theme"];
  else root.dataset["theme"] = chosen;
  window.dispatchEvent(new Event("themechange"));
}

const applyStored = (value: string | null): void => apply(value === "light" || value === "dark" ? value : "auto");

// Another tab of the site chose, or another page from which the visitor came back.
window.addEventListener("storage", ({ key, newValue }) => key === "theme" && applyStored(newValue));
window.addEventListener("pageshow", ({ persisted }) => persisted && applyStored(stored("theme")));
