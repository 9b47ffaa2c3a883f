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
const isKept = import.meta.env.PROD && select !== null && "serviceWorker" in navigator;
if (isKept) {
  addEventListener("load", () => {
    void keepPage().catch(() => {
      // Forbidden here, or no secure connection: then the pages need the network.
    });
  });
}

/** Stores this page, with all that it has loaded so far. */
async function keepPage(): Promise<void> {
  await navigator.serviceWorker.register(new URL(/* @vite-ignore */ "../service-worker.js", import.meta.url));
  await keep([location.href, ...performance.getEntriesByType("resource").map(({ name }) => name)]);
  document.documentElement.dataset["stored"] = "";
}

/** Stores files that this page or a thread of it has loaded. */
export async function keep(loaded: readonly string[]): Promise<void> {
  if (!isKept) return;
  const { active } = await navigator.serviceWorker.ready;
  const { port1, port2 } = new MessageChannel();
  const stored = new Promise((resolve) => (port1.onmessage = resolve));
  active?.postMessage({ loaded }, [port2]);
  await stored;
}
