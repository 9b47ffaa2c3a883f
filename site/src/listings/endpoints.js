// Two entries for each box: its begin and its end.
export function endpointsOf(boxes, first = "left", last = "right") {
  return boxes.flatMap((box) => [
    { box, side: first, begins: true, at: box[first] },
    { box, side: last, begins: false, at: box[last] },
  ]);
}

// The boxes have moved: read anew, keep the order.
export function refresh(endpoints) {
  for (const endpoint of endpoints) {
    endpoint.at = endpoint.box[endpoint.side];
  }
}

// Which of two endpoints comes first.
export function precedes(p, q) {
  if (p.at !== q.at) return p.at < q.at;
  if (p.begins !== q.begins) return p.begins;
  return p.box.id < q.box.id;
}
