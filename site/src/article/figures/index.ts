// The figures of the explanation, by name.

import { boxTest, transitivity } from "./boxes.ts";
import { columns } from "./columns.ts";
import { endpointArray, sweepLine } from "./endpoints.ts";
import { allPairs, measured } from "./growth.ts";

export const figures: Readonly<Record<string, () => string>> = {
  "all-pairs": allPairs,
  "box-test": boxTest,
  transitivity,
  "endpoint-array": endpointArray,
  "sweep-line": sweepLine,
  columns,
  measured,
};
