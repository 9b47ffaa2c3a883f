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

# Values of `by` may be anything; here, records of an image and a class.
pairs = sap.find_pairs(boxes, format="xywh", by=np.rec.fromarrays([image, label]))
a, b = pairs.T
iou = sap.measure_overlaps(boxes, None, pairs, format="xywh").iou
print(f"{len(a)} pairs overlap, of {count * (count - 1) // 2}; their mean IoU is {iou.mean():.2f}")

# A detection that no better one overlaps stays, and removes those that it overlaps; then the same with what is left.
near = iou > 0.5
rated = np.where(np.isnan(scores), -np.inf, scores)  # a NaN would be neither better nor worse
is_worse = rated[a] < rated[b]
better, worse = np.where(is_worse, b, a)[near], np.where(is_worse, a, b)[near]
kept = np.ones(count, bool)
while len(worse):
    has_better = np.zeros(count, bool)
    has_better[worse] = True
    kept[worse[~has_better[better]]] = False
    undecided = kept[better] & kept[worse]
    better, worse = better[undecided], worse[undecided]
print(f"{kept.sum()} detections are kept, of 2000 objects")
