"""Which intervals and boxes are connected, which are nearest, and what intervals cover."""

from __future__ import annotations

import math
from collections.abc import Iterator
from decimal import Decimal
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ._arrays import Boxes, checked_closed, read_boxes, whole
from ._broad_phase import BroadPhase
from ._columns import read_column
from ._inputs import with_rows
from ._native import nearest_of_rows
from ._overlaps import Values, check_intervals, line_keys, plain_corners, ranks_of, rounded
from ._pairs import Groups, Margin, find, one_set, stream, two_sets
from ._prepare import Prepared, is_missing, refuse_inverted

_CHUNK = 2**20
_BLOCK = 2**12
"""For this many boxes the nearest ones are looked for at once."""


class Merged(NamedTuple):
    """Intervals or boxes that were merged, an entry for each."""

    intervals: Values
    """`(m, 2 * D)`: min corners and max corners, in the type of what was merged."""
    counts: NDArray[np.int64]
    """How many intervals or boxes each one consists of."""
    first: NDArray[np.int64]
    """The first row of each one, by which its group can be looked up."""


class Nearest(NamedTuple):
    """Pairs of boxes that are near each other."""

    pairs: NDArray[np.int64]
    """`(m, 2)`: an index of a row of `a` and one of `b`."""
    distances: Values
    """The distance of each pair, 0 where they overlap or touch."""


def cluster(
    intervals: Boxes,
    *,
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    by: Groups | None = None,
    margin: Margin = 0,
) -> NDArray[np.int64]:
    """Numbers the groups of connected intervals or boxes: those that overlap, directly or through others.

    For intervals the time is O(n log n), however many overlap: no pairs are found. For boxes of two or three dimensions
    it is that of `find_pairs`, but no pairs are stored.

    Args:
        intervals: `(n, 2)` starts and ends, `(n, 2 * D)` boxes, or another form that `find_pairs` accepts.
        format: `"xyxy"`, `"xywh"` or `"cxcywh"`.
        closed: which ends belong to an interval. By default both: intervals that touch are connected.
        missing: `"raise"` or `"skip"`: an interval with a NaN is in no cluster.
        by: only intervals with equal values are connected, as in `find_pairs`.
        margin: intervals within this distance are connected, too.

    Returns:
        `(n,)`: the cluster of each interval. They are numbered from 0, in the order of their first rows; -1 is none.

    Raises:
        InvalidBoxError, ValueError, TypeError: as `find_pairs`.

    >>> import sweep_and_prune as sap
    >>> sap.cluster([[0, 2], [5, 6], [2, 3], [6, 9]])
    array([0, 1, 0, 1])
    >>> sap.cluster([[0, 2], [5, 6], [2, 3], [6, 9]], closed="left", margin=2)
    array([0, 1, 0, 1])
    >>> sap.cluster([[0, 0, 2, 2], [5, 5, 6, 6], [1, 1, 3, 3]])
    array([0, 1, 0])
    """
    intervals = with_rows(intervals)
    prepared = one_set(intervals, format, closed, missing, by, margin)
    labels = np.full(prepared.lengths[0], -1, np.int64)
    kept = prepared.kept[0]
    rows = np.arange(len(labels)) if kept is None else kept
    if _are_intervals(prepared, by):
        check_intervals(prepared)
        labels[rows] = _clusters(*line_keys(prepared.sets)[0])
    else:
        labels[rows] = _components(prepared)[rows]
    if kept is not None and len(rows) < len(labels):
        # Those that overlap nothing, since they are empty or have no group, are by themselves.
        alone = np.setdiff1d(np.flatnonzero(~is_missing(_corners_of(intervals, format))), rows)
        labels[alone] = len(labels) + np.arange(len(alone))
    present = np.flatnonzero(labels >= 0)
    _, first, of_rows = np.unique(labels[present], return_index=True, return_inverse=True)
    labels[present] = np.argsort(np.argsort(first))[of_rows.reshape(-1)]
    return labels


def _are_intervals(prepared: Prepared, by: Any) -> bool:
    return int(prepared.sets[0].shape[1]) == (2 if by is None else 4)


def _refuse_boxes(prepared: Prepared, by: Any) -> None:
    if not _are_intervals(prepared, by):
        width = prepared.sets[0].shape[1] - (0 if by is None or prepared.groups is not None else 2)
        raise ValueError(f"intervals must be of shape (n, 2), starts and ends, not of {width} columns")


