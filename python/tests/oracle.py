"""What the tests compare with: brute force in NumPy, too simple to be wrong, and boxes that tie often."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray

Array = NDArray[Any]

FLOATS = (np.float32, np.float64)
DIMENSIONS = (1, 2, 3)


def overlaps(a: Array, b: Array) -> Array:
    """`(n, k)`: whether each box of one set touches each of the other."""
    half = a.shape[1] // 2
    least_a, most_a, least_b, most_b = a[:, :half], a[:, half:], b[:, :half], b[:, half:]
    touching = ((least_a[:, None] <= most_b[None]) & (least_b[None] <= most_a[:, None])).all(axis=2)
    return np.asarray(touching)


def pairs(boxes: Array) -> Array:
    """All pairs, sorted."""
    return np.argwhere(np.triu(overlaps(boxes, boxes), 1))


def pairs_between(a: Array, b: Array) -> Array:
    """All pairs of two sets, sorted."""
    return np.argwhere(overlaps(a, b))


def in_order(found: Array) -> Array:
    """Pairs, sorted."""
    return found[np.lexsort(found.T[::-1])]


def random_boxes(count: int, dimensions: int, dtype: Any, seed: int = 1) -> Array:
    """Boxes of which each overlaps about two others, with many ties."""
    random = np.random.default_rng(seed)
    side = max(2, round(count ** (1 / dimensions)))
    least = random.integers(0, 2 * side, (count, dimensions)) / 2
    return np.hstack([least, least + random.integers(0, 3, least.shape) / 2]).astype(dtype)


# Few distinct values, so that ties are common, and those at the ends of what there is.
COORDINATES = st.sampled_from([-np.inf, -2.0, -1.0, -0.0, 0.0, 0.5, 1.0, 2.0, 3.0, np.inf])


@st.composite
def box_sets(draw: st.DrawFn, dimensions: int, most: int = 40) -> Array:
    """A set of valid boxes, in double precision."""
    count = draw(st.integers(0, most))
    values = draw(st.lists(COORDINATES, min_size=2 * dimensions * count, max_size=2 * dimensions * count))
    corners = np.array(values, np.float64).reshape(count, 2, dimensions)
    return np.hstack([corners.min(axis=1), corners.max(axis=1)])
