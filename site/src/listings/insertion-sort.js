import { precedes } from "./endpoints.js";

export function insertionSort(endpoints) {
  for (let i = 1; i < endpoints.length; i++) {
    for (let j = i - 1; j >= 0; j--) {
      const west = endpoints[j];
      const east = endpoints[j + 1];
      if (!precedes(east, west)) break; // @compare
      endpoints[j] = east; // @swap
      endpoints[j + 1] = west; // @swap
    }
  }
}
