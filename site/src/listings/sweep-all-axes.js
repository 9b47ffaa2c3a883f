import { endpointsOf } from "./endpoints.js";
import { key } from "./key.js";
import { quicksort } from "./quicksort.js";
import { sweep } from "./sweep.js";

export function sweepAllAxes(boxes, onPair) {
  const axes = [["left", "right"], ["top", "bottom"]];
  const flags = new Map();

  for (const [first, last] of axes) {
    const endpoints = endpointsOf(boxes, first, last);
    quicksort(endpoints); // @compare @swap

    sweep(endpoints, (a, b) => { // @enter @leave
      const count = (flags.get(key(a, b)) ?? 0) + 1;
      flags.set(key(a, b), count);
      if (count === axes.length) onPair(a, b); // @overlap
    });
  }
}
