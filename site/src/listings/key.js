// The same key for (a, b) and (b, a).
export function key(a, b) {
  return a.id < b.id ? `${a.id} ${b.id}` : `${b.id} ${a.id}`;
}
