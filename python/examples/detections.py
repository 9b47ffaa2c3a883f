"""Detections in images: intersection over union of those that overlap, and non-maximum suppression.

Only detections of the same image and class are compared, and of these only the ones that overlap.
"""

import numpy as np

import sweep_and_prune as sap

random = np.random.default_rng(5)
count = 20_000
objects = random.integers(0, 2000, count)  # ten detections of each object
image, label = objects // 20, objects % 3
corner = np.stack([objects * 37 % 600, objects * 91 % 400], axis=1) + random.normal(0, 4, (count, 2))
boxes = np.hstack([corner, random.normal(80, 4, (count, 2))])  # x, y, width, height, as in COCO
scores = random.random(count)

# Values of `by` may be anything; here, one number stands for an image and a class.
a, b = sap.find_pairs(boxes, format="xywh", by=image * 3 + label).T

low = np.maximum(boxes[a, :2], boxes[b, :2])
high = np.minimum((boxes[:, :2] + boxes[:, 2:])[a], (boxes[:, :2] + boxes[:, 2:])[b])
common = (high - low).prod(axis=1)
area = boxes[:, 2:].prod(axis=1)
iou = common / (area[a] + area[b] - common)
print(f"{len(a)} pairs overlap, of {count * (count - 1) // 2}; their mean IoU is {iou.mean():.2f}")

# The better detection of a pair suppresses the other, unless a better one has suppressed it.
swapped = scores[a] < scores[b]
better, worse = np.where(swapped, b, a), np.where(swapped, a, b)
kept = np.ones(count, bool)
near = np.flatnonzero(iou > 0.5)
for pair in near[np.argsort(-scores[better[near]])]:
    if kept[better[pair]]:
        kept[worse[pair]] = False
print(f"{kept.sum()} detections are kept, of 2000 objects")