def _corners_of(boxes: Any, format: str) -> Values:
    return read_boxes(boxes, "intervals", 0, format).array


def _components(prepared: Prepared) -> NDArray[np.int64]:
    """For each row the first row of those that are connected to it, directly or through others."""
    parents = np.arange(prepared.lengths[0])  # between chunks, all lead to the first row at once

    def connect(pairs: NDArray[Any]) -> None:
        first, second = parents[pairs[:, 0]], parents[pairs[:, 1]]
        while len(apart := np.flatnonzero(first != second)):
            first, second = first[apart], second[apart]
            np.minimum.at(parents, np.maximum(first, second), np.minimum(first, second))
            while not np.array_equal(above := parents[parents], parents):
                parents[:] = above
            first, second = parents[first], parents[second]

    stream(prepared, connect, _CHUNK, np.int64)
    return parents


def _clusters(starts: Values, ends: Values) -> NDArray[np.int64]:
    """For each interval the number of those that it is connected to, directly or through others."""
    order = np.argsort(starts, kind="stable")
    if len(order) == 0:
        return order
    begins = np.ones(len(order), bool)
    begins[1:] = starts[order][1:] > np.maximum.accumulate(ends[order])[:-1]
    labels = np.empty(len(order), np.int64)
    labels[order] = np.cumsum(begins) - 1
    return labels


def merge(
    intervals: Boxes,
    *,
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    by: Groups | None = None,
    margin: Margin = 0,
) -> Merged:
    """Merges intervals or boxes that overlap, directly or through others, to the smallest ones that contain them.

    Merged intervals do not overlap. Merged boxes may: each is that of a group of connected boxes, as `cluster` numbers
    them, and need not be filled by these. Cost is that of `cluster`.

    Args:
        intervals: `(n, 2)` starts and ends, `(n, 2 * D)` boxes, or another form that `find_pairs` accepts.
        format: `"xyxy"`, `"xywh"` or `"cxcywh"`; the result has corners.
        closed: which ends belong to an interval. By default both: intervals that touch are merged.
        missing: `"raise"` or `"skip"`: an interval with a NaN is left out.
        by: only intervals with equal values are merged, as in `find_pairs`.
        margin: intervals within this distance are merged, too.

    Returns:
        `intervals, counts, first`, in the order of their first rows.

    Raises:
        InvalidBoxError, ValueError, TypeError: as `find_pairs`.

    >>> import sweep_and_prune as sap
    >>> sap.merge([[0, 2], [5, 6], [2, 3]]).intervals
    array([[0, 3],
           [5, 6]])
    >>> chromosomes = ["chr1", "chr2", "chr2"]
    >>> merged = sap.merge([[0, 2], [1, 6], [2, 9]], by=chromosomes)
    >>> [(chromosomes[row], *ends) for row, ends in zip(merged.first, merged.intervals.tolist())]
    [('chr1', 0, 2), ('chr2', 1, 9)]
    """
    intervals = with_rows(intervals)
    labels = cluster(intervals, format=format, closed=closed, missing=missing, by=by, margin=margin)
    corners = _corners_of(intervals, format)
    order = np.argsort(labels, kind="stable")
    order = order[labels[order] >= 0]
    if len(order) == 0:
        return Merged(corners[:0], order, order)
    starts_at = np.flatnonzero(np.diff(labels[order], prepend=-1))
    half = corners.shape[1] // 2
    merged = [
        function.reduceat(corners[order][:, side], starts_at)
        for function, side in ((np.minimum, slice(half)), (np.maximum, slice(half, None)))
    ]
    return Merged(np.hstack(merged), np.diff(starts_at, append=len(order)), order[starts_at])


