// Flawed! Which overlaps does it miss?
export function oneToN(endpoints, box, onOverlapX) {
  const mine = (e) => e.box === box;
  const from = endpoints.findIndex(mine);
  const to = endpoints.findLastIndex(mine);

  const met = new Set();
  for (let i = from + 1; i < to; i++) {
    const other = endpoints[i].box;
    if (!met.has(other)) onOverlapX(box, other);
    met.add(other);
  }
}
