// Flawed: see what it misses.
export function oneToN(endpoints, box, onOverlapX) {
  const from = endpoints.findIndex((e) => e.box === box && e.begins);
  const to = endpoints.findIndex((e) => e.box === box && !e.begins);

  const met = new Set();
  for (const { box: other } of endpoints.slice(from + 1, to)) { // @enter
    if (!met.has(other)) onOverlapX(box, other); // @test
    met.add(other);
  }
}