def coverage(
    a: Boxes,
    b: Boxes,
    *,
    missing: str = "raise",
    by: Groups | tuple[Groups, Groups] | None = None,
) -> Values:
    """Measures how much of each interval of `a` the intervals of `b` cover together.

    What several intervals of `b` cover counts once. The intervals of `b` are merged first, so the time is O(n log n +
    the pairs of an interval of `a` and a merged one).

    Args:
        a: `(n, 2)` starts and ends, or another form that `find_pairs` accepts.
        b: another set of intervals.
        missing: `"raise"` or `"skip"`: an interval with a NaN covers nothing, and 0 of it is covered.
        by: an interval is only covered by those with equal values, as in `find_pairs_between`.

    Returns:
        `(n,)` lengths: integers for integers, durations for times.

    Raises:
        ValueError: for boxes of more than one dimension.
        InvalidBoxError, TypeError: as `find_pairs_between`.

    >>> import sweep_and_prune as sap
    >>> sap.coverage([[0, 10], [20, 30]], [[2, 5], [4, 6], [9, 25]])
    array([5, 5])
    """
    a, b = with_rows(a), with_rows(b)
    prepared = two_sets(a, b, "xyxy", "both", missing, by, 0)
    _refuse_boxes(prepared, by)
    check_intervals(prepared)
    of_a, of_b = plain_corners({"a": a, "b": b}, "xyxy")
    labels = _clusters(*line_keys(prepared.sets[1:])[0])
    covered = np.zeros(len(of_a), (of_a[:0, 1] - of_a[:0, 0]).dtype)
    if len(labels) == 0:
        return covered
    order = np.argsort(labels, kind="stable")
    starts_at = np.flatnonzero(np.diff(labels[order], prepend=-1))
    ends = of_b[order if prepared.kept[1] is None else prepared.kept[1][order]]
    merged = [function.reduceat(ends[:, side], starts_at) for side, function in enumerate((np.minimum, np.maximum))]
    half = prepared.sets[1].shape[1] // 2
    boxes = prepared.sets[1][order[starts_at]]
    for column, function in ((0, np.minimum), (half, np.maximum)):
        boxes[:, column] = function.reduceat(prepared.sets[1][order, column], starts_at)
    search = prepared._replace(sets=[prepared.sets[0], boxes], kept=[prepared.kept[0], None])

    def add(pairs: NDArray[Any]) -> None:
        first, other = pairs.T
        low, high = np.maximum(of_a[first, 0], merged[0][other]), np.minimum(of_a[first, 1], merged[1][other])
        with np.errstate(all="ignore"):
            shared = high - low
            shared[low == high] = np.zeros((), shared.dtype)  # also for infinite ends, whose difference is NaN
            np.add.at(covered, first, shared)

    stream(search, add, _CHUNK, np.int64)
    return rounded(covered)


