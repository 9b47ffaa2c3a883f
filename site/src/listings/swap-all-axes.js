import { endpointsOf, precedes, refresh } from "./endpoints.js";
import { key } from "./key.js";
import { quicksort } from "./quicksort.js";
import { sweep } from "./sweep.js";

const axes = [
  ["left", "right"],
  ["top", "bottom"],
];

// On how many axes do two boxes overlap?
// If on all, they are a pair.
class Flags {
  counts = new Map();
  pairs = new Map();

  change(a, b, by) {
    const pair = key(a, b);
    const count = (this.counts.get(pair) ?? 0) + by;
    this.counts.set(pair, count);
    if (count === 0) this.counts.delete(pair);
    if (count === axes.length) this.pairs.set(pair, [a, b]); // @overlap
    else this.pairs.delete(pair);
  }
}

export function begin(boxes) {
  const flags = new Flags();
  const arrays = axes.map((sides) => endpointsOf(boxes, sides));
  for (const endpoints of arrays) {
    quicksort(endpoints); // @start
    sweep(endpoints, (a, b) => flags.change(a, b, +1)); // @start
  }
  return { arrays, flags };
}

export function update({ arrays, flags }) {
  for (const endpoints of arrays) {
    refresh(endpoints);
    for (let i = 1; i < endpoints.length; i++) {
      for (let j = i - 1; j >= 0; j--) {
        const west = endpoints[j];
        const east = endpoints[j + 1];
        if (!precedes(east, west)) break; // @compare
        endpoints[j] = east; // @swap
        endpoints[j + 1] = west; // @swap
        if (west.isLeft === east.isLeft) continue;
        const by = east.isLeft ? +1 : -1;
        flags.change(west.box, east.box, by);
      }
    }
  }
  return [...flags.pairs.values()];
}
