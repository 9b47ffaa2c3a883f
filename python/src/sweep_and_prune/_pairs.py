"""Finds pairs: boxes in, all overlapping pairs out, nothing kept but buffers."""

from __future__ import annotations

import atexit
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from datetime import timedelta
from queue import Empty, Queue
from threading import Thread, get_ident, local
from typing import Any, TypeVar, Union

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from ._arrays import Boxes, Floats, Pairs, box_rows, float_dtype, index_dtype, thread_count, whole
from ._native import Finder
from ._prepare import NAME, Prepared, is_zero, prepare
from ._state import attributes, set_attributes

Margin = Union[ArrayLike, timedelta]
"""A distance: a number, one for each axis, or a `timedelta`."""
Groups = Union[ArrayLike, Sequence[object], Mapping[Any, Any]]
"""What boxes are grouped by: a value for each box, columns of such values, or the names of columns."""
Progress = Callable[[float], object]
"""A function of the share of the work that is done, from 0 to 1."""

_CHUNK = 65_536
_MAX_CHUNK = 2**24

_KEPT_BYTES = 64 * 2**20
"""A thread keeps the buffers of its last search, if its boxes took at most so much memory: to get new memory from the
system takes about as long as the search."""
_idle = local()

_exiting: list[int] = []
"""The thread that exits, once the compiled part lets no other one go on."""
# Called just before the compiled part stops the others, since it is registered later.
atexit.register(lambda: _exiting.append(get_ident()))


