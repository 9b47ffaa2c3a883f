import { endpointsOf, precedes, refresh } from "./endpoints.js";
import { key } from "./key.js";
import { quicksort } from "./quicksort.js";
import { sweep } from "./sweep.js";

// Once: one full sweep finds what overlaps.
export function begin(boxes) {
  const endpoints = endpointsOf(boxes);
  const overlapping = new Map();
  quicksort(endpoints); // @start
  sweep(endpoints, (a, b) => overlapping.set(key(a, b), [a, b])); // @start
  return { endpoints, overlapping };
}

// Every frame: insertion sort that looks at
// what it swaps.
export function update({ endpoints, overlapping }) {
  refresh(endpoints);

  for (let i = 1; i < endpoints.length; i++) {
    for (let j = i - 1; j >= 0; j--) {
      const west = endpoints[j];
      const east = endpoints[j + 1];
      if (!precedes(east, west)) break; // @compare
      endpoints[j] = east; // @swap
      endpoints[j + 1] = west; // @swap

      const [a, b] = [west.box, east.box]; // @added
      if (west.isLeft === east.isLeft) { // @added
        continue; // (( or )): nothing changes @added
      } else if (east.isLeft) { // @added
        overlapping.set(key(a, b), [a, b]); // )( became () @added
      } else { // @added
        overlapping.delete(key(a, b)); // () became )( @added
      } // @added
    }
  }
  // They overlap on x; the caller tests y.
  return [...overlapping.values()]; // @test
}
