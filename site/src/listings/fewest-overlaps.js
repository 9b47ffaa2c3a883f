export function axisOfFewestOverlaps(boxes) {
  const onX = countOverlaps(boxes, "left", "right");
  const onY = countOverlaps(boxes, "top", "bottom");
  return onX <= onY ? "x" : "y";
}

// All pairs, less those in which one box ends
// before the other begins.
function countOverlaps(boxes, left, right) {
  const begins = sorted(boxes.map((box) => box[left]));
  const ends = sorted(boxes.map((box) => box[right]));
  const n = boxes.length;
  let overlaps = (n * (n - 1)) / 2;
  let ended = 0;
  for (const begin of begins) {
    while (ends[ended] < begin) ended++;
    overlaps -= ended;
  }
  return overlaps;
}

function sorted(numbers) {
  return numbers.sort((a, b) => a - b);
}
