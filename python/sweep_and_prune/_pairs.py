"""Finds pairs: boxes in, all overlapping pairs out, nothing kept but buffers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike

from ._arrays import Floats, Pairs, box_rows, float_dtype, index_dtype, thread_count, whole
from ._native import Finder
from ._prepare import Prepared, prepare

_CHUNK = 65_536
_MAX_CHUNK = 2**24


def find_pairs(
    boxes: ArrayLike,
    *,
    threads: int | None = 1,
    dtype: DTypeLike = np.int64,
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    by: ArrayLike | None = None,
) -> Pairs:
    """Finds all pairs of boxes that overlap.

    Each pair occurs once, the smaller index first. The order of the pairs depends only on the boxes: it is the same
    on every machine and for any number of threads. To sort the pairs by index, use
    `pairs[np.lexsort(pairs.T[::-1])]`. Touching boxes overlap, unless `closed` says otherwise. Points, flat boxes and
    infinite edges are allowed.

    Time O(n log n + pairs) for typical inputs, memory O(n + pairs). The boxes are copied first. The search releases
    the GIL, and Ctrl-C stops it.

    Args:
        boxes: `(n, 2 * D)` numbers, D from 1 to 3: in each row the min corner and then the max corner, such as
            min x, min y, max x, max y. `float32` is compared in single precision; everything else as `float64`,
            but integers beyond 2^53 and `datetime64` exactly. Also accepted: `(n, 2, D)`; data frames and Arrow
            tables with columns such as `minx, miny, maxx, maxy`, `xmin ..`, `x1 ..`, `left ..` or `start, end`;
            arrays and series of shapely geometries (their bounds); an `IntervalIndex`; tensors.
        threads: how many to use at most, from 4,096 boxes on; -1 for one on each processor.
        dtype: the type of the indices: `int64`, `int32`, `uint32` or `uint64`.
        format: `"xyxy"`: min corner, max corner. `"xywh"`: min corner, size. `"cxcywh"`: center, size.
        closed: which ends belong to a box: `"both"` (the default: touching boxes overlap), `"left"`, `"right"` or
            `"neither"` (touching boxes do not overlap, and empty boxes overlap nothing). By default, an
            `IntervalIndex` decides.
        missing: `"raise"` refuses a box with a NaN, `"skip"` leaves it out: it has no pairs.
        by: `(n,)` values of any type: only boxes with equal values pair.

    Returns:
        `(m, 2)` indices of rows.

    Raises:
        InvalidBoxError: for the first box that is inverted or has a NaN.
        ValueError: for another shape, or unknown options.
        TypeError: if the boxes are not numbers.
        MemoryError: if the pairs do not fit in memory.

    >>> import sweep_and_prune as sap
    >>> sap.find_pairs([[0, 0, 2, 2], [5, 5, 6, 6], [2, 1, 3, 4]])  # the third touches the first
    array([[0, 2]])
    >>> sap.find_pairs([[0, 10], [10, 20], [15, 30]], closed="left")
    array([[1, 2]])
    >>> sap.find_pairs([[0, 10], [5, 20], [15, 30]], by=["chr1", "chr2", "chr2"])
    array([[1, 2]])
    """
    prepared = prepare({"boxes": boxes}, format, closed, missing, None if by is None else [by])
    return _find(prepared, threads, dtype)


def find_pairs_between(
    a: ArrayLike,
    b: ArrayLike,
    *,
    threads: int | None = 1,
    dtype: DTypeLike = np.int64,
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    by: tuple[ArrayLike, ArrayLike] | None = None,
) -> Pairs:
    """Finds all pairs of a box of `a` and a box of `b` that overlap.

    Each pair occurs once, in an order that depends only on the boxes. If one set is in double precision, both are
    compared in double precision. Cost and accepted inputs are those of `find_pairs`.

    Args:
        a: `(n, 2 * D)` numbers.
        b: `(k, 2 * D)` numbers.
        threads: how many to use at most; -1 for one on each processor.
        dtype: the type of the indices.
        format: `"xyxy"`, `"xywh"` or `"cxcywh"`, for both sets.
        closed: `"both"`, `"left"`, `"right"` or `"neither"`.
        missing: `"raise"` or `"skip"`.
        by: a pair of arrays, `(n,)` and `(k,)`: only boxes with equal values pair.

    Returns:
        `(m, 2)`: an index of a row of `a` and one of `b`.

    Raises:
        InvalidBoxError: for the first box that is inverted or has a NaN; its `argument` is `a` or `b`.
        ValueError: for other shapes, sets of different dimensions, or unknown options.
        TypeError: if the boxes are not numbers.
        MemoryError: if the pairs do not fit in memory.

    >>> import sweep_and_prune as sap
    >>> bullets = [[0, 0, 1, 1], [5, 5, 6, 6]]
    >>> targets = [[4, 4, 7, 7]]
    >>> sap.find_pairs_between(bullets, targets)
    array([[1, 0]])
    """
    prepared = prepare({"a": a, "b": b}, format, closed, missing, None if by is None else _two(by))
    return _find(prepared, threads, dtype)


def count_pairs(
    boxes: ArrayLike,
    *,
    threads: int | None = 1,
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    by: ArrayLike | None = None,
) -> int:
    """Counts the pairs that `find_pairs` finds, without storing them.

    (With `by` in three dimensions they are stored.) Takes less time than `find_pairs`, and memory O(n).

    Args:
        boxes: `(n, 2 * D)` numbers, or another form that `find_pairs` accepts.
        threads: how many to use at most; -1 for one on each processor.
        format: `"xyxy"`, `"xywh"` or `"cxcywh"`.
        closed: `"both"`, `"left"`, `"right"` or `"neither"`.
        missing: `"raise"` or `"skip"`.
        by: `(n,)` values: only boxes with equal values pair.

    Raises:
        InvalidBoxError, ValueError, TypeError: as `find_pairs`.

    >>> import numpy as np
    >>> import sweep_and_prune as sap
    >>> sap.count_pairs(np.zeros((1000, 6)))
    499500
    """
    prepared = prepare({"boxes": boxes}, format, closed, missing, None if by is None else [by])
    return _count(prepared, threads)


def count_pairs_between(
    a: ArrayLike,
    b: ArrayLike,
    *,
    threads: int | None = 1,
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    by: tuple[ArrayLike, ArrayLike] | None = None,
) -> int:
    """Counts the pairs that `find_pairs_between` finds, without storing them.

    Args:
        a: `(n, 2 * D)` numbers.
        b: `(k, 2 * D)` numbers.
        threads: how many to use at most; -1 for one on each processor.
        format: `"xyxy"`, `"xywh"` or `"cxcywh"`, for both sets.
        closed: `"both"`, `"left"`, `"right"` or `"neither"`.
        missing: `"raise"` or `"skip"`.
        by: a pair of arrays: only boxes with equal values pair.

    Raises:
        InvalidBoxError, ValueError, TypeError: as `find_pairs_between`.

    >>> import sweep_and_prune as sap
    >>> sap.count_pairs_between([[0, 2], [5, 6]], [[1, 7]])
    2
    """
    prepared = prepare({"a": a, "b": b}, format, closed, missing, None if by is None else _two(by))
    return _count(prepared, threads)


def for_each_chunk(
    boxes: ArrayLike, each: Callable[[Pairs], object], *, size: int = _CHUNK, dtype: DTypeLike = np.int64
) -> bool:
    """Calls a function with all pairs that `find_pairs` finds, in the same order, one chunk at a time.

    Use it for more pairs than fit in memory, or to stop early. Memory O(n + size). The boxes are copied first, so
    `each` may change them.

    Args:
        boxes: `(n, 2 * D)` numbers, or another form that `find_pairs` accepts.
        each: takes an array of shape `(m, 2)`, m from 1 to `size`. If it returns something false other than
            `None`, such as `False` or 0, the search stops.
        size: the number of pairs in each chunk but the last, at most 2^24.
        dtype: the type of the indices.

    Returns:
        Whether `each` never stopped the search.

    Raises:
        InvalidBoxError, ValueError, TypeError: as `find_pairs`, before the first call of `each`; and what `each`
            raises.

    >>> import numpy as np
    >>> import sweep_and_prune as sap
    >>> degrees = np.zeros(1000, int)
    >>> def count(pairs):
    ...     np.add.at(degrees, pairs, 1)
    >>> sap.for_each_chunk(np.zeros((1000, 2)), count)
    True
    >>> int(degrees.min()), int(degrees.max())
    (999, 999)
    """
    rows = box_rows(boxes, "boxes")
    return _stream(_finder(rows, 1), rows, None, each, size, index_dtype(dtype))


class PairFinder:
    """Finds pairs repeatedly, and keeps its buffers between calls.

    The pairs and their order are those of `find_pairs`, whatever it found before. Only one call runs at a time: a
    second thread, or a callback, needs its own finder and otherwise gets a `RuntimeError`. A finder can be copied and
    pickled; the copy has its own buffers.

    It keeps less than five times the memory of the boxes for typical inputs, and the pairs.

    >>> import numpy as np
    >>> import sweep_and_prune as sap
    >>> finder = sap.PairFinder(dimensions=2, dtype=np.float32)
    >>> boxes = np.array([[0, 0, 1, 1], [2, 0, 3, 1]], np.float32)
    >>> for frame in range(3):
    ...     print(len(finder.find(boxes)))
    ...     boxes[0, 2] += 0.5  # a right edge
    0
    0
    1
    """

    def __init__(
        self,
        dimensions: int = 3,
        dtype: DTypeLike = np.float64,
        *,
        threads: int | None = 1,
        index_dtype: DTypeLike = np.int64,
    ) -> None:
        """Creates a finder with empty buffers.

        Args:
            dimensions: 1, 2 or 3.
            dtype: `float32` or `float64`, in which boxes are compared. Others are converted in each call, which
                rounds `float64` to `float32`.
            threads: how many to use at most, from 4,096 boxes on; -1 for one on each processor.
            index_dtype: the type of the indices: `int64`, `int32`, `uint32` or `uint64`.

        Raises:
            ValueError, TypeError: for other dimensions or types.
        """
        self._dimensions = whole(dimensions, "dimensions", 1, 3)
        self._dtype = float_dtype(dtype)
        self._threads = thread_count(threads)
        self._index = _index_dtype(index_dtype)
        self._finder = self._native()

    def _native(self) -> Finder:
        return Finder(self._dimensions, self._dtype.itemsize == 8, self._threads)

    @property
    def dimensions(self) -> int:
        """The number of dimensions of the boxes."""
        return self._dimensions

    @property
    def dtype(self) -> np.dtype[Any]:
        """The precision in which boxes are compared."""
        return self._dtype

    def find(self, boxes: ArrayLike) -> Pairs:
        """Finds all pairs of boxes that overlap, as `find_pairs` does.

        Args:
            boxes: `(n, 2 * dimensions)` numbers.

        Raises:
            InvalidBoxError, ValueError, TypeError, MemoryError: as `find_pairs`. The finder stays usable.

        >>> import sweep_and_prune as sap
        >>> sap.PairFinder(dimensions=1).find([[0, 2], [5, 6], [2, 3]])
        array([[0, 2]])
        """
        return self._finder.find(self._rows(boxes, "boxes"), None, self._index)

    def find_between(self, a: ArrayLike, b: ArrayLike) -> Pairs:
        """Finds all pairs of a box of `a` and a box of `b` that overlap, as `find_pairs_between` does.

        Args:
            a: `(n, 2 * dimensions)` numbers.
            b: `(k, 2 * dimensions)` numbers.

        Raises:
            InvalidBoxError, ValueError, TypeError, MemoryError: as `find_pairs_between`.

        >>> import sweep_and_prune as sap
        >>> sap.PairFinder(dimensions=1).find_between([[0, 2], [5, 6]], [[6, 7]])
        array([[1, 0]])
        """
        return self._finder.find(self._rows(a, "a"), self._rows(b, "b"), self._index)

    def count(self, boxes: ArrayLike) -> int:
        """Counts the pairs that `find` finds, without storing them.

        Args:
            boxes: `(n, 2 * dimensions)` numbers.

        Raises:
            InvalidBoxError, ValueError, TypeError: as `find_pairs`.

        >>> import sweep_and_prune as sap
        >>> sap.PairFinder(dimensions=1).count([[0, 2], [5, 6], [2, 3]])
        1
        """
        return self._finder.count(self._rows(boxes, "boxes"))

    def count_between(self, a: ArrayLike, b: ArrayLike) -> int:
        """Counts the pairs that `find_between` finds, without storing them.

        Args:
            a: `(n, 2 * dimensions)` numbers.
            b: `(k, 2 * dimensions)` numbers.

        Raises:
            InvalidBoxError, ValueError, TypeError: as `find_pairs_between`.

        >>> import sweep_and_prune as sap
        >>> sap.PairFinder(dimensions=1).count_between([[0, 2], [5, 6]], [[1, 7]])
        2
        """
        return self._finder.count(self._rows(a, "a"), self._rows(b, "b"))

    def for_each_chunk(self, boxes: ArrayLike, each: Callable[[Pairs], object], *, size: int = _CHUNK) -> bool:
        """Calls a function with the pairs that `find` finds, in the same order, one chunk at a time.

        Within `each` this finder cannot be used; others can.

        Args:
            boxes: `(n, 2 * dimensions)` numbers.
            each: takes an array of shape `(m, 2)`. If it returns something false other than `None`, the search
                stops.
            size: the number of pairs in each chunk but the last, at most 2^24.

        Returns:
            Whether `each` never stopped the search.

        Raises:
            InvalidBoxError, ValueError, TypeError: as `find_pairs`; and what `each` raises.

        >>> import sweep_and_prune as sap
        >>> sap.PairFinder(dimensions=1).for_each_chunk([[0, 9], [1, 2], [3, 4]], print, size=1)
        [[0 1]]
        [[0 2]]
        True
        """
        return _stream(self._finder, self._rows(boxes, "boxes"), None, each, size, self._index)

    def for_each_chunk_between(
        self, a: ArrayLike, b: ArrayLike, each: Callable[[Pairs], object], *, size: int = _CHUNK
    ) -> bool:
        """Calls a function with the pairs that `find_between` finds, in the same order, one chunk at a time.

        Args:
            a: `(n, 2 * dimensions)` numbers.
            b: `(k, 2 * dimensions)` numbers.
            each: takes an array of shape `(m, 2)`. If it returns something false other than `None`, the search
                stops.
            size: the number of pairs in each chunk but the last, at most 2^24.

        Returns:
            Whether `each` never stopped the search.

        Raises:
            InvalidBoxError, ValueError, TypeError: as `find_between`; and what `each` raises.

        >>> import sweep_and_prune as sap
        >>> sap.PairFinder(dimensions=1).for_each_chunk_between([[0, 9]], [[1, 2], [3, 4]], print)
        [[0 0]
         [0 1]]
        True
        """
        return _stream(self._finder, self._rows(a, "a"), self._rows(b, "b"), each, size, self._index)

    def __getstate__(self) -> dict[str, Any]:
        """Everything but the buffers, which a copy creates itself."""
        return {key: value for key, value in vars(self).items() if key != "_finder"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Restores a copy, with empty buffers."""
        vars(self).update(state)
        self._finder = self._native()

    def __repr__(self) -> str:
        """Shows the arguments with which it was created."""
        return f"PairFinder(dimensions={self._dimensions}, dtype={self._dtype})"

    def _rows(self, boxes: ArrayLike, name: str) -> Floats:
        return box_rows(boxes, name, self._dtype, self._dimensions)


