// What the frame of every page does.

import { choice, choose, onThemeChange, type Choice } from "./theme.ts";

const select = document.querySelector<HTMLSelectElement>("#theme");
if (select) {
  const show = (): void => {
    select.value = choice();
  };
  show();
  onThemeChange(show);
  select.addEventListener("change", () => choose(select.value as Choice));
}

// The pages are kept for when there is no network. Not where a demo stands in someone else's page.
if (import.meta.env.PROD && select && "serviceWorker" in navigator) {
  addEventListener("load", () => {
    void keepPage().catch(() => {
      // Forbidden here, or no secure connection: then the pages need the network.
    });
  });
}

/** Stores this page, with all that it has loaded so far. */
async function keepPage(): Promise<void> {
  await navigator.serviceWorker.register(new URL(/* @vite-ignore */ "../service-worker.js", import.meta.url));
  const { active } = await navigator.serviceWorker.ready;
  const loaded = [location.href, ...performance.getEntriesByType("resource").map(({ name }) => name)];
  navigator.serviceWorker.addEventListener("message", () => (document.documentElement.dataset["stored"] = ""), { once: true });
  active?.postMessage({ loaded });
}
