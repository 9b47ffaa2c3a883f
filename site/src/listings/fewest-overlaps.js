export function axisOfFewestOverlaps(boxes) {
  const onX = countOverlaps(boxes, "left", "right");
  const onY = countOverlaps(boxes, "top", "bottom");
  return onX <= onY ? "x" : "y";
}

// All pairs, less those in which one box ends before the other begins.
function countOverlaps(boxes, left, right) {
  const begins = boxes.map((box) => box[left]).sort((a, b) => a - b);
  const ends = boxes.map((box) => box[right]).sort((a, b) => a - b);
  let overlaps = (boxes.length * (boxes.length - 1)) / 2;
  let ended = 0;
  for (const begin of begins) {
    while (ends[ended] < begin) ended++;
    overlaps -= ended;
  }
  return overlaps;
}
