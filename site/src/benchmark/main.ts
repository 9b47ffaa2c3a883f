// The benchmark page. What measures is set up when it is opened.

import { showLoadFailure } from "../load-failed.ts";
import { BenchmarkHere } from "./here.ts";

const details = document.querySelector<HTMLDetailsElement>("#here-details")!;

function setUp(): void {
  if (!details.open) return;
  details.removeEventListener("toggle", setUp);
  BenchmarkHere.start().catch((error: unknown) => showLoadFailure(document.querySelector("#here-status")!, error));
}
details.addEventListener("toggle", setUp);

/** A link to its heading opens it. */
function openTarget(): void {
  if (location.hash !== "#here-heading") return;
  details.open = true;
  details.scrollIntoView();
}
addEventListener("hashchange", openTarget);
openTarget();
