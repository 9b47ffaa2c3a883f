// One name for a pair, whichever of the two comes first.
export function key(a, b) {
  return a.id < b.id ? `${a.id} ${b.id}` : `${b.id} ${a.id}`;
}
