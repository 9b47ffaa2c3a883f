"""How long other libraries for Python take, compared with sweep-and-prune: `python ratios.py`, in an environment with
requirements.txt and the package. Writes results/ratios-...json after each case; `python report.py` makes tables of them.

Each library gets its input in the form that its documentation recommends, prepared before the clock starts, and answers
the whole question: an index that it needs is built within the time. Its number of results is checked first. All
libraries of a case run in turn in one process, and ratios are taken within a round.

torchvision is timed if it is installed. requirements.txt leaves it out: on Linux it takes 3 GB of packages for CUDA.
Debian's python3-torchvision is small, but needs an environment of its own with NumPy 1: `--only suppression --name
torchvision` writes results/torchvision-...json.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from datetime import date
from typing import Any

import numpy as np
from common import Call, in_turn, machine, note, peak_bytes, revision, summary, versions, write_results

import sweep_and_prune as sap

OWN = "sweep-and-prune"
TWO = "sweep-and-prune, 2 threads"
SLOW = {"rtree": 100_000, "bioframe": 1_000_000, "pyranges": 1_000_000, "supervision": 10_000}
"""The most boxes for which a library is tried: beyond, a round takes more than a minute."""
PACKAGES = (
    "numpy shapely geopandas pandas rtree scipy ncls bioframe pyranges supervision torch torchvision sweep-and-prune"
).split()


def squares(count: int) -> Any:
    """Squares of which each overlaps about four others."""
    low = np.random.default_rng(1).random((count, 2))
    return np.hstack([low, low + count**-0.5])


def all_pairs(count: int) -> dict[str, Call]:
    """All pairs of a set of boxes in the plane."""
    import shapely
    from rtree.index import Index, Property
    from scipy.spatial import cKDTree

    boxes = squares(count)
    low, high = np.ascontiguousarray(boxes[:, :2]), np.ascontiguousarray(boxes[:, 2:])
    shapes = shapely.box(*boxes.T)

    def strtree() -> Any:
        first, second = shapely.STRtree(shapes).query(shapes)
        return np.column_stack([first, second])[first < second]

    def r_tree() -> Any:
        # Bulk loading, and all queries in one call, as the documentation recommends for arrays.
        index = Index((np.arange(count), low, high), properties=Property(dimension=2))
        ids, counts = index.intersection_v(low, high)
        first, second = np.repeat(np.arange(count), counts.astype(np.int64)), ids.astype(np.int64)
        return np.column_stack([first, second])[first < second]

    def kd_tree() -> Any:  # equal squares only: those within a distance of each other
        return cKDTree(low).query_pairs(count**-0.5, p=np.inf, output_type="ndarray")

    return {
        OWN: lambda: sap.find_pairs(boxes),
        TWO: lambda: sap.find_pairs(boxes, threads=2),
        "shapely STRtree": strtree,
        "rtree": r_tree,
        "SciPy cKDTree": kd_tree,
    }


def intervals(count: int) -> dict[str, Call]:
    """Overlaps of half-open intervals of integers: genes and reads on one chromosome."""
    import bioframe
    import pandas
    import pyranges
    from ncls import NCLS

    random = np.random.default_rng(2)
    space = 100 * count

    def some(number: int, least: int, most: int) -> Any:
        start = random.integers(0, space, number)
        return np.stack([start, start + random.integers(least, most, number)], axis=1)

    genes, reads = some(count // 10, 500, 2000), some(count, 50, 150)
    columns = [{"chrom": "chr1", "start": part[:, 0], "end": part[:, 1]} for part in (genes, reads)]
    frames = [pandas.DataFrame(part) for part in columns]
    renamed = {"chrom": "Chromosome", "start": "Start", "end": "End"}
    ranges = [pyranges.PyRanges(frame.rename(columns=renamed)) for frame in frames]
    starts, ends = (np.ascontiguousarray(genes[:, side]) for side in (0, 1))
    query = [np.ascontiguousarray(reads[:, side]) for side in (0, 1)]

    def nested_lists() -> Any:
        return NCLS(starts, ends, np.arange(len(genes))).all_overlaps_both(*query, np.arange(count))[0]

    return {
        OWN: lambda: sap.find_pairs_between(genes, reads, closed="left"),
        TWO: lambda: sap.find_pairs_between(genes, reads, closed="left", threads=2),
        "ncls": nested_lists,
        "bioframe": lambda: bioframe.overlap(*frames, how="inner", return_index=True, return_input=False),
        "pyranges": lambda: ranges[0].join(ranges[1]),
    }


def detections(count: int) -> dict[str, Call]:
    """Non-maximum suppression of detections of one class; ten of each object, 200 objects an image."""
    random = np.random.default_rng(5)
    objects = random.integers(0, max(count // 10, 1), count)
    image = objects // 200
    corner = random.uniform(0, 2000, (max(count // 10, 1), 2))[objects] + random.normal(0, 4, (count, 2))
    boxes = np.hstack([corner, corner + random.uniform(60, 100, (count, 2))])
    scores = random.permutation(count) / count

    def own(threads: int) -> Any:
        a, b = sap.find_pairs(boxes, by=image, threads=threads).T
        x0, y0, x1, y1 = np.ascontiguousarray(boxes.T)  # columns are gathered several times as fast as rows
        width = np.minimum(x1[a], x1[b]) - np.maximum(x0[a], x0[b])
        common = width * (np.minimum(y1[a], y1[b]) - np.maximum(y0[a], y0[b]))
        area = (x1 - x0) * (y1 - y0)
        near = np.flatnonzero(common / (area[a] + area[b] - common) > 0.5)
        a, b = a[near], b[near]
        is_worse = scores[a] < scores[b]
        better, worse = np.where(is_worse, b, a), np.where(is_worse, a, b)
        kept = np.ones(count, bool)
        while len(worse):
            has_better = np.zeros(count, bool)
            has_better[worse] = True
            kept[worse[~has_better[better]]] = False
            undecided = kept[better] & kept[worse]
            better, worse = better[undecided], worse[undecided]
        return np.flatnonzero(kept)

    calls: dict[str, Call] = {OWN: lambda: own(1), TWO: lambda: own(2)}
    try:
        from supervision.detection.utils.iou_and_nms import box_non_max_suppression

        table = np.column_stack([boxes, scores, image])
        calls["supervision"] = lambda: np.flatnonzero(box_non_max_suppression(table, iou_threshold=0.5))
    except ImportError:
        pass
    try:
        import torch
        from torchvision.ops import batched_nms

        tensors = torch.from_numpy(boxes), torch.from_numpy(scores), torch.from_numpy(image)
        torch.set_num_threads(1)
        calls["torchvision"] = lambda: batched_nms(*tensors, iou_threshold=0.5)
    except ImportError:
        pass
    return calls


def joins(count: int) -> Iterator[tuple[str, dict[str, Call]]]:
    """Joins of tables of geometries, with `geopandas.sjoin`."""
    import geopandas
    import shapely

    random = np.random.default_rng(1)
    boxes = geopandas.GeoDataFrame({"a": np.arange(count)}, geometry=shapely.box(*squares(count).T))
    points = geopandas.GeoDataFrame({"b": np.arange(count)}, geometry=shapely.points(random.random((count, 2))))
    centers = shapely.points(random.random((max(count // 100, 1), 2)))
    areas = geopandas.GeoDataFrame(geometry=shapely.buffer(centers, max(count // 100, 1) ** -0.5, quad_segs=32))

    def compared(left: Any, right: Any, predicate: str, **options: Any) -> dict[str, Call]:
        def other() -> Any:
            # A copy has no index: sjoin builds it, as for data that was just read.
            copies = [frame.set_geometry(frame.geometry.array.copy()) for frame in (left, right)]
            return geopandas.sjoin(*copies, predicate=predicate, **options)

        return {
            OWN: lambda: sap.join(left, right, predicate=predicate, **options),
            TWO: lambda: sap.join(left, right, predicate=predicate, threads=2, **options),
            "geopandas.sjoin": other,
        }

    # The geometries of the first case are their own bounding boxes.
    yield "join, boxes that intersect boxes", compared(boxes, boxes, "intersects")
    yield "join, points that intersect polygons", compared(points, areas, "intersects")
    yield "join, points within polygons", compared(points, areas, "within")
    yield "join, polygons that contain points", compared(areas, points, "contains")
    yield "join, polygons that intersect polygons", compared(areas, areas, "intersects")
    near = count**-0.5
    yield "join, points within a distance of points", compared(points, points, "dwithin", distance=near)


def cases(sizes: list[int], only: str) -> Iterator[tuple[str, int, dict[str, Call]]]:
    for count in sizes:
        for name, of in (("all pairs", all_pairs), ("intervals", intervals), ("suppression", detections)):
            if only in name:
                calls = of(count)
                yield name, count, {one: call for one, call in calls.items() if count <= SLOW.get(one, count)}
        if count <= 1_000_000 and only in "join":
            for name, calls in joins(count):
                yield name, count, calls


def is_near(wanted: int, found: int) -> bool:
    """Whether two numbers of pairs may be those of the same boxes.

    Sums of squares' edges are rounded: one pair in a million touches for one library only.
    """
    return abs(found - wanted) <= wanted * 1e-6 + 1


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sizes", type=int, nargs="+", default=[1000, 10_000, 100_000, 1_000_000])
    parser.add_argument("--seconds", type=float, default=3.0, help="how long a case takes at least, in all")
    parser.add_argument("--only", default="", help="only cases whose names contain this text; all joins are one")
    parser.add_argument("--name", default="ratios", help="how the names of the files of results begin")
    options = parser.parse_args()
    content = {"date": date.today().isoformat(), "machine": machine(), "revision": revision()}
    content |= {"versions": versions(PACKAGES), "cases": []}
    for name, count, calls in cases(options.sizes, options.only):
        counts = {library: len(call()) for library, call in calls.items()}
        # What most find; if no two agree, what this package finds.
        wanted = max(
            (counts[OWN], *counts.values()), key=lambda number: sum(is_near(number, one) for one in counts.values())
        )
        wrong = {library: found for library, found in counts.items() if not is_near(wanted, found)}
        if OWN in wrong:
            raise SystemExit(f"{name}, {count}: {OWN} finds {wrong[OWN]}, and most find {wanted}: {counts}")
        if wrong:
            note(f"{name}, {count}: {OWN} finds {wanted}, but {wrong}: left out")
        calls = {library: call for library, call in calls.items() if library not in wrong}
        peaks = {library: peak_bytes(call) for library, call in calls.items()}
        times = in_turn(calls, options.seconds)
        results = {library: summary(times[library], times[OWN], peaks[library]) for library in calls}
        content["cases"].append({"case": name, "boxes": count, "found": wanted, "wrong": wrong, "results": results})
        note(f"{name}, {count}, {wanted} found: " + ", ".join(f"{one} {of['ratio']:.2f}" for one, of in results.items()))
        write_results(options.name, content)


if __name__ == "__main__":
    main()
