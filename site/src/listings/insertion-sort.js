import { precedes } from "./endpoints.js";

export function insertionSort(endpoints) {
  for (let i = 1; i < endpoints.length; i++) {
    for (let j = i - 1; j >= 0; j--) {
      if (!precedes(endpoints[j + 1], endpoints[j])) break; // @compare
      [endpoints[j], endpoints[j + 1]] = [endpoints[j + 1], endpoints[j]]; // @swap
    }
  }
}
