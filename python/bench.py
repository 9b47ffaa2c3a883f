"""Measures how long it takes to find all pairs of n squares in the plane, in double precision, with this package and
with the alternatives for Python: `pip install shapely scipy`, then `python bench.py`. Checks the number of pairs."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

import sweep_and_prune as sap


def best(find: Callable[[], Any], least_seconds: float = 1.0) -> tuple[float, Any]:
    """The shortest time of as many calls as fit in a second, in milliseconds, and the result."""
    times: list[float] = []
    while sum(times) < least_seconds:
        began = time.perf_counter()
        found = find()
        times.append(time.perf_counter() - began)
    return 1000 * min(times), found


def squares(count: int) -> Any:
    """Squares of which each overlaps about four others."""
    least = np.random.default_rng(1).random((count, 2))
    return np.hstack([least, least + count**-0.5])


def brute_force(boxes: Any) -> Any:
    least, most = boxes[:, :2], boxes[:, 2:]
    return np.argwhere(np.triu(((least[:, None] <= most[None]) & (least[None] <= most[:, None])).all(axis=2), 1))


def main() -> None:
    try:
        import shapely
        from scipy.spatial import cKDTree
    except ImportError:
        raise SystemExit("pip install shapely scipy, to compare with them") from None
    for count in (1000, 10_000, 100_000):
        boxes = squares(count)
        own, pairs = best(lambda: sap.find_pairs(boxes))
        print(f"{count} squares, {len(pairs)} pairs: find_pairs {own:.3f} ms")
        shapes = shapely.box(*boxes.T)
        others = {
            "shapely, STRtree": lambda: (lambda found: found[:, found[0] < found[1]].T)(
                shapely.STRtree(shapes).query(shapes)
            ),
            "scipy, cKDTree (equal squares only)": lambda: cKDTree(boxes[:, :2]).query_pairs(
                count**-0.5, p=np.inf, output_type="ndarray"
            ),
        }
        if count == 1000:
            others["NumPy, brute force"] = lambda: brute_force(boxes)
        for name, find in others.items():
            other, found = best(find)
            assert abs(len(found) - len(pairs)) <= 1, name  # sums are rounded
            print(f"  {name}: {other:.1f} ms, {other / own:.0f} times as long")


if __name__ == "__main__":
    main()
