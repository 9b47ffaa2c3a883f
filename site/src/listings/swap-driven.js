import { endpointsOf, precedes, refresh } from "./endpoints.js";
import { key } from "./key.js";
import { quicksort } from "./quicksort.js";
import { sweep } from "./sweep.js";

// Once, before the first frame: which overlaps are there already?
export function begin(boxes) {
  const endpoints = endpointsOf(boxes);
  const overlapping = new Map();
  quicksort(endpoints);
  sweep(endpoints, (a, b) => overlapping.set(key(a, b), [a, b]));
  return { endpoints, overlapping };
}

// Every frame: an insertion sort that looks at what it swaps.
export function update({ endpoints, overlapping }) {
  refresh(endpoints);

  for (let i = 1; i < endpoints.length; i++) {
    for (let j = i - 1; j >= 0; j--) {
      const [west, east] = [endpoints[j], endpoints[j + 1]];
      if (!precedes(east, west)) break; // @compare
      [endpoints[j], endpoints[j + 1]] = [east, west]; // @swap

      if (west.begins === east.begins) continue; // (( or )): nothing
      const pair = key(west.box, east.box);
      if (east.begins) overlapping.set(pair, [west.box, east.box]); // )( became ()
      else overlapping.delete(pair); // () became )(
    }
  }
  return [...overlapping.values()]; // overlaps on x: now test y @test
}
