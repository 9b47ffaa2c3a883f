"""Tracks over frames: links each detection to those of the next frame that it overlaps, in one search."""

import numpy as np

import sweep_and_prune as sap

random = np.random.default_rng(3)
objects, frames = 200, 50
start = random.uniform(0, 1900, (objects, 2))
velocity = random.normal(0, 3, (objects, 2))
frame = np.repeat(np.arange(frames), objects)
corner = start[None] + velocity[None] * np.arange(frames)[:, None, None]
corner = corner.reshape(-1, 2) + random.normal(0, 0.5, (frames * objects, 2))
boxes = np.hstack([corner, corner + 20])

# A detection of frame f meets those of frame f + 1: their groups are equal.
pairs = sap.find_pairs_between(boxes, boxes, by=(frame + 1, frame))
overlap = sap.measure_overlaps(boxes, boxes, pairs).size
now, later = pairs.T

# Each detection is continued by the one that it overlaps most. Several may be continued by the same one.
order = np.lexsort([-overlap, now])
now, later = now[order], later[order]
first = np.append(True, now[1:] != now[:-1])
following = np.full(len(boxes), -1)
following[now[first]] = later[first]

alive = np.arange(objects)
for _ in range(frames - 1):
    alive = following[alive]
    alive = alive[alive >= 0]
right = (following[:-objects] == np.arange(objects, len(boxes))).mean()
print(f"{len(now)} candidates, {first.sum()} links, {100 * right:.1f} % of them right")
print(f"{len(alive)} of {objects} objects are tracked through all {frames} frames")
