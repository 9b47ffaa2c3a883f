export function widestAxis(boxes) {
  const spreadX = variance(boxes.map((box) => (box.left + box.right) / 2));
  const spreadY = variance(boxes.map((box) => (box.top + box.bottom) / 2));
  return spreadX >= spreadY ? "x" : "y";
}

function variance(values) {
  const mean = values.reduce((sum, value) => sum + value, 0) / values.length;
  return values.reduce((sum, value) => sum + (value - mean) ** 2, 0) / values.length;
}
