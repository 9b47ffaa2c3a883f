import { endpointsOf, precedes, refresh } from "./endpoints.js";
import { key } from "./key.js";
import { quicksort } from "./quicksort.js";
import { sweep } from "./sweep.js";

// Once: which overlaps are there already?
export function begin(boxes) {
  const endpoints = endpointsOf(boxes);
  const overlapping = new Map();
  quicksort(endpoints);
  sweep(endpoints, (a, b) => overlapping.set(key(a, b), [a, b]));
  return { endpoints, overlapping };
}

// Every frame: a sort that looks at what it swaps.
export function update({ endpoints, overlapping }) {
  refresh(endpoints);

  for (let i = 1; i < endpoints.length; i++) {
    for (let j = i - 1; j >= 0; j--) {
      const west = endpoints[j];
      const east = endpoints[j + 1];
      if (!precedes(east, west)) break; // @compare
      endpoints[j] = east; // @swap
      endpoints[j + 1] = west; // @swap

      const [a, b] = [west.box, east.box];
      if (west.begins === east.begins) {
        continue; // (( or )): nothing changes
      } else if (east.begins) {
        overlapping.set(key(a, b), [a, b]); // )( became ()
      } else {
        overlapping.delete(key(a, b)); // () became )(
      }
    }
  }
  // They overlap on x. Now test y.
  return [...overlapping.values()]; // @test
}
