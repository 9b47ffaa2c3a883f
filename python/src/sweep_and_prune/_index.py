"""The static index: built once over boxes that do not move, then searched."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._arrays import Ids, box_rows, real, row, thread_count, whole
from ._broad_phase import Hit, Hits, Neighbors
from ._errors import InvalidQueryError

Predicate = Callable[[int], object]
"""Says of the index of a box whether to keep it."""

_MOST = 2**63 - 1


class Index:
    """A static index: built once over boxes that do not move, it finds those that overlap a box, that are nearest to a
    point, or that a ray hits. Boxes are named by their row in what it was built from.

    For boxes that move, use `BroadPhase`; for all overlapping pairs, `find_pairs`. An index never changes, so several
    threads can search it at once. It can be pickled.

    >>> import sweep_and_prune as sap
    >>> index = sap.Index([[0, 0, 2, 2], [5, 5, 6, 6], [2, 1, 3, 4]])
    >>> sorted(index.search([1, 1, 2, 2]).tolist())  # touching boxes overlap
    [0, 2]
    >>> index.neighbors([4, 4], k=1)
    Neighbors(ids=array([2]), distances=array([1.]))
    """

    __slots__ = ("_index",)

    _index: _native.Index

    def __init__(self, boxes: ArrayLike, *, format: str = "xyxy") -> None:
        """Builds the index. Time O(n log n).

        Args:
            boxes: `(n, 2 * D)` numbers or another form that `find_pairs` accepts. An index of `float32` is of single
                precision: the areas and points of its queries are rounded to that. Any other is of double precision.
            format: `"xyxy"`, `"xywh"` or `"cxcywh"`.

        Raises:
            InvalidBoxError: for the first box that is inverted or has a NaN.
            ValueError: for another shape.
            TypeError: if the boxes are not numbers.
            MemoryError: if the index does not fit in memory.
        """
        rows = box_rows(boxes, "boxes", None, 0, format)
        self._index = _native.Index(rows, rows.shape[1] // 2, rows.dtype == np.float64)

    @classmethod
    def from_buffer(cls, data: bytes | bytearray | memoryview) -> Index:
        """An index from the `data` of one, without building it again. `bytes` are not even copied.

        Any bytes are safe, but those of a damaged file may find wrong boxes: there is no checksum.

        Args:
            data: the bytes, or another object with a buffer, which is copied.

        Raises:
            IndexDataError: if they do not begin as the bytes of an index do, or have another length.
            TypeError: if `data` has no buffer.

        >>> import sweep_and_prune as sap
        >>> stored = sap.Index([[0, 1], [2, 3]]).data
        >>> sap.Index.from_buffer(stored).search([1, 1])
        array([0])
        """
        if not isinstance(data, bytes):
            data = memoryview(data).tobytes()
        index = object.__new__(cls)
        index._index = _native.Index.from_bytes(data)
        return index

    @property
    def data(self) -> bytes:
        """The bytes of the index, to store or send: the same on every machine, and in Rust and JavaScript.

        >>> import sweep_and_prune as sap
        >>> index = sap.Index([[0, 1], [2, 3]])
        >>> sap.Index.from_buffer(index.data).data == index.data
        True
        """
        return self._index.data()

    @property
    def dimensions(self) -> int:
        """How many dimensions the boxes have."""
        return self._index.kind()[0]

    @property
    def dtype(self) -> np.dtype[Any]:
        """The precision of the boxes, `float32` or `float64`."""
        return np.dtype(np.float64 if self._index.kind()[1] else np.float32)

    def __len__(self) -> int:
        """How many boxes there are."""
        return len(self._index)

    def search(self, box: ArrayLike, *, limit: int | None = None, predicate: Predicate | None = None) -> Ids:
        """The boxes that overlap a box, in no particular order, but the same on every machine.

        Args:
            box: `2 * D` numbers: min corner, max corner.
            limit: at most so many are found; which ones is not defined.
            predicate: called with the index of one box after another, until `limit` are kept.

        Returns:
            `(n,)` indices.

        Raises:
            InvalidBoxError: if the box is inverted or has a NaN.
            ValueError: for another shape, or a negative limit.

        >>> import sweep_and_prune as sap
        >>> index = sap.Index([[0, 2], [1, 3], [2, 4], [7, 8]])
        >>> sorted(index.search([2, 5], predicate=lambda box: box % 2 == 0).tolist())
        [0, 2]
        """
        area = row(box, "box", np.dtype(np.float64), 2 * self.dimensions)
        most = None if limit is None else whole(limit, "limit", 0, _MOST)
        if predicate is None:
            return self._index.search(area, most)
        found = self._index.search(area, None)
        return _kept(found, predicate, most)

    def search_many(self, boxes: ArrayLike, *, threads: int | None = 1, format: str = "xyxy") -> NDArray[np.int64]:
        """What `search` finds for each of many boxes, in the form of shapely's `STRtree.query`.

        Args:
            boxes: `(n, 2 * D)` numbers, or another form that `find_pairs` accepts.
            threads: how many to use at most, from 4,096 boxes on; -1 for one on each processor.
            format: `"xyxy"`, `"xywh"` or `"cxcywh"`.

        Returns:
            `(2, m)`: a row of positions in `boxes`, ascending, and a row of indices of boxes that these overlap.

        Raises:
            InvalidBoxError: for the first box that is inverted or has a NaN.
            ValueError: for another shape.
            TypeError: if the boxes are not numbers.

        >>> import sweep_and_prune as sap
        >>> index = sap.Index([[0, 2], [3, 5]])
        >>> index.search_many([[4, 6], [6, 7], [1, 2]])
        array([[0, 2],
               [1, 0]])
        """
        rows = box_rows(boxes, "boxes", self.dtype, self.dimensions, format)
        return self._index.search_many(rows, thread_count(threads))

    def neighbors(
        self,
        point: ArrayLike,
        k: int | None = None,
        *,
        max_distance: float = np.inf,
        predicate: Predicate | None = None,
    ) -> Neighbors:
        """The `k` boxes nearest to a point, or all if there are fewer, sorted by distance and then by index.

        Args:
            point: `D` finite numbers.
            k: how many; None for all.
            max_distance: boxes farther away are not found.
            predicate: called with the index of one box after another, the nearest first, until `k` are kept.

        Returns:
            The indices as `ids`, and the distances from the point to the boxes, 0 for a box that contains it.

        Raises:
            InvalidQueryError: if the point is not finite, or the distance is negative or NaN.
            ValueError: for another shape, or a negative `k`.

        >>> import sweep_and_prune as sap
        >>> index = sap.Index([[0, 2], [3, 5], [9, 9]])
        >>> index.neighbors([6], max_distance=3)
        Neighbors(ids=array([1, 2]), distances=array([1., 3.]))
        """
        at = self._point(point, "point")
        most = len(self) if k is None else min(whole(k, "k", 0, _MOST), len(self))
        distance = real(max_distance, "max_distance")
        if not distance >= 0:
            raise InvalidQueryError(0, "max_distance", distance, "0 or more")
        asked = most
        while True:
            ids, squared = self._index.neighbors(at, asked, distance)
            if predicate is None:
                return Neighbors(ids, np.sqrt(squared))
            kept = _mask(ids, predicate, most)
            if kept.sum() >= most or len(ids) < asked or asked == len(self):
                return Neighbors(ids[kept], np.sqrt(squared[kept]))
            asked = min(2 * asked + 16, len(self))

    def ray_cast(self, origin: ArrayLike, direction: ArrayLike, *, limit: float = np.inf) -> Hit | None:
        """The box that a ray hits first; of several at once that with the smallest index.

        Args:
            origin: `D` finite numbers.
            direction: `D` finite numbers, of any length. If its length is 1, t is a distance.
            limit: the largest t.

        Returns:
            Its index as `id`, and t: the hit is at `origin + t * direction`. None if there is none.

        Raises:
            InvalidQueryError: if the origin or direction is not finite, or the limit negative or NaN.
            ValueError: for another shape.

        >>> import sweep_and_prune as sap
        >>> index = sap.Index([[5, -1, 6, 1], [3, 1, 4, 2]])
        >>> index.ray_cast([0, 0], [1, 0])
        Hit(id=0, t=5.0)
        """
        ids, t = self._ray(origin, direction, limit, False)
        return Hit(int(ids[0]), float(t[0])) if len(ids) else None

    def ray_cast_all(self, origin: ArrayLike, direction: ArrayLike, *, limit: float = np.inf) -> Hits:
        """All boxes that a ray hits, nearest first, and by index where it hits several at once.

        Args:
            origin: `D` finite numbers.
            direction: `D` finite numbers.
            limit: the largest t.

        Returns:
            The indices as `ids`, and t of each.

        Raises:
            InvalidQueryError: if the origin or direction is not finite, or the limit negative or NaN.
            ValueError: for another shape.

        >>> import sweep_and_prune as sap
        >>> sap.Index([[5, -1, 6, 1], [2, 0, 2, 0]]).ray_cast_all([0, 0], [1, 0])
        Hits(ids=array([1, 0]), t=array([2., 5.]))
        """
        return Hits(*self._ray(origin, direction, limit, True))

    def segment(self, start: ArrayLike, end: ArrayLike) -> Hits:
        """All boxes that the line segment between two points meets, both ends included, nearest to `start` first.

        Args:
            start: `D` finite numbers.
            end: `D` finite numbers.

        Returns:
            The indices as `ids`, and t of each: 0 at `start` and 1 at `end`.

        Raises:
            InvalidQueryError: if a point is not finite.
            ValueError: for another shape.

        >>> import sweep_and_prune as sap
        >>> sap.Index([[8, 4, 9, 5], [2, 0, 3, 3]]).segment([0, 0], [8, 4])
        Hits(ids=array([1, 0]), t=array([0.25, 1.  ]))
        """
        ends = np.hstack([self._point(start, "start"), self._point(end, "end")])
        return Hits(*self._index.cast(ends, None, True))

    def __reduce__(self) -> tuple[Callable[[bytes], Index], tuple[bytes]]:
        """Pickles the index as its bytes."""
        return type(self).from_buffer, (self.data,)

    def __repr__(self) -> str:
        """Names the number of boxes, their dimensions and precision."""
        return f"<Index of {len(self)} boxes, {self.dimensions}D, {self.dtype.name}>"

    def _ray(self, origin: ArrayLike, direction: ArrayLike, limit: float, all: bool) -> tuple[Ids, NDArray[np.float64]]:
        ray = np.hstack([self._point(origin, "origin"), self._point(direction, "direction")])
        most = real(limit, "limit")
        if not most >= 0:
            raise InvalidQueryError(0, "limit", most, "0 or more")
        return self._index.cast(ray, most, all)

    def _point(self, values: ArrayLike, name: str) -> Any:
        point = row(values, name, np.dtype(np.float64), self.dimensions)
        with np.errstate(over="ignore"):
            is_finite = np.isfinite(point.astype(self.dtype))
        if not is_finite.all():
            raise InvalidQueryError(0, name, float(point[~is_finite][0]), f"finite, in {self.dtype.name}")
        return point


def _mask(ids: Ids, predicate: Predicate, most: int | None) -> NDArray[np.bool_]:
    """Which of the first of some boxes the predicate keeps, until it has kept so many."""
    kept = np.zeros(len(ids), bool)
    count = 0
    for at, index in enumerate(ids.tolist()):
        if count == most:
            break
        if predicate(index):
            kept[at] = True
            count += 1
    return kept


def _kept(ids: Ids, predicate: Predicate, most: int | None) -> Ids:
    return ids[_mask(ids, predicate, most)]
