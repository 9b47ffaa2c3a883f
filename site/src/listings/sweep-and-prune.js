import { endpointsOf } from "./endpoints.js";
import { quicksort } from "./quicksort.js";
import { sweep } from "./sweep.js";

export function sweepAndPrune(boxes, onPair) {
  const endpoints = endpointsOf(boxes);
  quicksort(endpoints); // @compare @swap

  sweep(endpoints, (a, b) => { // @enter @leave
    // They overlap on x. Do they on y?
    if (a.top <= b.bottom && a.bottom >= b.top) { // @test
      onPair(a, b); // @overlap
    }
  });
}
