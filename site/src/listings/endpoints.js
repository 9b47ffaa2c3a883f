const X = ["left", "right"];

// Two endpoints for each box.
// (On y, the sides are "top" and "bottom".)
export function endpointsOf(boxes, sides = X) {
  const [left, right] = sides;
  return boxes.flatMap((box) => [
    endpoint(box, left, true),
    endpoint(box, right, false),
  ]);
}

function endpoint(box, side, isLeft) {
  return { box, side, isLeft, at: box[side] };
}

// The boxes have moved: read the coordinates,
// but keep the order.
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
