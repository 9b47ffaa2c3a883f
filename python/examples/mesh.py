"""Two meshes: which triangles of one may touch triangles of the other?

With trimesh, a mesh has `vertices` and `faces` as here.
"""

import numpy as np

import sweep_and_prune as sap


def torus(center: tuple[float, float, float], steps: int = 200) -> tuple[np.ndarray, np.ndarray]:
    """A ring of triangles: `(n, 3)` vertices, and `(m, 3)` faces that name three of them."""
    u, v = np.meshgrid(*[np.arange(steps) * 2 * np.pi / steps] * 2)
    ring = 3 + np.cos(v)
    vertices = np.stack([ring * np.cos(u), ring * np.sin(u), np.sin(v)], axis=-1).reshape(-1, 3) + center
    at = np.arange(steps * steps).reshape(steps, steps)
    right, below, across = np.roll(at, -1, 1), np.roll(at, -1, 0), np.roll(at, (-1, -1), (0, 1))
    halves = np.stack([at, right, across], -1), np.stack([at, across, below], -1)
    return vertices, np.concatenate([half.reshape(-1, 3) for half in halves])


def bounds(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    corners = vertices[faces]  # (m, 3 corners, 3 coordinates)
    return np.hstack([corners.min(axis=1), corners.max(axis=1)])


one, other = torus((0, 0, 0)), torus((5, 0, 0))
boxes, other_boxes = bounds(*one), bounds(*other)
pairs = sap.find_pairs_between(boxes, other_boxes)
print(f"{len(boxes)} and {len(other_boxes)} triangles: {len(pairs)} candidates for an exact test")

# Within one mesh, neighbors share a corner. They always touch, so they are left out.
a, b = sap.find_pairs(boxes).T
shares = (one[1][a][:, :, None] == one[1][b][:, None, :]).any(axis=(1, 2))
print(f"within one mesh: {len(a)} pairs of boxes, {(~shares).sum()} of triangles without a common corner")
