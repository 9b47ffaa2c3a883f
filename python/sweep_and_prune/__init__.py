"""Which boxes overlap? All pairs of a set of axis-aligned boxes, in one, two or three dimensions, from arrays of
NumPy; or a living world of bodies that tells which overlaps begin and which end.

>>> import numpy as np
>>> import sweep_and_prune as sap
>>> boxes = np.array([
...     [0, 0, 2, 2],  # min x, min y, max x, max y
...     [5, 5, 6, 6],
...     [2, 1, 3, 4],  # touches the first box: that is an overlap
... ], dtype=np.float32)
>>> sap.find_pairs(boxes)
array([[0, 2]], dtype=uint32)

- Intervals are closed: touching boxes overlap. Points, flat boxes and infinite edges are boxes, and `-0.0` equals
  `0.0`. There is no epsilon.
- Each pair comes once, smaller index first, in an order that is the same on every machine.
- A box that is inverted or NaN is refused with an error that names its index; after an error nothing has changed.
- Arrays that are returned are copies of your own. In signatures `Pairs` are arrays of `uint32`, `Ids` of `uint64`,
  `Floats` of `float32` or `float64`.

| you have | call |
|---|---|
| boxes, once | `find_pairs` |
| two sets: bullets and targets, two tables to join | `find_pairs_between` |
| a question that only needs a number | `count_pairs` |
| more pairs than should be stored, or a search that ends early | `for_each_chunk` |
| any of these every frame | `PairFinder` |
| bodies of which most rest; what began, what ended; queries and rays | `BroadPhase` |
"""

from importlib.metadata import PackageNotFoundError as _PackageNotFoundError
from importlib.metadata import version as _version

from ._broad_phase import BroadPhase, Changes, Hit, Hits, Lists, Neighbours, slots_of
from ._errors import (
    InvalidBoxError,
    InvalidQueryError,
    SnapshotError,
    StaleProxyError,
    SweepAndPruneError,
)
from ._filter import Filter
from ._pairs import PairFinder, count_pairs, find_pairs, find_pairs_between, for_each_chunk

try:
    __version__ = _version("sweep-and-prune")
except _PackageNotFoundError:  # used in place, not installed
    __version__ = "unknown"

# In the order in which they are read about.
__all__ = [  # noqa: RUF022
    "find_pairs",
    "find_pairs_between",
    "count_pairs",
    "for_each_chunk",
    "PairFinder",
    "BroadPhase",
    "Filter",
    "Changes",
    "Lists",
    "Hit",
    "Hits",
    "Neighbours",
    "slots_of",
    "SweepAndPruneError",
    "InvalidBoxError",
    "StaleProxyError",
    "InvalidQueryError",
    "SnapshotError",
]
