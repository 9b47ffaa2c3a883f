import { endpointsOf, precedes, refresh } from "../listings/endpoints.js";
import { key } from "../listings/key.js";
import { overlaps } from "../listings/overlaps.js";
import { quicksort } from "../listings/quicksort.js";
import { sweep } from "../listings/sweep.js";

/** What listings use of each other, under the names that they have in the article. */
export const helpers = { key, endpointsOf, refresh, quicksort, overlaps, precedes, sweep };