_index_dtype = index_dtype


def _find(prepared: Prepared, threads: int | None, dtype: DTypeLike) -> Pairs:
    index = index_dtype(dtype)
    return prepared.translate(_finder(prepared.sets[0], threads).find(*_arguments(prepared), index))


def _count(prepared: Prepared, threads: int | None) -> int:
    if prepared.groups is not None:
        return len(_find(prepared, threads, np.int64))
    return _finder(prepared.sets[0], threads).count(*_arguments(prepared))


def _arguments(prepared: Prepared) -> tuple[Floats, Floats | None]:
    return prepared.sets[0], prepared.sets[1] if len(prepared.sets) == 2 else None


def _two(by: tuple[ArrayLike, ArrayLike]) -> list[ArrayLike]:
    if not (isinstance(by, (tuple, list)) and len(by) == 2):
        raise ValueError("by must be a pair of arrays: one for a, one for b")
    return list(by)


def _finder(rows: Floats, threads: int | None) -> Finder:
    return Finder(rows.shape[1] // 2, rows.dtype.itemsize == 8, thread_count(threads))


def _stream(
    finder: Finder, a: Floats, b: Floats | None, each: Callable[[Pairs], object], size: int, index: str
) -> bool:
    if not callable(each):
        raise TypeError(f"each must be callable, not a {type(each).__name__}")
    return finder.for_each_chunk(a, b, each, whole(size, "size", 1, _MAX_CHUNK), index)
