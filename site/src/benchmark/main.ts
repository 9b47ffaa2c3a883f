// The benchmark page.

import { BenchmarkHere } from "./here.ts";
import { element, RecordedRuns } from "./recorded.ts";

new RecordedRuns();
BenchmarkHere.start().catch((error: unknown) => {
  element("here-status").textContent = `This browser cannot run it: ${String(error)}`;
});