def nearest(
    a: Boxes,
    b: Boxes,
    k: int = 1,
    *,
    max_distance: float | None = None,
    how: str = "inner",
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    by: Groups | tuple[Groups, Groups] | None = None,
) -> Nearest:
    """Finds for each box of `a` the `k` nearest boxes of `b`.

    The distance of two boxes is the length of the shortest line between them: 0 if they overlap or touch. Those that
    overlap are nearer than those that merely touch, if `closed` says that there is a difference. Of boxes that are
    equally near, those with smaller indices are taken. For intervals the time is O(n log n + n k + overlapping
    pairs). In two and three dimensions, all boxes within `max_distance` on each axis are looked at.

    Args:
        a: `(n, 2 * D)` numbers, or another form that `find_pairs` accepts.
        b: another set of boxes.
        k: how many to find for each box of `a`, at most.
        max_distance: boxes farther away are left out; a number, or a duration for times.
        how: `"inner"`: boxes of `a` without any have no pair. `"left"`: such a box has one pair with -1, whose distance
            is -1 for integers, and otherwise NaN or NaT.
        format: `"xyxy"`, `"xywh"` or `"cxcywh"`, for both sets.
        closed: which ends belong to a box, as in `find_pairs`. By default both: boxes that touch overlap. Otherwise
            they come after all that overlap, and so do empty boxes, which overlap nothing; their distance is still 0.
        missing: `"raise"` or `"skip"`: a box with a NaN is near nothing.
        by: only boxes with equal values are near each other, as in `find_pairs_between`.

    Returns:
        `pairs, distances`, sorted by the rows of `a`, then by distance (of those at 0, the ones that overlap are first)
        and by the rows of `b`. Distances of intervals have their type: they are exact for integers and times.

    Raises:
        ValueError: for unknown options.
        InvalidBoxError, TypeError: as `find_pairs_between`.

    >>> import sweep_and_prune as sap
    >>> genes, peaks = [[0, 10], [50, 60]], [[12, 14], [44, 45], [58, 59]]
    >>> found = sap.nearest(genes, peaks, 2)
    >>> found.pairs.tolist(), found.distances.tolist()
    ([[0, 0], [0, 1], [1, 2], [1, 1]], [2, 34, 0, 5])
    >>> sap.nearest([[0, 10]], [[10, 20], [5, 7]], closed="left").pairs.tolist()  # the first only touches it
    [[0, 1]]
    """
    if how not in ("inner", "left"):
        raise ValueError(f'how must be "inner" or "left", not {how!r}')
    k = whole(k, "k", 1, 2**31 - 1)
    a, b = with_rows(a), with_rows(b)
    is_closed = checked_closed(closed, a, b)
    corners = plain_corners({"a": a, "b": b}, format)
    half = corners[0].shape[1] // 2
    is_line = half == 1
    if not any(map(len, corners)):  # of what kind coordinates would be is not known
        return Nearest(np.empty((0, 2), np.int64), corners[0][:, 0])
    limit = None if max_distance is None else _limit(max_distance, corners[0])
    if limit is None and not is_line:
        pairs = _nearest_of_boxes(two_sets(a, b, format, "both", missing, by, 0), corners, k)
    else:
        prepared = two_sets(a, b, format, "both", missing, by, 0 if is_line else _reach(corners, limit))
        pairs = find(prepared, 1, np.int64)
    if is_line:
        are_short = np.bincount(pairs[:, 0], minlength=len(corners[0])) < k
        pairs = np.concatenate([pairs, *_beside(prepared, are_short, min(k, max(len(corners[1]), 1)))])
    distances = _distances(corners, pairs)
    if limit is not None:
        if isinstance(limit, Decimal) and any(type(value) is Fraction for value in distances.tolist()):
            limit = Fraction(limit)  # Python does not compare these two
        is_near = distances <= limit
        pairs, distances = pairs[is_near], distances[is_near]
    keys = _sort_keys(distances)
    if not is_closed:
        keys = np.where(_overlap_without_ends(corners, pairs), keys.dtype.type(-1), keys)  # before those that touch
    order = nearest_of_rows(pairs[:, 0], pairs[:, 1], keys, len(corners[0]), k)
    pairs, distances = pairs[order], rounded(distances[order])
    if how == "left":
        alone = np.setdiff1d(np.arange(len(corners[0])), pairs[:, 0])
        pairs = np.concatenate([pairs, np.stack([alone, np.full(len(alone), -1)], axis=1)])
        if len(distances) == 0 and any(rounded(values.ravel()).dtype.kind == "f" for values in corners):
            distances = np.empty(0)
        nothing = {"m": "NaT", "f": np.nan}.get(distances.dtype.kind, -1)
        if distances.dtype.kind == "O" and any(type(value) is not int for values in corners for value in values.flat):
            nothing = np.nan  # they are decimals
        distances = np.concatenate([distances, np.full(len(alone), nothing, distances.dtype)])
        order = np.argsort(pairs[:, 0], kind="stable")
        pairs, distances = pairs[order], distances[order]
    return Nearest(pairs, distances)


def _limit(max_distance: Any, corners: Values) -> Any:
    column = read_column([max_distance], "max_distance")
    wanted = "durations" if corners.dtype.kind in "mM" else "numbers"
    if column.kinds() != {wanted}:
        kind = "a timedelta for times" if wanted == "durations" else "a number"
        raise TypeError(f"max_distance must be {kind}, not {max_distance!r}")
    limit = column.values[0]
    is_finite = column.values.dtype.kind != "f" or math.isfinite(limit)
    if not is_finite or limit < np.zeros((), column.values.dtype):
        raise ValueError(f"max_distance is {max_distance}; it must be finite and 0 or more")
    return limit


def _reach(corners: list[Values], limit: Any) -> Any:
    """The margin that finds all boxes within a distance, however sums are rounded in single precision."""
    is_exact = corners[0].dtype.kind == "O"
    if corners[0].dtype.kind != "f" and not (is_exact and any(map(_has_fractions, corners))):
        return math.floor(limit)
    if is_exact:  # only distances are rounded
        return float(limit) * (1 + 2**-50)
    finite = [np.abs(boxes[np.isfinite(boxes)]).max(initial=0) for boxes in corners]
    limit = float(limit)
    reach = limit + 4 * float(np.finfo(np.float32).eps) * (max(map(float, finite)) + limit)
    return min(reach, float(np.finfo(float).max))


