"""The static index against shapely's STRtree: building, and many queries in one call.

    python python/bench_index.py

Both run in one process and in turn. Times are minima over the rounds; the results are compared first.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from time import perf_counter

import numpy as np
import shapely

import sweep_and_prune as sap


def least(work: Callable[[], object], other: Callable[[], object], rounds: int = 5) -> tuple[float, float]:
    """The least time of each of two calls."""
    times: tuple[list[float], list[float]] = ([], [])
    for _ in range(rounds):
        for call, into in zip((work, other), times):
            start = perf_counter()
            call()
            into.append(perf_counter() - start)
    return min(times[0]), min(times[1])


def main() -> None:
    """Prints a table."""
    print("| boxes | | sweep-and-prune | STRtree | times as long |\n|--:|---|--:|--:|--:|")
    for count in map(int, sys.argv[1:] or ["10000", "100000", "1000000"]):
        random = np.random.default_rng(1)
        for scene in ("uniform", "clustered"):
            centers = random.random((count, 2))
            if scene == "clustered":
                clusters = random.random((max(4, count // 1000), 2))
                centers = clusters[random.integers(len(clusters), size=count)] + random.normal(0, 0.01, (count, 2))
            boxes = np.hstack([centers, centers + random.random((count, 2)) / np.sqrt(count)])
            polygons = shapely.box(*boxes.T)
            index, tree = sap.Index(boxes), shapely.STRtree(polygons)
            row(count, f"{scene}, build", *least(lambda: sap.Index(boxes), lambda: shapely.STRtree(polygons)))
            for hits in (1, 100, 10_000):
                queries = boxes[random.integers(count, size=max(100, min(count, 1_000_000 // (hits + 9))))]
                middle = (queries[:, :2] + queries[:, 2:]) / 2
                half = np.sqrt(hits / count) / 2 if hits > 1 else 0
                areas = np.hstack([middle - half, middle + half])
                shapes = shapely.box(*areas.T) if hits > 1 else shapely.points(middle)
                found = index.search_many(areas)
                expected = tree.query(shapes)
                assert np.array_equal(found[:, np.lexsort(found[::-1])], expected[:, np.lexsort(expected[::-1])])
                name = f"{scene}, {len(areas)} queries, {found.shape[1] / len(areas):.0f} hits each"
                row(count, name, *least(lambda: index.search_many(areas), lambda: tree.query(shapes)))


def row(count: int, name: str, own: float, other: float) -> None:
    """Prints a row."""
    print(f"| {count} | {name} | {1000 * own:.3f} ms | {1000 * other:.3f} ms | {other / own:.1f} |", flush=True)


if __name__ == "__main__":
    main()
