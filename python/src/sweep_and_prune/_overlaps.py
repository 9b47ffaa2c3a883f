"""How many boxes each box overlaps, and how much of them two boxes share."""

from __future__ import annotations

import math
from collections.abc import Sequence
from decimal import Decimal
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._arrays import Boxes, read_boxes, same_width
from ._columns import in_one_unit, one_type
from ._native import ranks
from ._pairs import Groups, Margin, counts_of, one_set, stream, two_sets
from ._prepare import Prepared, one_kind, refuse_inverted
from ._wrap import checked_wrap, length_on_circle, shared_length, without_crossings

Values = NDArray[Any]
"""Coordinates or sizes in the type that the boxes have: integers, floating point or times."""

_CHUNK = 2**20
_SAFE = 2**61
"""Sums and differences of two integers below this do not overflow."""


class Overlaps(NamedTuple):
    """How much pairs of boxes overlap, an entry for each pair."""

    size: Values
    """The length, area or volume of the intersection. In 1D it is exact for integers and times."""
    fraction_a: NDArray[np.float64]
    """The share of the first box that the second one covers; NaN if the first one has no size."""
    fraction_b: NDArray[np.float64]
    """The share of the second box that the first one covers; NaN if the second one has no size."""
    iou: NDArray[np.float64]
    """The intersection over the union; NaN if neither has a size."""


def count_overlaps(
    a: Boxes,
    b: Boxes | None = None,
    *,
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    by: Groups | tuple[Groups, Groups] | None = None,
    margin: Margin = 0,
    wrap: float | None = None,
) -> NDArray[np.int64]:
    """Counts for each box of `a` the boxes of `b` that overlap it; without `b`, the other boxes of `a`.

    No pairs are stored. Those of intervals are not even looked at: the time is O(n) where intervals are spread, and
    O(n log n) at most, however many overlap. For boxes of two or three dimensions, it is that of `find_pairs`.

    Args:
        a: `(n, 2 * D)` numbers, or another form that `find_pairs` accepts.
        b: another set of boxes.
        format: `"xyxy"`, `"xywh"` or `"cxcywh"`, for both sets.
        closed: `"both"`, `"left"`, `"right"` or `"neither"`.
        missing: `"raise"` or `"skip"`: a box with a NaN overlaps nothing.
        by: only boxes with equal values count, as in `find_pairs_between`; without `b`, as in `find_pairs`.
        margin: counts boxes within this distance on each axis, too.
        wrap: the length of axis 0 if it is a circle, as in `find_pairs`.

    Returns:
        `(n,)` numbers.

    Raises:
        InvalidBoxError, ValueError, TypeError: as `find_pairs_between`.

    >>> import sweep_and_prune as sap
    >>> sap.count_overlaps([[0, 5], [6, 9], [20, 30]], [[1, 2], [4, 7], [5, 6]])
    array([3, 2, 0])
    >>> sap.count_overlaps([[0, 5], [4, 7], [20, 30]])
    array([1, 1, 0])
    """
    if b is None:
        prepared = one_set(a, format, closed, missing, by, margin, wrap, fold=True)
    else:
        prepared = two_sets(a, b, format, closed, missing, by, margin, wrap, fold=True)
    if not prepared.is_filtered:
        are_grouped_intervals = by is not None and prepared.sets[0].shape[1] == 4  # the second axis is the group
        if are_grouped_intervals:
            return _of_all_rows(_counts_of_groups(prepared), prepared)
        searched, found = counts_of(prepared)
        return _of_all_rows(found, searched)
    counts = np.zeros(prepared.lengths[0], np.int64)

    def add(pairs: NDArray[Any]) -> None:
        counts[:] += np.bincount(pairs[:, 0], minlength=len(counts))
        if b is None:
            counts[:] += np.bincount(pairs[:, 1], minlength=len(counts))

    stream(prepared, add, _CHUNK, np.int64)
    return counts


def _of_all_rows(counts: NDArray[np.int64], prepared: Prepared) -> NDArray[np.int64]:
    """The counts of all rows that were passed, given those of the ones that were kept."""
    kept = prepared.kept[0]
    if kept is None:
        return counts
    every = np.zeros(prepared.lengths[0], np.int64)
    every[kept] = counts
    return every


def _counts_of_groups(prepared: Prepared) -> NDArray[np.int64]:
    """Those that begin before the end of an interval, without those that end before its start."""
    check_intervals(prepared)
    keys = line_keys(prepared.sets)
    (low, high), (starts, ends) = keys[0], keys[-1]
    begun = ranks_of(high, np.sort(starts), or_equal=True)
    begun -= ranks_of(low, np.sort(ends), or_equal=False)
    begun -= len(prepared.sets) == 1
    return begun


