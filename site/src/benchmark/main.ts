// The benchmark page. What is folded is set up when it is opened.

import { BenchmarkHere } from "./here.ts";
import { element, RecordedRuns } from "./recorded.ts";

/** Sets up a part of the page when it is opened first: drawings need its width. */
function whenOpened(id: string, setUp: () => void): void {
  const details = element(id) as HTMLDetailsElement;
  const open = (): void => {
    if (!details.open) return;
    details.removeEventListener("toggle", open);
    setUp();
  };
  details.addEventListener("toggle", open);
  open();
}

whenOpened("recorded-details", () => new RecordedRuns());
whenOpened("here-details", () => {
  BenchmarkHere.start().catch((error: unknown) => {
    element("here-status").textContent = `This browser cannot run it: ${String(error)}`;
  });
});

/** A link to a heading opens what it is the heading of. */
function openTarget(): void {
  const target = location.hash && document.getElementById(location.hash.slice(1))?.closest("details");
  if (!target) return;
  target.open = true;
  target.scrollIntoView();
}
addEventListener("hashchange", openTarget);
openTarget();
