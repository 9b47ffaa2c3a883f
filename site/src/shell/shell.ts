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
    navigator.serviceWorker.register(new URL(/* @vite-ignore */ "../service-worker.js", import.meta.url)).catch(() => {
      // Forbidden here, or no secure connection: then the pages need the network.
    });
  });
}