def ranks_of(values: Values, ordered: Values, or_equal: bool) -> NDArray[np.int64]:
    """How many numbers of a sorted array that no other thread knows are less than each value, or less or equal."""
    kind = np.int64 if ordered.dtype.kind in "iu" else np.float64
    return ranks(ordered.astype(kind, copy=False), values.astype(kind), or_equal)


def check_intervals(prepared: Prepared) -> None:
    """Refuses intervals that end before they start or have a NaN, as a search does: sorting alone would not see them.

    Raises:
        InvalidBoxError: for the first of them.
    """
    if not all((boxes[:, 0] <= boxes[:, boxes.shape[1] // 2]).all() for boxes in prepared.sets):
        stream(prepared, lambda pairs: None, _CHUNK, np.int64)


def line_keys(sets: Sequence[Values]) -> list[tuple[Values, Values]]:
    """Numbers for the starts and the ends of checked intervals, in the order of groups and then of coordinates."""
    if sets[0].shape[1] == 2:
        return [(boxes[:, 0], boxes[:, 1]) for boxes in sets]
    every = np.concatenate([boxes[:, [0, 2]] for boxes in sets])
    coordinates, ranks = np.unique(every, return_inverse=True)
    ranks = ranks.reshape(every.shape)
    codes = np.concatenate([boxes[:, 1] for boxes in sets])
    groups = np.unique(codes, return_inverse=True)[1].reshape(-1).astype(np.int64)
    keys = groups[:, None] * len(coordinates) + ranks
    parts = np.split(keys, np.cumsum([len(boxes) for boxes in sets])[:-1])
    return [(part[:, 0], part[:, 1]) for part in parts]


def measure_overlaps(
    a: Boxes, b: Boxes | None, pairs: ArrayLike, *, format: str = "xyxy", wrap: float | None = None
) -> Overlaps:
    """Measures how much the boxes of each pair overlap.

    Where two boxes do not overlap, as with a `margin`, the size is 0. Infinite boxes have a NaN where infinity would be
    divided by infinity, and so has an empty box, whose share would be 0 divided by 0.

    Args:
        a: `(n, 2 * D)` numbers, or another form that `find_pairs` accepts.
        b: another set of boxes; None for pairs of `a` itself.
        pairs: `(m, 2)` indices of rows, as `find_pairs` or `find_pairs_between` returned them.
        format: `"xyxy"`, `"xywh"` or `"cxcywh"`, for both sets.
        wrap: the length of axis 0 if it is a circle, as in `find_pairs`; then sizes are floating point.

    Returns:
        Four arrays of length m: `size, fraction_a, fraction_b, iou`.

    Raises:
        InvalidBoxError: for the first box of a pair that is inverted or has a NaN.
        ValueError, TypeError: for boxes that are not recognized, times in more than one dimension, or pairs that are
            not rows.

    >>> import sweep_and_prune as sap
    >>> genes, reads = [[0, 100], [200, 300]], [[90, 110], [220, 240]]
    >>> pairs = sap.find_pairs_between(genes, reads)
    >>> found = sap.measure_overlaps(genes, reads, pairs)
    >>> found.size.tolist(), found.fraction_b.tolist()
    ([10, 20], [0.5, 1.0])
    >>> pairs[found.fraction_b >= 0.75].tolist()
    [[1, 1]]
    """
    sets: dict[str, Any] = {"boxes": a} if b is None else {"a": a, "b": b}
    corners = plain_corners(sets, format)
    rows = np.asarray(pairs)
    rows = rows.reshape(0, 2) if rows.shape == (0,) else rows
    if rows.ndim != 2 or rows.shape[1] != 2 or (rows.dtype.kind not in "iu" and rows.size):
        raise ValueError(f"pairs must be (m, 2) indices of rows, not of shape {rows.shape} and dtype {rows.dtype}")
    rows = rows.astype(np.int64)
    for side, boxes in zip(rows.T, (corners[0], corners[-1])):
        if len(side) and not (0 <= side.min() and side.max() < len(boxes)):
            wrong = int(side.min()) if side.min() < 0 else int(side.max())
            raise ValueError(f"pairs has the index {wrong}; it must be from 0 to {len(boxes) - 1}")
    first, second = corners[0][rows[:, 0]], corners[-1][rows[:, 1]]
    names = list(sets)
    for name, boxes, side in ((names[0], first, rows[:, 0]), (names[-1], second, rows[:, 1])):
        if format != "xyxy":
            refuse_inverted(boxes, name, side, is_size=True)
        refuse_inverted(boxes if wrap is None else without_crossings(boxes), name, side)
    with np.errstate(all="ignore"):
        sides = np.hstack([_larger(first, second), _smaller(first, second)])
        if wrap is not None:
            sides, first, second = _on_circle(sides, first, second, checked_wrap(wrap))
        shared, of_a, of_b = _size(sides), _size(first), _size(second)
        union = of_a + of_b - shared
        return Overlaps(rounded(shared), share_of(shared, of_a), share_of(shared, of_b), share_of(shared, union))


def _on_circle(shared: Values, first: Values, second: Values, wrap: float) -> list[Values]:
    """Boxes that are as long on axis 0 as these are on a circle, and begin there at 0."""
    if first.dtype.kind not in "iuf":
        raise TypeError("wrap is for numbers that floating point holds, not for times and integers beyond 2^53")
    half = first.shape[1] // 2
    ends = [boxes[:, [0, half]] for boxes in (first, second)]
    lengths = [
        shared_length(ends[0], ends[1], wrap),
        *(length_on_circle(each[:, 0], each[:, 1], wrap) for each in ends),
    ]
    sized = [boxes.astype(np.float64) for boxes in (shared, first, second)]
    for boxes, length in zip(sized, lengths):
        boxes[:, 0], boxes[:, half] = 0, length
    return sized


def _larger(first: Values, second: Values) -> Values:
    half = first.shape[1] // 2
    return np.asarray(np.maximum(first[:, :half], second[:, :half]))


def _smaller(first: Values, second: Values) -> Values:
    half = first.shape[1] // 2
    return np.asarray(np.minimum(first[:, half:], second[:, half:]))


def _size(boxes: Values) -> Values:
    half = boxes.shape[1] // 2
    sides = boxes[:, half:] - boxes[:, :half]
    sides = np.maximum(sides, np.zeros((), sides.dtype))
    if half == 1:
        return np.asarray(sides[:, 0])
    return np.asarray(sides.astype(np.float64).prod(axis=1))


def share_of(part: Values, whole: Values) -> NDArray[np.float64]:
    """Parts divided by wholes; NaN for a whole of 0."""
    if whole.dtype.kind == "O":
        return np.array([one / other if other else np.nan for one, other in zip(part, whole)], np.float64)
    return np.asarray(part / whole, np.float64)


def plain_corners(sets: dict[str, Any], format: str) -> list[Values]:
    """Corners of sets of boxes in one type, of which sums and differences are exact or rounded once.

    These are `int64`, Python's own numbers, `float64`, or times in one unit.
    """
    raw = [read_boxes(values, name, 0, format) for name, values in sets.items()]
    arrays = one_kind(raw, list(sets))
    if len(arrays) == 2:
        arrays = list(same_width(*arrays))
    if arrays[0].dtype.kind in "mM":
        if arrays[0].shape[1] > 2:
            raise TypeError("boxes of times have sizes in one dimension only")
        arrays = in_one_unit(arrays)
        if arrays[0].dtype.kind == "O":
            raise ValueError("the times of the two sets do not fit in one unit: convert them")
        return arrays
    arrays = one_type(arrays)
    kind = arrays[0].dtype.kind
    if kind in "iu":
        is_safe = all(-_SAFE < int(array.min(initial=0)) and int(array.max(initial=0)) < _SAFE for array in arrays)
        return [array.astype(np.int64 if is_safe else object) for array in arrays]
    return _of_one_kind(arrays) if kind == "O" else [array.astype(np.float64, copy=False) for array in arrays]


def _of_one_kind(arrays: list[Values]) -> list[Values]:
    """Objects of which sums and differences can be computed: Python has none of decimals and floating point."""
    lists = [array.ravel().tolist() for array in arrays]
    if not {Decimal, float} <= {type(value) for values in lists for value in values}:
        return arrays
    exact = [[Fraction(value) if math.isfinite(value) else float(value) for value in values] for values in lists]
    return [np.array(values, object).reshape(array.shape) for values, array in zip(exact, arrays)]


def rounded(values: Values) -> Values:
    """Fractions, of which users were given none, as floating point."""
    are_fractions = values.dtype.kind == "O" and any(type(value) is Fraction for value in values.tolist())
    return values.astype(np.float64) if are_fractions else values