def _has_fractions(boxes: Values) -> bool:
    """Whether some of Python's own numbers may be no integers."""
    return any(not isinstance(value, int) for value in boxes.ravel().tolist())


def _nearest_of_boxes(prepared: Prepared, corners: list[Values], k: int) -> NDArray[np.int64]:
    """Pairs among which are the `k` nearest boxes of `b` for each box of `a`."""
    half = corners[0].shape[1] // 2
    rows = [np.arange(len(of_set)) if kept is None else kept for of_set, kept in zip(corners, prepared.kept)]
    boxes = [of_set[kept].astype(np.float64) for of_set, kept in zip(corners, rows)]
    for name, of_set, kept in zip("ab", boxes, rows):
        refuse_inverted(of_set, name, kept)
    # What is grouped has an axis of its groups or, in three dimensions, a list of them.
    groups: list[NDArray[Any]] = [np.zeros(len(kept)) for kept in rows]
    if prepared.groups is not None:
        groups = prepared.groups
    elif prepared.sets[0].shape[1] > 2 * half:
        groups = [of_set[:, half] for of_set in prepared.sets]
    # Sums, and integers beyond 2^53, are rounded.
    largest = max(float(np.abs(of_set[np.isfinite(of_set)]).max(initial=0)) for of_set in boxes)
    slack = 64 * float(np.finfo(float).eps) * largest
    found = [np.empty((0, 2), np.int64)]
    for of_a, of_b in _rows_of_groups(groups):
        world = BroadPhase(dimensions=half)
        ids = world.insert_many(boxes[1][of_b])
        by_id = np.argsort(ids)
        for block in np.array_split(of_a, range(_BLOCK, len(of_a), _BLOCK)):
            asked, near, reach = _near_centers(world, boxes[0][block], k, slack)
            pairs = np.stack([block[asked], of_b[by_id[np.searchsorted(ids[by_id], near)]]], axis=1)
            found.append(pairs[_distances(boxes, pairs) <= reach[asked]])
    return _translated(prepared, *np.concatenate(found).T)


def _near_centers(
    world: BroadPhase, boxes: Values, k: int, slack: float
) -> tuple[NDArray[np.int64], NDArray[np.int64], Values]:
    """Boxes and bodies that are near each other, and how near the `k` bodies nearest to each box are.

    None of these is farther away than the `k`-th nearest to the center. They are looked for within that distance, or in
    a circle around the center if it is smaller. (Many bodies far away, across a corner, would be within the distance on
    each axis.)
    """
    half = boxes.shape[1] // 2
    low, high = boxes[:, :half], boxes[:, half:]
    reach = np.full(len(boxes), math.inf)
    with np.errstate(all="ignore"):
        centers = low + (high - low) / 2
        centers = np.where(np.isfinite(centers), centers, np.clip(0.0, low, high))
        is_finite = np.isfinite(centers).all(axis=1)
        distances = world.nearest_many(centers[is_finite], k).distances
        if distances.shape[1] == k:
            reach[is_finite] = distances[:, -1]
        reach = reach * (1 + 1e-9) + slack
        radii = (reach + np.sqrt(((high - low) ** 2).sum(axis=1)) / 2) * (1 + 1e-9) + slack
        within = np.hstack([low - reach[:, None], high + reach[:, None]])
        of_circle = math.pi * radii**2 if half == 2 else 4 / 3 * math.pi * radii**3
        is_round = np.isfinite(radii) & (of_circle < (within[:, half:] - within[:, :half]).prod(axis=1))
    within[:, :half][np.isnan(within[:, :half])] = -math.inf
    within[:, half:][np.isnan(within[:, half:])] = math.inf
    asked, near = [], []
    for rows, lists in (
        (np.flatnonzero(is_round), world.within_many(centers[is_round], radii[is_round], sorted=False)),
        (np.flatnonzero(~is_round), world.overlapping_many(within[~is_round], sorted=False)),
    ):
        asked.append(np.repeat(rows, np.diff(lists.ends, prepend=0)))
        near.append(lists.ids)
    return np.concatenate(asked), np.concatenate(near), reach


