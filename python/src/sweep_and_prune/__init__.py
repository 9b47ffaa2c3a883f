"""Finds every overlapping pair of axis-aligned boxes in 1D, 2D and 3D, fast, from NumPy arrays; or tracks a world of
moving bodies and reports which overlaps begin and end.

>>> import numpy as np
>>> import sweep_and_prune as sap
>>> boxes = np.array([
...     [0, 0, 2, 2],  # min x, min y, max x, max y
...     [5, 5, 6, 6],
...     [2, 1, 3, 4],  # touches the first box: that is an overlap
... ], dtype=np.float32)
>>> sap.find_pairs(boxes)
array([[0, 2]])

- Intervals are closed: touching boxes overlap, unless you pass `closed`. Points, flat boxes and infinite edges are
  boxes, and `-0.0` equals `0.0`. There is no epsilon.
- Each pair occurs once, the smaller index first, in an order that is the same on every machine.
- A box that is inverted or has a NaN is rejected with an error that names it. After an error nothing has changed.
- The arrays that are passed are copied, and those that are returned are yours. In signatures `Boxes` are boxes in
  any form that `find_pairs` accepts, `Pairs` arrays of indices (`int64` by default), `Ids` arrays of `int64`, `Floats`
  arrays of `float32` or `float64`.

| you have | call |
|---|---|
| boxes, once | `find_pairs` |
| two sets: bullets and targets, two tables to join | `find_pairs_between` |
| a question that only needs a number | `count_pairs`, `count_pairs_between` |
| more pairs than fit in memory, or a search that may stop early | `iter_chunks`, `for_each_chunk` |
| two data frames: rows whose boxes or geometries overlap | `join` |
| for each box the number of others, or those that are nearest | `count_overlaps`, `nearest` |
| the size of each overlap, its share of a box, IoU | `measure_overlaps` |
| which intervals or boxes are connected, their union; what intervals cover | `cluster`, `merge`; `coverage` |
| more boxes than fit in memory, or a cluster of machines | `sweep_and_prune.dask` |
| any of these every frame | `PairFinder` |
| bodies that mostly rest; begin and end events; queries and rays | `BroadPhase` |
"""

from typing import TYPE_CHECKING as _TYPE_CHECKING

from ._broad_phase import BroadPhase, Changes, Hit, Hits, Lists, Neighbors, slots_of
from ._errors import (
    InvalidBoxError,
    InvalidQueryError,
    SnapshotError,
    StaleProxyError,
    SweepAndPruneError,
)
from ._filter import Filter
from ._intervals import Merged, Nearest, cluster, coverage, merge, nearest
from ._join import join
from ._overlaps import Overlaps, count_overlaps, measure_overlaps
from ._pairs import (
    PairFinder,
    count_pairs,
    count_pairs_between,
    find_pairs,
    find_pairs_between,
    for_each_chunk,
    for_each_chunk_between,
    iter_chunks,
    iter_chunks_between,
)

if _TYPE_CHECKING:
    __version__: str

# In the order in which the documentation explains them.
__all__ = [  # noqa: RUF022
    "find_pairs",
    "find_pairs_between",
    "count_pairs",
    "count_pairs_between",
    "for_each_chunk",
    "for_each_chunk_between",
    "iter_chunks",
    "iter_chunks_between",
    "join",
    "count_overlaps",
    "measure_overlaps",
    "Overlaps",
    "nearest",
    "Nearest",
    "cluster",
    "merge",
    "Merged",
    "coverage",
    "PairFinder",
    "BroadPhase",
    "Filter",
    "Changes",
    "Lists",
    "Hit",
    "Hits",
    "Neighbors",
    "slots_of",
    "SweepAndPruneError",
    "InvalidBoxError",
    "StaleProxyError",
    "InvalidQueryError",
    "SnapshotError",
]


def __getattr__(name: str) -> str:
    """Looks up the version when it is asked for: that takes longer than the rest of the import."""
    if name != "__version__":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version("sweep-and-prune")
    except PackageNotFoundError:  # the package is used in place, not installed
        return "unknown"
