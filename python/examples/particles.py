"""Five thousand soft particles in a dish, with NumPy: each step finds the particles that touch."""

import numpy as np

import sweep_and_prune as sap

random = np.random.default_rng(7)
count, radius, steps = 5000, 0.006, 100
centers = random.random((count, 2)).astype(np.float32)
velocities = (random.standard_normal((count, 2)) * 0.02).astype(np.float32)

finder = sap.PairFinder(dimensions=2, dtype=np.float32)  # keeps its buffers between steps
touching = 0
for step in range(steps):
    pairs = finder.find(np.hstack([centers - radius, centers + radius]))
    # The boxes touch. Do the discs in them touch too?
    a, b = pairs.T
    between = centers[b] - centers[a]
    distance = np.linalg.norm(between, axis=1)
    near = (distance < 2 * radius) & (distance > 0)
    a, b, between, distance = a[near], b[near], between[near], distance[near]
    # Each pushes the other away, harder the deeper they overlap.
    push = between * ((2 * radius - distance) / distance * 0.5)[:, None]
    np.add.at(velocities, a, -push)
    np.add.at(velocities, b, push)
    centers += velocities * 0.1
    outside = (centers < 0) | (centers > 1)
    velocities[outside] *= -1
    np.clip(centers, 0, 1, out=centers)
    touching = len(a)
    if step in (0, steps - 1):
        print(f"step {step}: {len(pairs)} pairs of boxes, {touching} of discs")
