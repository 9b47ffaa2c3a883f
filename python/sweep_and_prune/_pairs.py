"""Finding pairs: boxes in, all pairs that overlap out, nothing kept but buffers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike

from ._arrays import Floats, Pairs, box_rows, box_sets, float_dtype, whole
from ._native import Finder

_CHUNK = 65_536
_MOST_IN_A_CHUNK = 2**24
_MOST_THREADS = 1024


def find_pairs(boxes: ArrayLike, *, threads: int = 1) -> Pairs:
    """All pairs of boxes that overlap, each once, smaller index first, in a deterministic order.

    Touching boxes overlap. Points, flat boxes and infinite edges are allowed. The order depends on the boxes
    alone: not on the machine nor on `threads`. Sort it, if you want it by index, with
    `pairs[np.lexsort(pairs.T[::-1])]`.

    Time O(n log n + pairs) on scenes that anything helps with, memory O(n + pairs). Other threads of Python
    run meanwhile; if one of them writes to the array, which pairs are found is not said.

    Args:
        boxes: `(n, 2 * D)` numbers, D from 1 to 3. A row is the least corner and then the greatest:
            min x, min y, max x, max y. `float32` is compared in single precision, all else as `float64`
            (integers beyond 2^53 are rounded). C-contiguous arrays of these two are not copied.
        threads: how many to use at most, beginning at 4,096 boxes; 1 to 1024. More than the machine has
            processors do not help.

    Returns:
        `(m, 2)` `uint32`, indices of rows. An array of your own.

    Raises:
        InvalidBoxError: for the first box that is inverted or NaN.
        ValueError: for another shape.
        TypeError: for what is not numbers.
        MemoryError: if the pairs do not fit in memory.

    >>> import sweep_and_prune as sap
    >>> sap.find_pairs([[0, 0, 2, 2], [5, 5, 6, 6], [2, 1, 3, 4]])  # the third touches the first
    array([[0, 2]], dtype=uint32)
    """
    rows = box_rows(boxes, "boxes")
    return _finder(rows, threads).find(rows)


def find_pairs_between(a: ArrayLike, b: ArrayLike, *, threads: int = 1) -> Pairs:
    """All pairs of a box of `a` and a box of `b` that overlap, each once, in a deterministic order.

    Otherwise as `find_pairs`. If one set is in double precision, both are compared so.

    Args:
        a: `(n, 2 * D)` numbers.
        b: `(k, 2 * D)` numbers.
        threads: how many to use at most.

    Returns:
        `(m, 2)` `uint32`: an index of a row of `a`, and one of `b`.

    Raises:
        InvalidBoxError: for the first box that is inverted or NaN; its `argument` is `a` or `b`.
        ValueError: for other shapes, or sets of different dimensions.
        TypeError: for what is not numbers.
        MemoryError: if the pairs do not fit in memory.

    >>> import sweep_and_prune as sap
    >>> bullets = [[0, 0, 1, 1], [5, 5, 6, 6]]
    >>> targets = [[4, 4, 7, 7]]
    >>> sap.find_pairs_between(bullets, targets)
    array([[1, 0]], dtype=uint32)
    """
    first, second = box_sets(a, b)
    return _finder(first, threads).find(first, second)


def count_pairs(boxes: ArrayLike, *, threads: int = 1) -> int:
    """How many pairs `find_pairs` would find. Stores none of them.

    Args:
        boxes: `(n, 2 * D)` numbers.
        threads: how many to use at most.

    Raises:
        InvalidBoxError, ValueError, TypeError: as `find_pairs`.

    >>> import numpy as np
    >>> import sweep_and_prune as sap
    >>> sap.count_pairs(np.zeros((1000, 6)))
    499500
    """
    rows = box_rows(boxes, "boxes")
    return _finder(rows, threads).count(rows)


def for_each_chunk(boxes: ArrayLike, each: Callable[[Pairs], object], *, size: int = _CHUNK) -> bool:
    """Calls `each` with all pairs that `find_pairs` would find, in its order, a chunk at a time.

    For more pairs than should be stored, or a search that ends early. Memory O(n + size): a copy of the boxes
    is kept meanwhile, so `each` may write to them.

    Args:
        boxes: `(n, 2 * D)` numbers.
        each: takes an array `(m, 2)` `uint32` of its own, m from 1 to `size`. If it returns `False` it gets
            no more.
        size: the number of pairs in each chunk but the last, at most 2^24.

    Returns:
        Whether it came to the end.

    Raises:
        InvalidBoxError, ValueError, TypeError: as `find_pairs`, before the first call of `each`; and
            whatever `each` raises.

    >>> import numpy as np
    >>> import sweep_and_prune as sap
    >>> degrees = np.zeros(1000, int)
    >>> def count(pairs):
    ...     np.add.at(degrees, pairs, 1)
    >>> sap.for_each_chunk(np.zeros((1000, 2)), count)
    True
    >>> degrees.min(), degrees.max()
    (np.int64(999), np.int64(999))
    """
    rows = box_rows(boxes, "boxes")
    return _stream(_finder(rows, 1), rows, None, each, size)


class PairFinder:
    """Finds pairs again and again, and keeps its buffers between calls.

    The pairs and their order are those of `find_pairs`, whatever it found before. One call at a time: another
    thread, or a callback, needs a finder of its own, and is told so by a `RuntimeError`.

    It keeps less than four times what the boxes take on even scenes, and the pairs; all of it comes back when
    the last reference is gone.

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

    def __init__(self, dimensions: int = 3, dtype: DTypeLike = np.float64, *, threads: int = 1) -> None:
        """A finder with empty buffers.

        Args:
            dimensions: 1, 2 or 3.
            dtype: `float32` or `float64`, in which boxes are compared. Others are converted at each call, which
                rounds `float64` to `float32`: an array of this type is not copied.
            threads: how many to use at most, beginning at 4,096 boxes.

        Raises:
            ValueError, TypeError: for other dimensions or types.
        """
        self._dimensions = whole(dimensions, "dimensions", 1, 3)
        self._dtype = float_dtype(dtype)
        threads = whole(threads, "threads", 1, _MOST_THREADS)
        self._finder = Finder(self._dimensions, self._dtype.itemsize == 8, threads)

    @property
    def dimensions(self) -> int:
        """How many dimensions the boxes have."""
        return self._dimensions

    @property
    def dtype(self) -> np.dtype[Any]:
        """In which precision boxes are compared."""
        return self._dtype

    def find(self, boxes: ArrayLike) -> Pairs:
        """As `find_pairs`.

        Args:
            boxes: `(n, 2 * dimensions)` numbers.

        Raises:
            InvalidBoxError, ValueError, TypeError, MemoryError: as `find_pairs`. It stays usable.

        >>> import sweep_and_prune as sap
        >>> sap.PairFinder(dimensions=1).find([[0, 2], [5, 6], [2, 3]])
        array([[0, 2]], dtype=uint32)
        """
        return self._finder.find(self._rows(boxes, "boxes"))

    def find_between(self, a: ArrayLike, b: ArrayLike) -> Pairs:
        """As `find_pairs_between`.

        Args:
            a: `(n, 2 * dimensions)` numbers.
            b: `(k, 2 * dimensions)` numbers.

        Raises:
            InvalidBoxError, ValueError, TypeError, MemoryError: as `find_pairs_between`.

        >>> import sweep_and_prune as sap
        >>> sap.PairFinder(dimensions=1).find_between([[0, 2], [5, 6]], [[6, 7]])
        array([[1, 0]], dtype=uint32)
        """
        return self._finder.find(self._rows(a, "a"), self._rows(b, "b"))

    def count(self, boxes: ArrayLike) -> int:
        """As `count_pairs`.

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
        """How many pairs `find_between` would find. Stores none of them.

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
        """As the function `for_each_chunk`. Within `each` this finder cannot be used; others can.

        Args:
            boxes: `(n, 2 * dimensions)` numbers.
            each: takes `(m, 2)` `uint32`; if it returns `False` it gets no more.
            size: the number of pairs in each chunk but the last, at most 2^24.

        Raises:
            InvalidBoxError, ValueError, TypeError: as `find_pairs`; and whatever `each` raises.

        >>> import sweep_and_prune as sap
        >>> sap.PairFinder(dimensions=1).for_each_chunk([[0, 9], [1, 2], [3, 4]], print, size=1)
        [[0 1]]
        [[0 2]]
        True
        """
        return _stream(self._finder, self._rows(boxes, "boxes"), None, each, size)

    def for_each_chunk_between(
        self, a: ArrayLike, b: ArrayLike, each: Callable[[Pairs], object], *, size: int = _CHUNK
    ) -> bool:
        """As `for_each_chunk`, with the pairs of `find_between`.

        Args:
            a: `(n, 2 * dimensions)` numbers.
            b: `(k, 2 * dimensions)` numbers.
            each: takes `(m, 2)` `uint32`; if it returns `False` it gets no more.
            size: the number of pairs in each chunk but the last, at most 2^24.

        Raises:
            InvalidBoxError, ValueError, TypeError: as `find_between`; and whatever `each` raises.

        >>> import sweep_and_prune as sap
        >>> sap.PairFinder(dimensions=1).for_each_chunk_between([[0, 9]], [[1, 2], [3, 4]], print)
        [[0 0]
         [0 1]]
        True
        """
        return _stream(self._finder, self._rows(a, "a"), self._rows(b, "b"), each, size)

    def __repr__(self) -> str:
        """What it was made with."""
        return f"PairFinder(dimensions={self._dimensions}, dtype={self._dtype})"

    def _rows(self, boxes: ArrayLike, name: str) -> Floats:
        return box_rows(boxes, name, self._dtype, self._dimensions)


def _finder(rows: Floats, threads: int) -> Finder:
    threads = whole(threads, "threads", 1, _MOST_THREADS)
    return Finder(rows.shape[1] // 2, rows.dtype.itemsize == 8, threads)


def _stream(finder: Finder, a: Floats, b: Floats | None, each: Callable[[Pairs], object], size: int) -> bool:
    if not callable(each):
        raise TypeError(f"each must be callable, not a {type(each).__name__}")
    return finder.for_each(a, b, each, whole(size, "size", 1, _MOST_IN_A_CHUNK))
