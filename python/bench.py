"""Measures how long it takes to find all pairs of n squares in the plane, in double precision, and to join tables of
geometries, with this package and with the alternatives for Python: `pip install shapely scipy geopandas`, then
`python bench.py`. Checks the number of pairs and of rows."""

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


def joins(count: int) -> None:
    """Compares `join` with `geopandas.sjoin`; both begin without an index."""
    import geopandas
    import shapely

    random = np.random.default_rng(1)
    boxes = geopandas.GeoDataFrame({"a": np.arange(count)}, geometry=shapely.box(*squares(count).T))
    points = geopandas.GeoDataFrame({"b": np.arange(count)}, geometry=shapely.points(random.random((count, 2))))
    centers = shapely.points(random.random((count // 100, 2)))
    areas = geopandas.GeoDataFrame(geometry=shapely.buffer(centers, (count // 100) ** -0.5, quad_segs=32))
    for name, left, right, predicate, options in (
        ("boxes that intersect boxes", boxes, boxes, "intersects", {}),
        ("points that intersect polygons", points, areas, "intersects", {}),
        ("points within polygons", points, areas, "within", {}),
        ("polygons that contain points", areas, points, "contains", {}),
        ("polygons that intersect polygons", areas, areas, "intersects", {}),
        ("points within a distance of points", points, points, "dwithin", {"distance": count**-0.5}),
    ):

        def other() -> Any:
            # A copy has no index.
            copies = [frame.set_geometry(frame.geometry.array.copy()) for frame in (left, right)]
            return geopandas.sjoin(*copies, predicate=predicate, **options)

        own, joined = best(lambda: sap.join(left, right, predicate=predicate, **options))
        theirs, expected = best(other)
        assert len(joined) == len(expected), name
        print(
            f"{count} {name}, {len(joined)} rows: join {own:.1f} ms, geopandas.sjoin {theirs / own:.1f} times as long"
        )


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
    try:
        joins(100_000)
    except ImportError:
        print("pip install geopandas, to compare join with geopandas.sjoin")


if __name__ == "__main__":
    main()