def _rows_of_groups(groups: list[NDArray[Any]]) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64]]]:
    """The rows of each group that both sets have."""
    orders = [np.argsort(codes, kind="stable") for codes in groups]
    of_both = np.intersect1d(groups[0], groups[1])
    ends = [
        [np.searchsorted(codes, of_both, side, sorter=order) for side in ("left", "right")]
        for codes, order in zip(groups, orders)
    ]
    for group in range(len(of_both)):
        first, second = (order[begin[group] : end[group]] for order, (begin, end) in zip(orders, ends))
        yield first, second


def _beside(prepared: Prepared, are_short: NDArray[np.bool_], k: int) -> list[NDArray[np.int64]]:
    """The `k` that end nearest before an interval begins, and the `k` that begin nearest after its end.

    They are looked up for the rows of `a` that lack partners.
    """
    (low_a, high_a), (low_b, high_b) = line_keys(prepared.sets)
    first, second = prepared.sets
    is_grouped = first.shape[1] == 4
    group_a, group_b = (boxes[:, 1] if is_grouped else np.zeros(len(boxes)) for boxes in (first, second))
    of_b = np.arange(len(second))
    short = np.flatnonzero(are_short if prepared.kept[0] is None else are_short[prepared.kept[0]])
    found = []
    for keys, own, step in ((low_b, high_a, 1), (high_b, low_a, -1)):
        # Of equal ones, those with smaller indices come first, in the direction of the search.
        order = np.lexsort((step * of_b, keys))
        place = ranks_of(own[short], keys[order], or_equal=step == 1) + (0 if step == 1 else -1)
        rows = short
        for _ in range(k):
            is_there = (place >= 0) & (place < len(order))
            rows, place = rows[is_there], place[is_there]
            is_same = group_a[rows] == group_b[order[place]]
            rows, place = rows[is_same], place[is_same]
            if len(rows) == 0:
                break
            found.append(_translated(prepared, rows, order[place]))
            place = place + step
    return found


def _sort_keys(distances: Values) -> Values:
    """Numbers in the order of distances."""
    if distances.dtype.kind == "O":
        return np.unique(distances, return_inverse=True)[1].reshape(-1)
    return distances.view(np.int64) if distances.dtype.kind == "m" else distances


def _overlap_without_ends(corners: list[Values], pairs: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Whether the boxes of each pair overlap, and do not merely touch. Empty boxes overlap nothing."""
    half = corners[0].shape[1] // 2
    overlap = np.ones(len(pairs), bool)
    for axis in range(half):
        (low_a, high_a), (low_b, high_b) = _ends_of(corners, pairs, axis)
        overlap &= np.asarray(np.maximum(low_a, low_b) < np.minimum(high_a, high_b), bool)
    return overlap


def _translated(prepared: Prepared, rows_of_a: Any, rows_of_b: Any) -> NDArray[np.int64]:
    columns = [rows if kept is None else kept[rows] for rows, kept in zip((rows_of_a, rows_of_b), prepared.kept)]
    return np.stack(columns, axis=1).astype(np.int64)


def _ends_of(corners: list[Values], pairs: NDArray[np.int64], axis: int) -> list[tuple[Values, Values]]:
    """Where the boxes of each pair begin and end on an axis, for each of the two sets."""
    half = corners[0].shape[1] // 2
    return [(boxes[:, axis][rows], boxes[:, axis + half][rows]) for boxes, rows in zip(corners, pairs.T)]


def _distances(corners: list[Values], pairs: NDArray[np.int64]) -> Values:
    half = corners[0].shape[1] // 2
    of_axes = []
    for axis in range(half):
        (low_a, high_a), (low_b, high_b) = _ends_of(corners, pairs, axis)
        with np.errstate(all="ignore"):
            gaps = np.maximum(low_a - high_b, low_b - high_a)
        zero = np.zeros((), gaps.dtype)
        of_axes.append(np.where(gaps > zero, gaps, zero))  # also for infinite ends, whose difference is NaN
    if half == 1:
        return of_axes[0]
    with np.errstate(all="ignore"):
        return np.asarray(np.sqrt(sum(gaps.astype(np.float64) ** 2 for gaps in of_axes)))
