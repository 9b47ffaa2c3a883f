export function widestAxis(boxes) {
  // Twice the center; the factor does not matter.
  const x = boxes.map((box) => box.left + box.right);
  const y = boxes.map((box) => box.top + box.bottom);
  return variance(x) >= variance(y) ? "x" : "y";
}

function variance(values) {
  const mean = average(values);
  return average(values.map((v) => (v - mean) ** 2));
}

function average(values) {
  const sum = values.reduce((sum, v) => sum + v, 0);
  return sum / values.length;
}
