// Two endpoints for each box. On y they are its top and bottom.
export function endpointsOf(boxes, left = "left", right = "right") {
  return boxes.flatMap((box) => [
    { box, side: left, isLeft: true, at: box[left] },
    { box, side: right, isLeft: false, at: box[right] },
  ]);
}

// The boxes have moved: read the coordinates, keep the order.
export function refresh(endpoints) {
  for (const endpoint of endpoints) {
    endpoint.at = endpoint.box[endpoint.side];
  }
}

// Whether endpoint p comes before endpoint q.
export function precedes(p, q) {
  if (p.at !== q.at) return p.at < q.at;
  if (p.isLeft !== q.isLeft) return p.isLeft;
  return p.box.id < q.box.id;
}
