import { endpointsOf } from "./endpoints.js";
import { key } from "./key.js";
import { quicksort } from "./quicksort.js";
import { sweep } from "./sweep.js";

const axes = [
  ["left", "right"],
  ["top", "bottom"],
];

export function sweepAllAxes(boxes, onPair) {
  const flags = new Map();

  for (const sides of axes) {
    const endpoints = endpointsOf(boxes, sides);
    quicksort(endpoints); // @compare @swap

    sweep(endpoints, (a, b) => { // @enter @leave
      const count = (flags.get(key(a, b)) ?? 0) + 1;
      flags.set(key(a, b), count); // @flag
      if (count === axes.length) onPair(a, b); // @overlap
    });
  }
}
