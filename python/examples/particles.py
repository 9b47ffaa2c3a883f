"""Five thousand soft particles in a dish, with nothing but NumPy: who touches whom is asked in each step."""

import numpy as np

import sweep_and_prune as sap

random = np.random.default_rng(7)
count, radius, steps = 5000, 0.006, 100
places = random.random((count, 2)).astype(np.float32)
speeds = (random.standard_normal((count, 2)) * 0.02).astype(np.float32)

finder = sap.PairFinder(dimensions=2, dtype=np.float32)  # keeps its memory from step to step
touching = 0
for step in range(steps):
    pairs = finder.find(np.hstack([places - radius, places + radius]))
    # Boxes touch; do the discs in them?
    a, b = pairs.T
    between = places[b] - places[a]
    distance = np.linalg.norm(between, axis=1)
    near = (distance < 2 * radius) & (distance > 0)
    a, b, between, distance = a[near], b[near], between[near], distance[near]
    # Each pushes the other away, the deeper they are in each other the harder.
    push = between * ((2 * radius - distance) / distance * 0.5)[:, None]
    np.add.at(speeds, a, -push)
    np.add.at(speeds, b, push)
    places += speeds * 0.1
    outside = (places < 0) | (places > 1)
    speeds[outside] *= -1
    np.clip(places, 0, 1, out=places)
    touching = len(a)
    if step in (0, steps - 1):
        print(f"step {step}: {len(pairs)} pairs of boxes, {touching} of discs")
