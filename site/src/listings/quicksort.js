import { precedes } from "./endpoints.js";

export function quicksort(
  endpoints,
  low = 0,
  high = endpoints.length - 1,
) {
  if (low >= high) return;
  const pivot = endpoints[(low + high) >> 1];
  let i = low;
  let j = high;

  while (i <= j) {
    while (precedes(endpoints[i], pivot)) i++; // @compare
    while (precedes(pivot, endpoints[j])) j--; // @compare
    if (i > j) break;
    const swapped = endpoints[i];
    endpoints[i++] = endpoints[j]; // @swap
    endpoints[j--] = swapped; // @swap
  }
  quicksort(endpoints, low, j);
  quicksort(endpoints, i, high);
}