def find_pairs(
    boxes: Boxes,
    *,
    threads: int | None = 1,
    dtype: DTypeLike = np.int64,
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    by: Groups | None = None,
    margin: Margin = 0,
    wrap: float | None = None,
    progress: Progress | None = None,
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
            but integers beyond 2^53 and `datetime64` exactly. Also accepted: `(n, 2, D)`; data frames, Arrow
            tables, dicts and structured arrays with columns such as `minx, miny, maxx, maxy`, `xmin ..`, `x1 ..`,
            `left ..` or `start, end`; arrays and series of shapely geometries (their bounds); an `IntervalIndex` or a
            series of intervals; tensors.
        threads: how many to use at most, from 4,096 boxes on; -1 for one on each processor.
        dtype: the type of the indices: `int64`, `int32`, `uint32` or `uint64`.
        format: `"xyxy"`: min corner, max corner. `"xywh"`: min corner, size. `"cxcywh"`: center, size. In each,
            six columns of an array are boxes in space: slice off scores and classes first.
        closed: which ends belong to a box: `"both"` (the default: touching boxes overlap), `"left"`, `"right"` or
            `"neither"` (touching boxes do not overlap, and empty boxes overlap nothing). By default, an
            `IntervalIndex` decides.
        missing: `"raise"` refuses a box with a NaN, `"skip"` leaves it out: it has no pairs.
        by: only boxes with equal values pair: `(n,)` values of any type; a data frame, dict or structured array of
            several keys; or the name of a column of the boxes' own data frame, or a list of names. A box whose value
            is missing pairs with none.
        margin: finds boxes within this distance of each other on each axis, too. One number for all axes, or D of
            them; a `timedelta` for times. On each axis `min <= other max + margin` holds for both boxes, where the
            sum is rounded to the precision of the boxes.
        wrap: the length of axis 0 if it is a circle, such as 360 for longitude: coordinates that differ by it are the
            same, and a box whose min is greater than its max crosses the end. (From -inf to inf is all of it.)
        progress: called about 50 times a second with the share of the work that is done, from 0 to 1, and with 1
            at the end. An exception that it raises ends the search. Short searches only call it at the end.

    Returns:
        `(m, 2)` indices of rows.

    Raises:
        InvalidBoxError: for the first box that is inverted or has a NaN.
        ValueError: for another shape, or unknown options.
        TypeError: if the boxes are not numbers.
        MemoryError: if the pairs do not fit in memory. A large `int64` result takes at most 1.2 times its size while
            it is found (on Linux with glibc), and besides less than five times the size of the boxes: buffers, which
            the thread keeps until its next search if the boxes take at most 64 MiB. Repeated calls are faster so.

    >>> import sweep_and_prune as sap
    >>> sap.find_pairs([[0, 0, 2, 2], [5, 5, 6, 6], [2, 1, 3, 4]])  # the third touches the first
    array([[0, 2]])
    >>> sap.find_pairs([[0, 10], [10, 20], [15, 30]], closed="left")
    array([[1, 2]])
    >>> sap.find_pairs([[0, 10], [5, 20], [15, 30]], by=["chr1", "chr2", "chr2"])
    array([[1, 2]])
    >>> sap.find_pairs([[0, 10], [12, 20], [23, 30]], margin=2)
    array([[0, 1]])
    """
    prepared = one_set(boxes, format, closed, missing, by, margin, wrap, fold=True)
    return find(prepared, threads, dtype, progress)


def find_pairs_between(
    a: Boxes,
    b: Boxes,
    *,
    threads: int | None = 1,
    dtype: DTypeLike = np.int64,
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    by: Groups | tuple[Groups, Groups] | None = None,
    margin: Margin = 0,
    wrap: float | None = None,
    progress: Progress | None = None,
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
        by: only boxes with equal values pair: a pair of arrays, `(n,)` and `(k,)`; or of data frames the name of a
            column of both, or a list of names, or a pair of these. A tuple is always a pair: `("x", "y")` compares
            column x of `a` with column y of `b`. A box whose value is missing pairs with none.
        margin: finds boxes within this distance on each axis, too.
        wrap: the length of axis 0 if it is a circle, as in `find_pairs`.
        progress: called with the share of the work that is done, from 0 to 1.

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
    prepared = two_sets(a, b, format, closed, missing, by, margin, wrap, fold=True)
    return find(prepared, threads, dtype, progress)


def count_pairs(
    boxes: Boxes,
    *,
    threads: int | None = 1,
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    by: Groups | None = None,
    margin: Margin = 0,
    wrap: float | None = None,
    progress: Progress | None = None,
) -> int:
    """Counts the pairs that `find_pairs` finds, without storing them.

    (With `by` in three dimensions they are stored.) Takes less time than `find_pairs`, and memory O(n).

    Args:
        boxes: `(n, 2 * D)` numbers, or another form that `find_pairs` accepts.
        threads: how many to use at most; -1 for one on each processor.
        format: `"xyxy"`, `"xywh"` or `"cxcywh"`.
        closed: `"both"`, `"left"`, `"right"` or `"neither"`.
        missing: `"raise"` or `"skip"`.
        by: `(n,)` values, or columns, as in `find_pairs`: only boxes with equal values pair.
        margin: counts boxes within this distance on each axis, too.
        wrap: the length of axis 0 if it is a circle, as in `find_pairs`.
        progress: called with the share of the work that is done, from 0 to 1.

    Raises:
        InvalidBoxError, ValueError, TypeError: as `find_pairs`.

    >>> import numpy as np
    >>> import sweep_and_prune as sap
    >>> sap.count_pairs(np.zeros((1000, 6)))
    499500
    """
    prepared = one_set(boxes, format, closed, missing, by, margin, wrap, fold=True)
    return _count(prepared, threads, progress)


def count_pairs_between(
    a: Boxes,
    b: Boxes,
    *,
    threads: int | None = 1,
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    by: Groups | tuple[Groups, Groups] | None = None,
    margin: Margin = 0,
    wrap: float | None = None,
    progress: Progress | None = None,
) -> int:
    """Counts the pairs that `find_pairs_between` finds, without storing them.

    Args:
        a: `(n, 2 * D)` numbers.
        b: `(k, 2 * D)` numbers.
        threads: how many to use at most; -1 for one on each processor.
        format: `"xyxy"`, `"xywh"` or `"cxcywh"`, for both sets.
        closed: `"both"`, `"left"`, `"right"` or `"neither"`.
        missing: `"raise"` or `"skip"`.
        by: a pair of arrays, or columns of both, as in `find_pairs_between`: only boxes with equal values pair.
        margin: counts boxes within this distance on each axis, too.
        wrap: the length of axis 0 if it is a circle, as in `find_pairs`.
        progress: called with the share of the work that is done, from 0 to 1.

    Raises:
        InvalidBoxError, ValueError, TypeError: as `find_pairs_between`.

    >>> import sweep_and_prune as sap
    >>> sap.count_pairs_between([[0, 2], [5, 6]], [[1, 7]])
    2
    """
    prepared = two_sets(a, b, format, closed, missing, by, margin, wrap, fold=True)
    return _count(prepared, threads, progress)


def for_each_chunk(
    boxes: Boxes,
    each: Callable[[Pairs], object],
    *,
    size: int = _CHUNK,
    dtype: DTypeLike = np.int64,
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    by: Groups | None = None,
    margin: Margin = 0,
) -> bool:
    """Calls a function with all pairs that `find_pairs` finds, in the same order, one chunk at a time.

    Use it for more pairs than fit in memory, or to stop early. Memory O(n + size). The boxes are copied first, so
    `each` may change them. One thread.

    Args:
        boxes: `(n, 2 * D)` numbers, or another form that `find_pairs` accepts.
        each: takes an array of shape `(m, 2)`, m from 1 to `size`. If it returns something false other than
            `None`, such as `False` or 0, the search stops.
        size: the number of pairs in each chunk but the last, at most 2^24. (With `by` in three dimensions, chunks
            may be smaller.)
        dtype: the type of the indices.
        format: `"xyxy"`, `"xywh"` or `"cxcywh"`.
        closed: `"both"`, `"left"`, `"right"` or `"neither"`.
        missing: `"raise"` or `"skip"`.
        by: `(n,)` values, or columns, as in `find_pairs`: only boxes with equal values pair.
        margin: finds boxes within this distance on each axis, too.

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
    prepared = one_set(boxes, format, closed, missing, by, margin, fold=True)
    return stream(prepared, each, size, dtype)


def for_each_chunk_between(
    a: Boxes,
    b: Boxes,
    each: Callable[[Pairs], object],
    *,
    size: int = _CHUNK,
    dtype: DTypeLike = np.int64,
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    by: Groups | tuple[Groups, Groups] | None = None,
    margin: Margin = 0,
) -> bool:
    """Calls a function with all pairs that `find_pairs_between` finds, in the same order, one chunk at a time.

    Otherwise as `for_each_chunk`.

    Args:
        a: `(n, 2 * D)` numbers.
        b: `(k, 2 * D)` numbers.
        each: takes an array of shape `(m, 2)`. If it returns something false other than `None`, the search stops.
        size: the number of pairs in each chunk but the last, at most 2^24.
        dtype: the type of the indices.
        format: `"xyxy"`, `"xywh"` or `"cxcywh"`, for both sets.
        closed: `"both"`, `"left"`, `"right"` or `"neither"`.
        missing: `"raise"` or `"skip"`.
        by: a pair of arrays, or columns of both, as in `find_pairs_between`: only boxes with equal values pair.
        margin: finds boxes within this distance on each axis, too.

    Returns:
        Whether `each` never stopped the search.

    Raises:
        InvalidBoxError, ValueError, TypeError: as `find_pairs_between`; and what `each` raises.

    >>> import sweep_and_prune as sap
    >>> sap.for_each_chunk_between([[0, 9]], [[1, 2], [3, 4]], print)
    [[0 0]
     [0 1]]
    True
    """
    prepared = two_sets(a, b, format, closed, missing, by, margin, fold=True)
    return stream(prepared, each, size, dtype)


def iter_chunks(
    boxes: Boxes,
    *,
    size: int = _CHUNK,
    dtype: DTypeLike = np.int64,
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    by: Groups | None = None,
    margin: Margin = 0,
    wrap: float | None = None,
) -> Iterator[Pairs]:
    """Iterates over all pairs that `find_pairs` finds, in the same order, one chunk at a time.

    What `for_each_chunk` is for a function, this is for a loop. The search runs in a thread of its own, at most three
    chunks ahead, and ends with the loop. Memory O(n + size).

    Args:
        boxes: `(n, 2 * D)` numbers, or another form that `find_pairs` accepts.
        size: the number of pairs in each chunk but the last, at most 2^24. (With `wrap`, and with `by` in three
            dimensions, chunks may be smaller.)
        dtype: the type of the indices.
        format: `"xyxy"`, `"xywh"` or `"cxcywh"`.
        closed: `"both"`, `"left"`, `"right"` or `"neither"`.
        missing: `"raise"` or `"skip"`.
        by: `(n,)` values, or columns, as in `find_pairs`: only boxes with equal values pair.
        margin: finds boxes within this distance on each axis, too.
        wrap: the length of axis 0 if it is a circle, as in `find_pairs`.

    Returns:
        An iterator over arrays of shape `(m, 2)`, m from 1 to `size`.

    Raises:
        InvalidBoxError, ValueError, TypeError: as `find_pairs`, at the latest with the first chunk.
        RuntimeError: while the interpreter exits, when no other thread can search. `for_each_chunk` can.

    >>> import numpy as np
    >>> import sweep_and_prune as sap
    >>> for pairs in sap.iter_chunks(np.zeros((1000, 2)), size=200_000):
    ...     print(len(pairs))
    200000
    200000
    99500
    """
    prepared = one_set(boxes, format, closed, missing, by, margin, wrap, fold=True)
    return _iterate(prepared, size, dtype)


def iter_chunks_between(
    a: Boxes,
    b: Boxes,
    *,
    size: int = _CHUNK,
    dtype: DTypeLike = np.int64,
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    by: Groups | tuple[Groups, Groups] | None = None,
    margin: Margin = 0,
    wrap: float | None = None,
) -> Iterator[Pairs]:
    """Iterates over all pairs that `find_pairs_between` finds, in the same order, one chunk at a time.

    Otherwise as `iter_chunks`.

    Args:
        a: `(n, 2 * D)` numbers.
        b: `(k, 2 * D)` numbers.
        size: the number of pairs in each chunk but the last, at most 2^24.
        dtype: the type of the indices.
        format: `"xyxy"`, `"xywh"` or `"cxcywh"`, for both sets.
        closed: `"both"`, `"left"`, `"right"` or `"neither"`.
        missing: `"raise"` or `"skip"`.
        by: a pair of arrays, or columns of both, as in `find_pairs_between`: only boxes with equal values pair.
        margin: finds boxes within this distance on each axis, too.
        wrap: the length of axis 0 if it is a circle, as in `find_pairs`.

    Returns:
        An iterator over arrays of shape `(m, 2)`, m from 1 to `size`.

    Raises:
        InvalidBoxError, ValueError, TypeError: as `find_pairs_between`, at the latest with the first chunk.

    >>> import sweep_and_prune as sap
    >>> for pairs in sap.iter_chunks_between([[0, 9]], [[1, 2], [3, 4]]):
    ...     print(pairs.tolist())
    [[0, 0], [0, 1]]
    """
    prepared = two_sets(a, b, format, closed, missing, by, margin, wrap, fold=True)
    return _iterate(prepared, size, dtype)


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

    def find(self, boxes: Boxes, *, margin: Margin = 0, progress: Progress | None = None) -> Pairs:
        """Finds all pairs of boxes that overlap, as `find_pairs` does.

        Args:
            boxes: `(n, 2 * dimensions)` numbers.
            margin: finds boxes within this distance on each axis, too, as in `find_pairs`.
            progress: called with the share of the work that is done, from 0 to 1.

        Raises:
            InvalidBoxError, ValueError, TypeError, MemoryError: as `find_pairs`. The finder stays usable.

        >>> import sweep_and_prune as sap
        >>> sap.PairFinder(dimensions=1).find([[0, 2], [5, 6], [2, 3]])
        array([[0, 2]])
        >>> sap.PairFinder(dimensions=1).count([[0, 2], [5, 6], [2, 3]], margin=2)
        2
        """
        return _done(
            self._finder.find(self._rows(boxes, "boxes", margin), None, None, False, self._index, _checked(progress)),
            progress,
        )

    def find_between(self, a: Boxes, b: Boxes, *, margin: Margin = 0, progress: Progress | None = None) -> Pairs:
        """Finds all pairs of a box of `a` and a box of `b` that overlap, as `find_pairs_between` does.

        Args:
            a: `(n, 2 * dimensions)` numbers.
            b: `(k, 2 * dimensions)` numbers.
            margin: finds boxes within this distance on each axis, too, as in `find_pairs`.
            progress: called with the share of the work that is done, from 0 to 1.

        Raises:
            InvalidBoxError, ValueError, TypeError, MemoryError: as `find_pairs_between`.

        >>> import sweep_and_prune as sap
        >>> sap.PairFinder(dimensions=1).find_between([[0, 2], [5, 6]], [[6, 7]])
        array([[1, 0]])
        """
        rows = self._rows(a, "a", margin), self._rows(b, "b", margin)
        return _done(self._finder.find(*rows, None, False, self._index, _checked(progress)), progress)

    def count(self, boxes: Boxes, *, margin: Margin = 0, progress: Progress | None = None) -> int:
        """Counts the pairs that `find` finds, without storing them.

        Args:
            boxes: `(n, 2 * dimensions)` numbers.
            margin: finds boxes within this distance on each axis, too, as in `find_pairs`.
            progress: called with the share of the work that is done, from 0 to 1.

        Raises:
            InvalidBoxError, ValueError, TypeError: as `find_pairs`.

        >>> import sweep_and_prune as sap
        >>> sap.PairFinder(dimensions=1).count([[0, 2], [5, 6], [2, 3]])
        1
        """
        return _done(self._finder.count(self._rows(boxes, "boxes", margin), None, None, _checked(progress)), progress)

    def count_between(self, a: Boxes, b: Boxes, *, margin: Margin = 0, progress: Progress | None = None) -> int:
        """Counts the pairs that `find_between` finds, without storing them.

        Args:
            a: `(n, 2 * dimensions)` numbers.
            b: `(k, 2 * dimensions)` numbers.
            margin: finds boxes within this distance on each axis, too, as in `find_pairs`.
            progress: called with the share of the work that is done, from 0 to 1.

        Raises:
            InvalidBoxError, ValueError, TypeError: as `find_pairs_between`.

        >>> import sweep_and_prune as sap
        >>> sap.PairFinder(dimensions=1).count_between([[0, 2], [5, 6]], [[1, 7]])
        2
        """
        return _done(
            self._finder.count(self._rows(a, "a", margin), self._rows(b, "b", margin), None, _checked(progress)),
            progress,
        )

    def for_each_chunk(
        self, boxes: Boxes, each: Callable[[Pairs], object], *, size: int = _CHUNK, margin: Margin = 0
    ) -> bool:
        """Calls a function with the pairs that `find` finds, in the same order, one chunk at a time.

        Within `each` this finder cannot be used; others can.

        Args:
            boxes: `(n, 2 * dimensions)` numbers.
            each: takes an array of shape `(m, 2)`. If it returns something false other than `None`, the search
                stops.
            size: the number of pairs in each chunk but the last, at most 2^24.
            margin: finds boxes within this distance on each axis, too.

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
        return self._finder.for_each_chunk(self._rows(boxes, "boxes", margin), None, *_chunks(each, size), self._index)

    def for_each_chunk_between(
        self,
        a: Boxes,
        b: Boxes,
        each: Callable[[Pairs], object],
        *,
        size: int = _CHUNK,
        margin: Margin = 0,
    ) -> bool:
        """Calls a function with the pairs that `find_between` finds, in the same order, one chunk at a time.

        Args:
            a: `(n, 2 * dimensions)` numbers.
            b: `(k, 2 * dimensions)` numbers.
            each: takes an array of shape `(m, 2)`. If it returns something false other than `None`, the search
                stops.
            size: the number of pairs in each chunk but the last, at most 2^24.
            margin: finds boxes within this distance on each axis, too.

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
        rows = self._rows(a, "a", margin), self._rows(b, "b", margin)
        return self._finder.for_each_chunk(*rows, *_chunks(each, size), self._index)

    def __getstate__(self) -> dict[str, Any]:
        """Everything but the buffers, which a copy creates itself."""
        return attributes(self, ("_finder",))

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Restores a copy, with empty buffers."""
        set_attributes(self, state)
        self._finder = self._native()

    def __repr__(self) -> str:
        """Shows the arguments with which it was created."""
        return f"PairFinder(dimensions={self._dimensions}, dtype={self._dtype})"

    def _rows(self, boxes: Boxes, name: str, margin: Margin) -> Floats:
        rows = box_rows(boxes, name, self._dtype, self._dimensions)
        if is_zero(margin):
            return rows
        return prepare({name: rows}, margin=margin).sets[0]


_index_dtype = index_dtype
_Result = TypeVar("_Result")
_Each = Callable[[Pairs], object]


def find(prepared: Prepared, threads: int | None, dtype: DTypeLike, progress: Progress | None = None) -> Pairs:
    index, report = index_dtype(dtype), _checked(progress)
    prepared, found = _found(
        prepared, threads, lambda finder, one: finder.find(*_arguments(one), one.is_translated, index, report)
    )
    return _done(prepared.translate(found), progress)


def _count(prepared: Prepared, threads: int | None, progress: Progress | None) -> int:
    if prepared.is_filtered:
        return len(find(prepared, threads, np.int64, progress))
    report = _checked(progress)
    count: int = _found(prepared, threads, lambda finder, one: finder.count(*_arguments(one), report))[1]
    return _done(count, progress)


def counts_of(prepared: Prepared) -> tuple[Prepared, NDArray[np.int64]]:
    """For each box of the first set that is searched, how many others it overlaps; and what was searched. No pair is
    filtered."""
    return _found(prepared, 1, lambda finder, one: finder.counts(*_arguments(one)))


def _found(
    prepared: Prepared, threads: int | None, call: Callable[[Finder, Prepared], _Result | None]
) -> tuple[Prepared, _Result]:
    """What a call of a finder returns, and what was searched: floating point, if integers have to be."""
    found = _search(prepared, threads, lambda finder: call(finder, prepared))
    return (prepared, found) if found is not None else _found(prepared.in_floats(), threads, call)


def stream(prepared: Prepared, each: _Each, size: int, dtype: DTypeLike) -> bool:
    index = index_dtype(dtype)
    each, size = _chunks(each, size)
    prepared = prepared.in_floats()

    def translated(found: Pairs) -> object:
        pairs = prepared.translate(found)
        return each(pairs) if len(pairs) else None

    is_plain = not prepared.is_filtered and all(rows is None for rows in prepared.kept)
    return _search(
        prepared,
        1,
        lambda finder: finder.for_each_chunk(*_arguments(prepared)[:2], each if is_plain else translated, size, index),
    )


def _iterate(prepared: Prepared, size: int, dtype: DTypeLike) -> Iterator[Pairs]:
    # Refused now, and not with the first chunk.
    _chunk_size(size)
    index_dtype(dtype)
    return _chunks_of_thread(lambda each: stream(prepared, each, size, dtype))


def _chunks_of_thread(stream: Callable[[_Each], object]) -> Iterator[Pairs]:
    """The chunks of a stream that runs in a thread, which waits while two of them are not taken."""
    chunks: Queue[Any] = Queue(maxsize=2)
    is_ended = False

    def each(chunk: Pairs) -> bool:
        chunks.put(chunk)
        return not is_ended

    def work() -> None:
        try:
            stream(each)
        except BaseException as error:
            chunks.put(error)
        else:
            chunks.put(None)

    _refuse_at_exit()
    Thread(target=work, daemon=True).start()
    try:
        while True:
            _refuse_at_exit()
            chunk = chunks.get()
            if isinstance(chunk, BaseException):
                raise chunk
            if chunk is None:
                return
            yield chunk
    finally:
        is_ended = True
        # The thread puts one more chunk at most, and its end: there is place for both.
        with suppress(Empty):
            while True:
                chunks.get_nowait()


def _refuse_at_exit() -> None:
    """Refuses to let the thread that exits wait for another one, which never goes on."""
    if get_ident() in _exiting:
        raise RuntimeError("no other thread can search while the interpreter exits: use for_each_chunk")


def _chunks(each: object, size: object) -> tuple[_Each, int]:
    if not callable(each):
        raise TypeError(f"each must be callable, not a {type(each).__name__}")
    return each, _chunk_size(size)


def _chunk_size(size: object) -> int:
    return whole(size, "size", 1, _MAX_CHUNK)


def _checked(progress: Progress | None) -> Progress | None:
    if progress is not None and not callable(progress):
        raise TypeError(f"progress must be callable, not a {type(progress).__name__}")
    return progress


def _done(result: _Result, progress: Progress | None) -> _Result:
    if progress is not None:
        progress(1.0)
    return result


def _arguments(prepared: Prepared) -> tuple[NDArray[Any], NDArray[Any] | None, bool | None]:
    sets, whole = prepared.sets, prepared.whole
    return sets[0], sets[1] if len(sets) == 2 else None, None if whole is None else whole.take_ends


def one_set(
    boxes: Boxes,
    format: str,
    closed: str | None,
    missing: str,
    by: Groups | None,
    margin: Margin,
    wrap: float | None = None,
    fold: bool = False,
) -> Prepared:
    return prepare({"boxes": boxes}, format, closed, missing, None if by is None else [by], margin, wrap, fold)


def two_sets(
    a: Boxes,
    b: Boxes,
    format: str,
    closed: str | None,
    missing: str,
    by: Groups | tuple[Groups, Groups] | None,
    margin: Margin,
    wrap: float | None = None,
    fold: bool = False,
) -> Prepared:
    if isinstance(by, NAME) or (isinstance(by, list) and by and all(type(one) is str for one in by)):
        by = (by, by)  # columns of both
    if by is not None and not (isinstance(by, (tuple, list)) and len(by) == 2):
        raise ValueError(
            "by must be a pair of arrays, one for a and one for b, or the name of a column of both, or a list of names"
        )
    return prepare({"a": a, "b": b}, format, closed, missing, None if by is None else list(by), margin, wrap, fold)


def release_buffers() -> None:
    """Frees what this thread keeps of its last search."""
    vars(_idle).clear()


def _search(prepared: Prepared, threads: int | None, call: Callable[[Finder], _Result]) -> _Result:
    """What a call of a finder returns: of the one that this thread used last, if it is of the same kind."""
    rows, count = prepared.sets[0], thread_count(threads)
    kind = (rows.shape[1] // 2, rows.dtype != np.float32)
    # Taken out, since what the call calls may search, too.
    last_kind, finder = vars(_idle).pop("last", (None, None))
    if finder is None or last_kind != kind:
        finder = Finder(*kind, count)
    else:
        finder.use_threads(count)
    result = call(finder)
    if sum(rows.nbytes for rows in prepared.sets) <= _KEPT_BYTES:
        _idle.last = (kind, finder)
    return result
